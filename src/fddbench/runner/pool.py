"""The joblib pool: chunks out as plain data, shards back as they finish, nothing lost when a worker dies."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from fddbench.errors import FddbenchError, reason_of
from fddbench.results.manifest import Shard
from fddbench.runner.chunks import Spans
from fddbench.runner.engines import Engine, pool_of, worker_died
from fddbench.runner.sending import Errand, Sent, Unseen, carried_by, errand, fly_anywhere, keep
from fddbench.runner.work import Work, fly_and_write

__all__ = ["fly_all"]

_ATTEMPTS = 3
Pool = Callable[[Iterable[Any]], Iterator[Any]]


def fly_all(work: Work, chunks: Sequence[Spans], *, engine: Engine, threads: bool) -> Generator[Shard, None, None]:
    """Shards in the order in which they finish.

    With one job everything happens in this process, unless an engine is named. A killed worker aborts the pool but loses
    nothing that is written: what is missing is given out again.

    Raises
    ------
    FddbenchError
        Workers died three times over before anything more was finished, or cannot fly this campaign; nothing finished is lost.
    """
    if engine.alone(len(chunks)):
        yield from (fly_and_write(work, chunk) for chunk in chunks)
        return
    left, deaths = list(chunks), 0
    with pool_of(engine, threads=threads) as pool:
        while deaths < _ATTEMPTS:
            try:
                for shard in _once(work, left, engine, pool):
                    left, deaths = [chunk for chunk in left if chunk != shard.cases], 0
                    yield shard
                return
            except worker_died():
                deaths += 1
    raise FddbenchError(
        f"workers died {_ATTEMPTS} times in a row, {len(left)} chunks are left (is there enough memory?).\n"
        "Run the same command again to continue, with --jobs 1 to see what happens."
    )


def _once(work: Work, chunks: Sequence[Spans], engine: Engine, pool: Pool) -> Iterator[Shard]:
    from joblib import delayed

    if not engine.elsewhere:
        yield from pool(delayed(fly_and_write)(work, chunk) for chunk in chunks)
        return
    with errand(work) as own:
        unseen: list[Spans] = []
        yield from _elsewhere(own, chunks, unseen, engine, pool)
        if unseen:
            yield from _elsewhere(carried_by(own), unseen, [], engine, pool)


def _elsewhere(
    own: Errand, chunks: Sequence[Spans], unseen: list[Spans], engine: Engine, pool: Pool
) -> Iterator[Shard]:
    """Shards of workers that may be on other machines; chunks of those that lack the campaign are put aside.

    Raises
    ------
    FddbenchError
        A worker is another program, or lacks one.
    """
    from joblib import delayed

    try:
        for answer in pool(delayed(fly_anywhere)(own, chunk) for chunk in chunks):
            if isinstance(answer, FddbenchError):
                raise answer
            if isinstance(answer, Unseen):
                unseen.append(answer.cases)
            else:
                yield keep(Path(own.work.folder), answer) if isinstance(answer, Sent) else answer
    except (ImportError, AttributeError, RuntimeError) as error:
        if isinstance(error, worker_died()):
            raise
        why = "; ".join(reason_of(each) for each in _chain(error))
        raise FddbenchError(
            f"workers of {engine.name} cannot fly this campaign ({why}); they need fddbench and the packages of its plug-ins "
            "in the versions that are installed here"
        ) from error


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__
