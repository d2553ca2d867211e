"""Who flies the chunks of a run: threads or processes of this machine, a dask or a ray cluster. No part of any result."""

import ctypes
import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from fddbench.errors import FddbenchError

__all__ = ["ENGINES", "Engine", "pool_of", "worker_died"]

ENGINES = ("auto", "threads", "loky", "dask", "ray")
_SAFE_PATH = "PYTHONSAFEPATH"


@dataclass(frozen=True, kw_only=True)
class Engine:
    """Who flies.

    Attributes
    ----------
    name : {"auto", "threads", "loky", "dask", "ray"}
        ``auto`` is threads where compiled code flies, else processes of loky, and this process alone with one job.
    jobs : int
        Workers; of a cluster that is there already, as many as it has.
    address : str, optional
        Scheduler of a dask cluster, or a ray cluster; by default one of this machine, for the time of the run.
    """

    name: str = "auto"
    jobs: int = 2
    address: str | None = None

    def __post_init__(self) -> None:
        """Refuse what there is not.

        Raises
        ------
        FddbenchError
            No such engine, or one that has no address.
        """
        if self.name not in ENGINES:
            raise FddbenchError(f"no engine is called {self.name!r}; there are {', '.join(ENGINES)}")
        if self.address is not None and not self.elsewhere:
            raise FddbenchError(f"an address is that of a cluster: give --engine dask or ray with it, not {self.name}")

    @property
    def elsewhere(self) -> bool:
        """Whether workers may be on other machines."""
        return self.name in ("dask", "ray")

    def alone(self, n_chunks: int) -> bool:
        """Whether this process flies everything itself."""
        return self.name == "auto" and (self.jobs == 1 or n_chunks <= 1)

    def in_threads(self, *, compiled: bool, opaque: tuple[str, ...]) -> bool:
        """Whether threads fly: compiled flights release the interpreter's lock, others would wait for each other."""
        return self.name == "threads" or (self.name == "auto" and compiled and not opaque)

    def require_able(self, *, compiled: bool, opaque: tuple[str, ...]) -> None:
        """Refuse what this engine cannot do here, before anything is written.

        Raises
        ------
        FddbenchError
            Threads are asked for where something flies in Python, or the package of the engine is not installed.
        """
        if self.name == "threads" and not (compiled and not opaque):
            who = f"{', '.join(opaque)} flies" if opaque else "this campaign flies"
            raise FddbenchError(
                f"--engine threads: {who} outside of compiled code here, where threads only wait; take auto or loky"
            )
        needed = {"dask": "distributed", "ray": "ray"}.get(self.name)
        if needed is not None and find_spec(needed) is None:
            raise FddbenchError(
                f"--engine {self.name} needs a package that is not installed: pip install 'fddbench[{self.name}]'"
            )


@contextmanager
def pool_of(engine: Engine, *, threads: bool) -> Iterator[Callable[[Iterable[Any]], Iterator[Any]]]:
    """What flies tasks of joblib and gives their results back as they finish.

    Raises
    ------
    FddbenchError
        The engine is not installed, or its cluster does not answer.
    """
    from joblib import Parallel

    with _safe_path():
        if engine.name == "dask":
            from fddbench.runner.dask_engine import dask_backend as backend_of
        elif engine.name == "ray":
            from fddbench.runner.ray_engine import ray_backend as backend_of
        else:
            options = {"backend": "threading"} if threads else {"backend": "loky", "initializer": _begin_worker}
            yield Parallel(n_jobs=engine.jobs, return_as="generator_unordered", **options)
            return
        with backend_of(engine.jobs, engine.address) as made:
            yield made


def worker_died() -> tuple[type[BaseException], ...]:
    """What is raised when a worker is gone."""
    from joblib.externals.loky.process_executor import BrokenProcessPool, TerminatedWorkerError

    found: tuple[Any, ...] = (TerminatedWorkerError, BrokenProcessPool)
    if "distributed" in sys.modules:
        found += (sys.modules["distributed"].scheduler.KilledWorker,)
    if "ray" in sys.modules:
        found += (sys.modules["ray"].exceptions.WorkerCrashedError, sys.modules["ray"].exceptions.ActorDiedError)
    return found


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
