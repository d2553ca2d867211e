"""Finds the shipped campaigns, designs and reference tables, in a source tree and in an installed wheel alike."""

from pathlib import Path

from fddbench.errors import FddbenchError

__all__ = ["folder"]


def folder(name: str) -> Path:
    """Folder of shipped files: "campaigns", "detectors" or "reports".

    Raises
    ------
    FddbenchError
        The installation is incomplete.
    """
    package = Path(__file__).parent
    for base in (package / "gallery", package.parents[1]):
        if (base / name).is_dir():
            return base / name
    raise FddbenchError(f"the shipped folder {name!r} is missing beside {package}; install fddbench again")
