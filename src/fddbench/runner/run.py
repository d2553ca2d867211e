"""Runs a campaign into a folder of results, and goes on where an earlier run stopped."""

import time
from collections import Counter
from collections.abc import Callable, Generator
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign
from fddbench.errors import ResultsWarning, warn
from fddbench.results import manifest
from fddbench.results.folder import claim, refuse_foreign
from fddbench.results.lock import locked
from fddbench.results.mending import mend
from fddbench.runner.assembling import assemble
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK, OPAQUE_CHUNK, cut, missing, spans
from fddbench.runner.fingerprint import fingerprint_of, provenance_for
from fddbench.runner.flight import Flyer
from fddbench.runner.in_c import InC
from fddbench.runner.pool import fly_all
from fddbench.runner.rehearsal import rehearsed
from fddbench.runner.work import lent

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
    chunk: int | None = None,
    backend: str = "auto",
    progress: Callable[[Progress], None] | None = None,
    notice: Callable[[str], None] | None = None,
) -> RunReport:
    """Fly every case of a campaign that the folder does not hold yet.

    Parameters
    ----------
    campaign : Campaign
        As read by `fddbench.campaign.load.read_campaign`.
    folder : Path
        Folder of results, laid out as ARCHITECTURE.md says.
    jobs, chunk : int
        Worker processes, and cases side by side; no part of any result.
    fresh : bool
        Replace what the folder holds.
    backend : {"auto", "llvm", "numpy"}, or one of them and "+c"
        With ``+c`` detectors that can be traced fly as exported C, compiled by the system's compiler.
        ``auto`` compiles where llvmlite is installed; no part of any result.
    progress, notice : callable
        Told at the beginning and after every chunk; told what slows the run down, and what was damaged and is flown again.

    Raises
    ------
    FddbenchError
        The design makes no detector, or one whose rows depend on more than their flight; the folder is another campaign's or
        program's, or is being written.
    """
    begun = time.monotonic()
    flyer = Flyer(assemble(campaign), backend)
    plan, fingerprint = flyer.assembly.plan, fingerprint_of(campaign)
    refuse_foreign(folder, fresh=fresh)
    flyer = rehearsed(flyer, notice)
    say = notice or _warned
    with locked(folder, notice=say):
        claim(folder, files=campaign.files(), provenance=provenance_for(plan, fingerprint) | in_c(flyer), fresh=fresh)
        left, told = _left(folder, plan.n_cases, fingerprint.sha256, progress, say)
        told.tell()
        size = chunk or _chunk(flyer)
        chunks = [spans(part) for part in cut(plan, left, size=size, jobs=jobs)]
        # workers of an earlier run may still be there, in the working folder of that time
        work = (str(folder.absolute()), fingerprint.sha256, backend, tuple(flyer.given_up.items()))
        threads = flyer.compiled and not flyer.opaque
        with lent(flyer, *work) if len(left) and threads else nullcontext():
            interrupted = _fly(folder, fly_all(work, chunks, jobs=jobs, threads=threads), told)
    return RunReport(
        folder=folder,
        flights=told.flown,
        continued=told.before,
        total=plan.n_cases,
        statuses=told.statuses,
        interrupted=interrupted,
        wall_s=time.monotonic() - begun,
    )


def in_c(flyer: Flyer) -> dict[str, object]:
    """Which detectors fly as C, and who compiled it, for the provenance; nothing where none does."""
    flown = {name: own.detector for name, own in flyer.assembly.detectors.items() if isinstance(own.detector, InC)}
    return {"flown_as_c": {name: str(each.by) for name, each in flown.items()}} if flown else {}


def _left(
    folder: Path,
    n_cases: int,
    fingerprint: str,
    progress: Callable[[Progress], None] | None,
    say: Callable[[str], None],
) -> tuple[npt.NDArray[np.int64], "_Told"]:
    """Cases that are not there yet, and the count of those that are; what was lost is told."""
    done, lost = mend(folder, fingerprint=fingerprint, n_cases=n_cases)
    for what in lost:
        say(f"{folder}: {what}; its flights are flown again")
    left = missing(n_cases, [shard.cases for shard in done])
    statuses = Counter[str]()
    for shard in done:
        statuses.update(shard.statuses)
    return left, _Told(before=n_cases - len(left), total=n_cases, statuses=statuses, progress=progress)


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
        self.tell()

    def tell(self) -> None:
        """Say how far it is."""
        if self.progress is not None:
            done = self.before + self.flown
            self.progress(Progress(flown=self.flown, done=done, total=self.total, statuses=self.statuses))


def _warned(text: str) -> None:
    """What is told to those who asked for no notices, because something is wrong on their disk."""
    warn(text, ResultsWarning)


def _chunk(flyer: Flyer) -> int:
    """Cases of a chunk; fewer where some detectors fly in Python flight by flight, so that a chunk does not last for hours."""
    if any(flyer.assembly.detectors[name].one_by_one for name in flyer.opaque):
        return OPAQUE_CHUNK
    return COMPILED_CHUNK if flyer.compiled else CHUNK


def _fly(folder: Path, shards: Generator[manifest.Shard, None, None], told: _Told) -> bool:
    """List shards as they come; True when Ctrl-C came first."""
    try:
        for shard in shards:
            manifest.append(folder, shard)
            told(shard)
    except KeyboardInterrupt:
        return True
    finally:
        shards.close()
    return False
