"""The joblib pool: chunks out as plain data, shards back as they finish, nothing lost when a worker dies."""

import ctypes
import os
import signal
import sys
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from fddbench.errors import FddbenchError
from fddbench.results.manifest import Shard
from fddbench.runner.chunks import Spans
from fddbench.runner.work import Work, fly_and_write

__all__ = ["fly_all"]

_ATTEMPTS = 3
_SAFE_PATH = "PYTHONSAFEPATH"


def fly_all(work: Work, chunks: Sequence[Spans], *, jobs: int, threads: bool) -> Generator[Shard, None, None]:
    """Shards in the order in which they finish.

    With one job everything happens in this process. Threads are for compiled flights, which release the interpreter's
    lock; processes for those that run in Python. A killed worker aborts the pool but loses nothing that is written:
    what is missing is given out again.

    Raises
    ------
    FddbenchError
        Workers died three times over; nothing finished is lost.
    """
    left = list(chunks)
    for _ in range(_ATTEMPTS):
        try:
            for shard in _once(work, left, jobs=jobs, threads=threads):
                left = [chunk for chunk in left if chunk != shard.cases]
                yield shard
            return
        except _worker_died():
            continue
    raise FddbenchError(
        f"workers died {_ATTEMPTS} times, {len(left)} chunks are left (is there enough memory?).\n"
        "Run the same command again to continue, with --jobs 1 to see what happens."
    )


def _once(work: Work, chunks: Sequence[Spans], *, jobs: int, threads: bool) -> Iterator[Shard]:
    if jobs == 1 or len(chunks) <= 1:
        yield from (fly_and_write(work, chunk) for chunk in chunks)
        return
    from joblib import Parallel, delayed

    options = {"backend": "threading"} if threads else {"backend": "loky", "initializer": _begin_worker}
    pool = Parallel(n_jobs=jobs, return_as="generator_unordered", **options)
    with _safe_path():
        yield from pool(delayed(fly_and_write)(work, chunk) for chunk in chunks)


@contextmanager
def _safe_path() -> Iterator[None]:
    """Begin workers without the working folder in their path: a ``types.py`` in it would be theirs instead of Python's."""
    before = os.environ.get(_SAFE_PATH)
    os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SAFE_PATH]
        else:
            os.environ[_SAFE_PATH] = before


def _begin_worker() -> None:
    """Leave Ctrl-C to the parent, and end with it: loky workers otherwise outlive a killed parent by minutes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGTERM)
        if os.getppid() == 1:
            os._exit(1)


def _worker_died() -> tuple[type[BaseException], ...]:
    """What joblib raises when a worker is gone."""
    from joblib.externals.loky.process_executor import BrokenProcessPool, TerminatedWorkerError

    found: tuple[Any, ...] = (TerminatedWorkerError, BrokenProcessPool)
    return found
