"""``python -m fddbench``."""

from fddbench.cli import entry

if __name__ == "__main__":
    entry()
