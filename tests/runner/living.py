"""Which processes live that a test has begun, directly or not."""

from pathlib import Path


def below(mark):
    """Command lines by number of the processes that have a mark in their environment and live."""
    found = {}
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (path / "environ").read_bytes() and b") Z " not in (path / "stat").read_bytes():
                found[int(path.name)] = (path / "cmdline").read_bytes().decode()
        except OSError:
            continue
    return found
