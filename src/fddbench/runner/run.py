"""Runs a campaign into a folder of results, and goes on where an earlier run stopped."""

import time
from collections import Counter
from collections.abc import Callable, Generator
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from zlib import crc32

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign
from fddbench.errors import ResultsWarning, warn
from fddbench.results import manifest
from fddbench.results.compacting import ENOUGH, compact
from fddbench.results.folder import claim, provenance_of, refuse_foreign
from fddbench.results.lock import locked
from fddbench.results.mending import mend
from fddbench.results.stages import Numbering
from fddbench.runner.assembling import assemble, with_detectors
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK, OPAQUE_CHUNK, cut, spans
from fddbench.runner.fingerprint import fingerprint_of, provenance_for
from fddbench.runner.flight import Flyer
from fddbench.runner.pool import fly_all
from fddbench.runner.rehearsal import rehearsed
from fddbench.runner.work import Work, lent

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
    backend : {"auto", "llvm", "numpy"}
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
        claim(folder, files=campaign.files(), provenance=provenance_for(plan, fingerprint), fresh=fresh)
        parts, told = _left(folder, progress, say)
        told.tell()
        # workers of an earlier run may still be there, in the working folder of that time
        work = Work(folder=str(folder.absolute()), fingerprint=fingerprint.sha256, backend=backend)
        interrupted = any(_fly_part(flyer, work, part, jobs=jobs, chunk=chunk, told=told) for part in parts)
        if interrupted:  # perhaps between the listing of a shard and its count
            told.flown = plan.n_cases - sum(len(part.cases) for part in _left(folder, None, say)[0]) - told.before
        else:
            _few_files(folder, fingerprint.sha256, say)
    return RunReport(
        folder=folder,
        flights=told.flown,
        continued=told.before,
        total=plan.n_cases,
        statuses=told.statuses,
        interrupted=interrupted,
        wall_s=time.monotonic() - begun,
    )


def _few_files(folder: Path, fingerprint: str, say: Callable[[str], None]) -> None:
    """Join the many small shards of a large campaign; a disk that has no room for it is no failure of the run."""
    try:
        compact(folder, only=fingerprint, least=ENOUGH)
    except OSError as error:
        say(f"{folder}: its shards stay as small as they are ({error.strerror}); join them with `fddbench compact`")


@dataclass(frozen=True)
class _Part:
    """Flights that lack rows of the same detectors; no name for all."""

    cases: npt.NDArray[np.int64]
    detectors: tuple[str, ...]
    label: str


def _left(
    folder: Path, progress: Callable[[Progress], None] | None, say: Callable[[str], None]
) -> tuple[list[_Part], "_Told"]:
    """What is not there yet, and the count of what is; what was lost is told."""
    provenance = provenance_of(folder)
    done, lost = mend(folder, provenance=provenance)
    for what in lost:
        say(f"{folder}: {what}; its flights are flown again")
    numbering = Numbering(provenance)
    lacks = numbering.held(done) == 0
    statuses = Counter[str]()
    for shard in done:
        statuses.update(shard.statuses)
    grown, parts = len(provenance["fingerprints"]) > 1, []
    left = np.flatnonzero(lacks.any(axis=0))
    alike = lacks[:, left].all() or not len(left)
    some = lacks[:, left[:1]] if alike else lacks[:, left]
    kinds, which = np.unique(some, axis=1, return_inverse=True) if len(left) else (some, left)
    which = np.zeros(len(left), dtype=np.int64) if alike else which
    for k in range(kinds.shape[1]):
        names = tuple(name for name, lack in zip(numbering.detectors, kinds[:, k], strict=True) if lack)
        detectors = () if len(names) == len(numbering.detectors) else names
        label = f"{crc32(repr((provenance['fingerprints'], detectors)).encode()):010d}" if grown or detectors else ""
        parts.append(_Part(left[which.ravel() == k].astype(np.int64), detectors, label))
    n = numbering.n_cases
    return parts, _Told(before=n - len(left), total=n, statuses=statuses, progress=progress)


def _fly_part(flyer: Flyer, work: Work, part: _Part, *, jobs: int, chunk: int | None, told: "_Told") -> bool:
    """Fly what lacks rows of the same detectors; True when Ctrl-C came first."""
    if part.detectors:
        campaign = with_detectors(flyer.assembly.plan.campaign, part.detectors)
        given_up = {name: why for name, why in flyer.given_up.items() if name in {d.name for d in campaign.designs}}
        flyer = Flyer(assemble(campaign), flyer.backend, given_up)
    work = replace(work, given_up=tuple(flyer.given_up.items()), detectors=part.detectors, label=part.label)
    size = chunk or _chunk(flyer)
    chunks = [spans(cases) for cases in cut(flyer.assembly.plan, part.cases, size=size, jobs=jobs)]
    threads = flyer.compiled and not flyer.opaque
    with lent(flyer, work) if threads else nullcontext():
        return _fly(Path(work.folder), fly_all(work, chunks, jobs=jobs, threads=threads), told)


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
