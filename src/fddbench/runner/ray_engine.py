"""Chunks on a ray cluster, through ray's own hook for joblib."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from fddbench.errors import FddbenchError, reason_of

__all__ = ["ray_backend"]


@contextmanager
def ray_backend(jobs: int, address: str | None) -> Iterator[Callable[[], Any]]:
    """What makes a `joblib.Parallel` on a ray cluster: the one at an address, or one of this machine.

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
            yield lambda: Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
    finally:
        ray.shutdown()
