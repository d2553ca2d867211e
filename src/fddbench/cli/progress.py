"""How far a run is: a bar in a terminal, a plain line elsewhere."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from fddbench.runner.run import Progress

__all__ = ["shown"]

_EVERY_S = 10.0
"""Time between two plain lines [s]."""


@contextmanager
def shown(name: str, *, quiet: bool) -> Iterator[Callable[[Progress], None] | None]:
    """Progress display on standard error for the duration of a run, or none."""
    if quiet:
        yield None
    elif sys.stderr.isatty():
        with _bar(name) as update:
            yield update
    else:
        yield _lines(name)


@contextmanager
def _bar(name: str) -> Iterator[Callable[[Progress], None]]:
    """Bar with counts, rate and time left."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("flights"),
        TextColumn("{task.fields[rate]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[failed]}"),
    )
    begun = time.monotonic()
    with Bar(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task(name, total=None, rate="", failed="")

        def update(progress: Progress) -> None:
            rate = f"{progress.flown / max(time.monotonic() - begun, 1e-9):.0f}/s"
            bar.update(task, completed=progress.done, total=progress.total, rate=rate, failed=_failed(progress))

        yield update


def _lines(name: str) -> Callable[[Progress], None]:
    """One line from time to time."""
    begun = time.monotonic()
    last = [begun]

    def update(progress: Progress) -> None:
        now = time.monotonic()
        if now - last[0] >= _EVERY_S or progress.done == progress.total:
            last[0] = now
            text = f"{name}: {progress.done}/{progress.total} flights, {now - begun:.0f} s {_failed(progress)}"
            print(text.rstrip(), file=sys.stderr, flush=True)

    return update


def _failed(progress: Progress) -> str:
    """Rows that are neither scored nor infeasible, in words."""
    failed = sum(n for status, n in progress.statuses.items() if status not in ("ok", "infeasible"))
    return f"{failed} rows failed" if failed else ""
