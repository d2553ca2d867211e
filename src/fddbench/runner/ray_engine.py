"""Chunks on a ray cluster, through ray's own hook for joblib."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any

from fddbench.errors import FddbenchError, reason_of

__all__ = ["ray_backend"]

_SLICE = 4
"""Tasks a worker that are given out at once."""


@contextmanager
def ray_backend(jobs: int, address: str | None) -> Iterator[Callable[[Iterable[Any]], Iterator[Any]]]:
    """What flies tasks on a ray cluster: the one at an address, or one of this machine.

    Raises
    ------
    FddbenchError
        Nobody answers at the address.
    """
    import ray
    from joblib import Parallel, parallel_config
    from ray.util.joblib import register_ray

    local = {"num_cpus": jobs, "include_dashboard": False} if address is None else {}
    try:
        ray.init(address=address, log_to_driver=False, logging_level="error", **local)
    except (ConnectionError, ValueError, RuntimeError) as error:
        raise FddbenchError(
            f"no ray cluster answers at {address!r} ({reason_of(error)}); need an address such as ray://host:10001"
        ) from error
    try:
        register_ray()
        with parallel_config("ray"):
            yield lambda tasks: _in_slices(tasks, Parallel(n_jobs=jobs, batch_size=1), _SLICE * jobs)
    finally:
        ray.shutdown()


def _in_slices(tasks: Iterable[Any], pool: Any, size: int) -> Iterator[Any]:
    """Results of slices of tasks: the backend gives them back when all are there, and a failure loses those of one slice."""
    left = iter(tasks)
    while some := list(islice(left, size)):
        yield from pool(some)
