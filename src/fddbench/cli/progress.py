"""How far a run is: a bar in a terminal, a plain line elsewhere (a file, a batch job, a notebook)."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from fddbench.runner.run import Progress, RunReport

__all__ = ["Pace", "said_of_interrupted", "shown"]

_INTERRUPTED = 130
"""Exit code of what Ctrl-C ended."""
_EVERY_S = 10.0
"""Time between two plain lines [s]."""


@dataclass(kw_only=True)
class Pace:
    """Rate of this run and time left: of what it has flown itself, so that a continued run does not boast.

    Attributes
    ----------
    clock : callable
        Gives the time [s].
    begun : float
        When the run began [s].
    """

    clock: Callable[[], float] = time.monotonic
    begun: float = field(init=False)

    def __post_init__(self) -> None:
        """Begin to count."""
        self.begun = self.clock()

    def text(self, progress: Progress) -> str:
        """Flights a second and time left in words, ``95/s, 0:12 left``; only the time before the first flight is back.

        >>> times = iter([0.0, 2.0])
        >>> from collections import Counter
        >>> Pace(clock=lambda: next(times)).text(Progress(flown=10, done=60, total=100, statuses=Counter()))
        '5/s, 0:08 left'
        """
        passed = max(self.clock() - self.begun, 1e-9)
        if not progress.flown:
            return f"{_time(passed)} so far"
        rate = progress.flown / passed
        left = progress.total - progress.done
        return f"{rate:.3g}/s, {_time(left / rate)} left" if left else f"{rate:.3g}/s in {_time(passed)}"


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
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("flights"),
        TextColumn("{task.fields[pace]}"),
        TextColumn("{task.fields[failed]}"),
    )
    pace = Pace()
    with Bar(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task(name, total=None, pace="", failed="")

        def update(progress: Progress) -> None:
            bar.update(
                task, completed=progress.done, total=progress.total, pace=pace.text(progress), failed=_failed(progress)
            )

        yield update


def _lines(name: str) -> Callable[[Progress], None]:
    """One line at the beginning, from time to time, and at the end."""
    pace = Pace()
    last = [-_EVERY_S]

    def update(progress: Progress) -> None:
        passed = pace.clock() - pace.begun
        if passed - last[0] >= _EVERY_S or progress.done == progress.total:
            last[0] = passed
            text = f"{name}: {progress.done}/{progress.total} flights, {pace.text(progress)} {_failed(progress)}"
            print(text.rstrip(), file=sys.stderr, flush=True)

    return update


def _time(seconds: float) -> str:
    """Minutes and seconds, with hours where there are any."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def _failed(progress: Progress) -> str:
    """Rows that are neither scored nor infeasible, in words."""
    failed = sum(n for status, n in progress.statuses.items() if status not in ("ok", "infeasible"))
    return f"{failed} rows failed" if failed else ""


def said_of_interrupted(report: RunReport) -> int:
    """Say what an interrupted run has saved; exit code of the command."""
    done = report.continued + report.flights
    print(
        f"fddbench: interrupted; {done} of {report.total} flights are saved in {report.folder}.\n"
        "Run the same command again to continue.",
        file=sys.stderr,
    )
    return _INTERRUPTED
