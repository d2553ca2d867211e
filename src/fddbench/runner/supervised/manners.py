"""What a process does for itself before it runs somebody else's code: whom it dies with, what it may take, where it prints."""

import ctypes
import io
import os
import random
import signal
import sys
from contextlib import suppress
from pathlib import Path

import numpy as np

__all__ = ["TEXT_LIMIT", "die_with", "limit_data", "limit_memory", "new_luck", "print_little", "visible"]

TEXT_LIMIT = 4000
"""Characters that a detector may print; what comes after is dropped."""

_PR_SET_PDEATHSIG = 1
_MB = 2**20


def die_with(parent: int) -> None:
    """End as soon as this process, our parent, does; without Linux, or for 0, only a closed socket tells."""
    if not parent:
        return
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)


def limit_memory(more_mb: float) -> None:
    """Take at most so much more memory than now; more is a MemoryError. Nothing where a system has no such limit."""
    try:
        import resource

        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        limit = pages * os.sysconf("SC_PAGE_SIZE") + int(more_mb * _MB)
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ImportError, OSError, ValueError):
        return


def limit_data(most_gb: float) -> None:
    """Write to at most so much memory of one's own, however much is only mapped; more is a MemoryError, where a system can."""
    try:
        import resource

        limit = int(most_gb * 1024 * _MB)
        resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ImportError, OSError, ValueError):
        return


def new_luck() -> None:
    """Seed the generators that all modules share anew: who uses them must not see the same numbers in every process."""
    random.seed()
    np.random.seed()  # noqa: NPY002  (the shared one is meant)


def visible(text: str) -> str:
    r"""Text without characters that a terminal obeys.

    >>> visible("a\x1b[31mb\n")
    'a\\x1b[31mb\n'
    """
    return "".join(c if c.isprintable() or c in "\n\t" else c.encode("unicode_escape").decode() for c in text)


class _Little(io.TextIOBase):
    """Passes on the first characters that are printed."""

    def __init__(self, fd: int) -> None:
        self.fd, self.left = fd, TEXT_LIMIT

    def writable(self) -> bool:
        """It can be written."""
        return True

    def write(self, text: str) -> int:
        """Pass text on while there is any left."""
        said, self.left = visible(text[: self.left]), self.left - min(len(text), self.left)
        with suppress(OSError):
            os.write(self.fd, said.encode("utf-8", "backslashreplace"))
        return len(text)


def print_little() -> None:
    """Print the first few thousand characters to the terminal, and nothing by file descriptor."""
    little = _Little(os.dup(2))
    null = os.open(os.devnull, os.O_RDWR)
    for fd in (0, 1, 2):
        os.dup2(null, fd)
    os.close(null)
    sys.stdout = sys.stderr = little
