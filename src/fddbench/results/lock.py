"""One run per folder: a lock of the operating system, which dies with the process."""

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results.shards import is_durable, write_bytes

__all__ = ["locked"]

_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP}
"""What file systems answer that have no locks."""


@contextmanager
def locked(folder: Path, *, notice: Callable[[str], None] | None = None) -> Iterator[None]:
    """Keep other runs out of a folder, which is made when missing.

    Parameters
    ----------
    folder : Path
        Folder of results.
    notice : callable
        Told what the file system of the folder cannot do; the run goes on without.

    Raises
    ------
    ResultsError
        Another process is writing (its pid is named), or the folder cannot be made.
    """
    from filelock import FileLock, Timeout

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResultsError(f"cannot make the folder {folder}: {error.strerror}; name another with --out") from error
    say = notice or (lambda _text: None)
    lock = FileLock(folder / ".lock")
    try:
        lock.acquire(timeout=0)
    except Timeout as error:
        pid = (folder / ".pid").read_text() if (folder / ".pid").is_file() else "unknown"
        raise ResultsError(
            f"{folder} is being written by process {pid}; wait for it, or name another folder with --out"
        ) from error
    except (NotImplementedError, OSError) as error:
        if isinstance(error, OSError) and error.errno not in _NO_LOCKS:
            raise
        say(f"the file system of {folder} has no locks: start no second run on this folder")
    try:
        write_bytes(folder / ".pid", str(os.getpid()).encode())
        if not is_durable(folder):
            say(
                f"the file system of {folder} does not say when a renamed file is safe: after a power failure the last "
                "shards may be lost, and are flown again"
            )
        yield
    finally:
        lock.release()
