"""Files that commands write: refused before the work is done, not after it."""

import os
from pathlib import Path

from fddbench.errors import FddbenchError

__all__ = ["require_new", "require_writable"]


def require_writable(path: Path, option: str) -> None:
    """Refuse a file that cannot be written.

    Parameters
    ----------
    path : Path
        File; its folder need not be there, where the command makes it.
    option : str
        Argument that named it.

    Raises
    ------
    FddbenchError
        It is a folder, or it or its folder does not allow writing; the message says why.
    """
    reason = ""
    if path.is_dir():
        reason = "it is a folder"
    elif path.exists():
        reason = "" if os.access(path, os.W_OK) else "it does not allow you to write"
    else:
        reason = _shut(path.parent)
    if reason:
        raise FddbenchError(f"cannot write {path}: {reason}; name another file with {option}")


def require_new(path: Path, option: str, *, force: bool) -> None:
    """Refuse a file that cannot be written, or that is there and shall not be replaced."""
    if path.exists() and not path.is_dir() and not force:
        raise FddbenchError(f"{path} exists; name another file with {option}, or replace it with --force")
    require_writable(path, option)


def _shut(folder: Path) -> str:
    """Why nothing can be written into a folder, which need not be there yet; empty where it can."""
    first = next((each for each in (folder, *folder.parents) if each.exists()), Path())
    if not first.is_dir():
        return f"{first} is no folder"
    return "" if os.access(first, os.W_OK | os.X_OK) else f"{first} does not allow you to write"
