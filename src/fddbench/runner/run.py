"""Runs a campaign into a folder of results, and goes on where an earlier run stopped."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fddbench.campaign.meaning import Campaign
from fddbench.results import manifest
from fddbench.results.folder import claim, locked
from fddbench.results.provenance import collect
from fddbench.runner.assembly import assemble
from fddbench.runner.chunks import CHUNK, Spans, cut, missing, spans
from fddbench.runner.pool import fly_all

__all__ = ["Progress", "RunReport", "run_campaign"]


@dataclass(frozen=True, kw_only=True)
class Progress:
    """How far a run is: flights flown by it, done in all, of how many, and rows by status so far."""

    flown: int
    done: int
    total: int
    statuses: Counter[str]


@dataclass(frozen=True, kw_only=True)
class RunReport:
    """How a run ended.

    Attributes
    ----------
    folder : Path
        Folder of results.
    flights, continued : int
        Flights flown by this run, and those found done.
    total : int
        Flights of the campaign.
    statuses : Counter
        Rows by status, of the whole campaign.
    interrupted : bool
        Ctrl-C came before the end.
    wall_s : float
        Wall time of this run [s].
    """

    folder: Path
    flights: int
    continued: int
    total: int
    statuses: Counter[str]
    interrupted: bool
    wall_s: float

    @property
    def failed_rows(self) -> int:
        """Rows that are neither scored nor infeasible."""
        return sum(n for status, n in self.statuses.items() if status not in ("ok", "infeasible"))


def run_campaign(
    campaign: Campaign,
    folder: Path,
    *,
    jobs: int = 2,
    fresh: bool = False,
    chunk: int = CHUNK,
    progress: Callable[[Progress], None] | None = None,
) -> RunReport:
    """Fly every case of a campaign that the folder does not hold yet.

    Parameters
    ----------
    campaign : Campaign
        As read by `fddbench.campaign.load.read_campaign`.
    folder : Path
        Folder of results, laid out as ARCHITECTURE.md says.
    jobs : int
        Worker processes; no part of any result.
    fresh : bool
        Replace what the folder holds.
    chunk : int
        Cases side by side; no part of any result.
    progress : callable
        Told after every chunk.

    Raises
    ------
    FddbenchError
        The design makes no detector, the folder is another campaign's, or is being written.
    """
    begun = time.monotonic()
    plan = assemble(campaign).plan
    with locked(folder):
        claim(folder, files=campaign.files(), provenance=_provenance(campaign), fresh=fresh)
        done = manifest.shards(folder, intact=True)
        manifest.keep(folder, done)
        left = missing(plan.n_cases, [shard.cases for shard in done])
        statuses = Counter[str]()
        for shard in done:
            statuses.update(shard.statuses)
        told = _Told(before=plan.n_cases - len(left), total=plan.n_cases, statuses=statuses, progress=progress)
        chunks = [spans(part) for part in cut(plan, left, size=chunk, jobs=jobs)]
        interrupted = _fly(folder, campaign, chunks, jobs=jobs, told=told)
    return RunReport(
        folder=folder,
        flights=told.flown,
        continued=plan.n_cases - len(left),
        total=plan.n_cases,
        statuses=statuses,
        interrupted=interrupted,
        wall_s=time.monotonic() - begun,
    )


@dataclass(kw_only=True)
class _Told:
    """Counts what comes back, and passes it on."""

    before: int
    total: int
    statuses: Counter[str]
    progress: Callable[[Progress], None] | None
    flown: int = 0

    def __call__(self, shard: manifest.Shard) -> None:
        self.flown += sum(count for _, count in shard.cases)
        self.statuses.update(shard.statuses)
        if self.progress is not None:
            done = self.before + self.flown
            self.progress(Progress(flown=self.flown, done=done, total=self.total, statuses=self.statuses))


def _fly(folder: Path, campaign: Campaign, chunks: Sequence[Spans], *, jobs: int, told: _Told) -> bool:
    """Fly chunks and list their shards as they come; True when Ctrl-C came first."""
    shards = fly_all(str(folder), campaign.sha256, chunks, jobs=jobs)
    try:
        for shard in shards:
            manifest.append(folder, shard)
            told(shard)
    except KeyboardInterrupt:
        return True
    finally:
        shards.close()
    return False


def _provenance(campaign: Campaign) -> dict[str, object]:
    return collect(
        campaign=campaign.name,
        campaign_sha256=campaign.sha256,
        designs_sha256={design.name: design.sha256 for design in campaign.designs},
        seed=campaign.seed,
    )
