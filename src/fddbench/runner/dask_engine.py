"""Chunks on a dask cluster, through joblib's backend for it with one thing put right."""

import pickle
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from fddbench.errors import FddbenchError, reason_of
from fddbench.runner.sending import fly_anywhere

__all__ = ["dask_backend"]

_PATIENCE_S = 10


@contextmanager
def dask_backend(jobs: int, address: str | None) -> Iterator[Callable[[Iterable[Any]], Iterator[Any]]]:
    """What flies tasks on a dask cluster: the one at an address, or one of this machine.

    Raises
    ------
    FddbenchError
        Nobody answers at the address, or has workers.
    """
    import distributed
    from joblib import Parallel, parallel_config

    with _client(distributed, jobs, address) as client:
        backend = _backend()(client=client, wait_for_workers_timeout=_PATIENCE_S)
        try:
            with parallel_config(backend=backend):
                backend.effective_n_jobs(-1)
                _require_able(client)
                yield lambda tasks: Parallel(n_jobs=-1, return_as="generator_unordered", batch_size=1)(tasks)
        except TimeoutError as error:
            raise FddbenchError(
                f"the dask scheduler at {address} has no worker after {_PATIENCE_S} s: start some, dask worker {address}"
            ) from error


def _require_able(client: Any) -> None:
    """Refuse workers that cannot import what they are to call: dask would start them anew for ever.

    Raises
    ------
    FddbenchError
        There are such workers.
    """
    answers = client.run(pickle.loads, pickle.dumps(fly_anywhere), on_error="return")
    wrong = {who: answer for who, answer in answers.items() if isinstance(answer, (ImportError, AttributeError))}
    for who, error in wrong.items():
        raise FddbenchError(
            f"{len(wrong)} of {len(answers)} workers of dask cannot fly ({who}: {reason_of(error)}); they need fddbench and "
            "the packages of its plug-ins in the versions that are installed here"
        )


@contextmanager
def _client(distributed: Any, jobs: int, address: str | None) -> Iterator[Any]:
    if address is None:
        with _deaf_to_interrupts():
            cluster = distributed.LocalCluster(
                n_workers=jobs, threads_per_worker=1, memory_limit=0, dashboard_address=None, silence_logs=50
            )
        with cluster, distributed.Client(cluster, set_as_default=False) as client:
            yield client
        return
    try:
        client = distributed.Client(address, timeout=_PATIENCE_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise FddbenchError(
            f"no dask scheduler answers at {address!r} ({reason_of(error)}); need an address such as tcp://host:8786"
        ) from error
    with client:
        yield client


@contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Leave Ctrl-C in a terminal to this process: workers that begin meanwhile inherit that they ignore it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _backend() -> Any:
    """Backend of joblib that also says so when a task ends in an error.

    The one of joblib 1.6 sets the future of a task whose worker is killed for good, or cannot import what it is to call, but
    never calls back, and whoever waits for it waits for ever.
    """
    from joblib._dask import DaskDistributedBackend

    class Answering(DaskDistributedBackend):  # type: ignore[misc]
        def effective_n_jobs(self, n_jobs: int) -> int:
            # of a cluster of one joblib would fly everything in this process
            return max(int(super().effective_n_jobs(n_jobs)), 2)

        async def _collect(self) -> None:
            import asyncio

            while self._continue:
                async for future, result in self.waiting_futures:
                    cf_future, callback = self._results.pop(future), self._callbacks.pop(future)
                    if future.status == "finished":
                        cf_future.set_result(result)
                        callback(result)
                    else:
                        error = _error_of(future, result)
                        cf_future.set_exception(error)
                        callback(error)
                await asyncio.sleep(0.01)

    return Answering


def _error_of(future: Any, result: Any) -> BaseException:
    """What a task that did not finish ended with; one that was cancelled or lost has no exception of its own."""
    if isinstance(result, tuple) and len(result) > 1 and isinstance(result[1], BaseException):
        return result[1]
    if isinstance(result, BaseException):
        return result
    return RuntimeError(f"a task of dask is {future.status}")
