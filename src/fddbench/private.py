"""The folder on this machine that is this user's alone: machine code, and whose plug-ins were flown from here.

What lies there is run without another look, so it must be this user's: a folder or file of somebody else's, or one that
others may write, is not used.
"""

import os
import stat
from pathlib import Path

__all__ = ["folder", "made", "read", "trouble"]

_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def folder() -> Path:
    """``$FDDBENCH_CACHE``, else ``fddbench`` in the user's cache directory.

    Raises
    ------
    OSError
        The user has no home, as in many containers.
    """
    chosen = os.environ.get("FDDBENCH_CACHE")
    if chosen:
        return Path(chosen)
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fddbench"
    except RuntimeError as error:
        raise OSError(f"no cache without a home: {error}") from error


def made(path: Path) -> Path:
    """The folder, made for this user alone where it is missing.

    Raises
    ------
    OSError
        It cannot be made, or is not this user's alone.
    """
    path.mkdir(mode=0o700, parents=True, exist_ok=True)
    wrong = trouble(path)
    if wrong:
        raise PermissionError(f"{path} {wrong}")
    return path


def read(path: Path) -> bytes | None:
    """Content of a file of a private folder; None where there is none, or where others could have written it."""
    try:
        if trouble(path.parent):
            return None
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(handle, "rb") as file:
            return None if _foreign(os.fstat(file.fileno())) else file.read()
    except OSError:
        return None


def trouble(path: Path) -> str:
    """Why a folder is not private, in words; "" where it is, or is not there."""
    try:
        return _foreign(path.stat())
    except FileNotFoundError:
        return ""


def _foreign(found: os.stat_result) -> str:
    if not hasattr(os, "geteuid"):  # Windows keeps profiles apart by itself
        return ""
    if found.st_uid != os.geteuid():
        return f"belongs to another user ({found.st_uid})"
    return "can be written by others" if found.st_mode & _OTHERS else ""
