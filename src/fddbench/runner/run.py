"""Runs a campaign into a folder of results, and goes on where an earlier run stopped."""

import time
import warnings
from collections import Counter
from collections.abc import Callable, Generator
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

from fddbench.campaign.meaning import Campaign
from fddbench.errors import ResultsWarning, warn
from fddbench.results import manifest
from fddbench.results.compacting import ENOUGH, compact
from fddbench.results.folder import claim, refuse_foreign
from fddbench.results.lock import locked
from fddbench.results.schema import FAILED
from fddbench.runner.assembling import assemble, with_detectors
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK, OPAQUE_CHUNK, cut, spans
from fddbench.runner.engines import Engine
from fddbench.runner.fingerprint import fingerprint_of, provenance_for
from fddbench.runner.flight import Flyer
from fddbench.runner.in_c import InC, loads_in_c
from fddbench.runner.left import Left, Part, Wanted, left_in
from fddbench.runner.pool import fly_all
from fddbench.runner.rehearsal import rehearsed
from fddbench.runner.work import Work, lent

__all__ = ["Progress", "RunReport", "run_campaign"]

_CANCELLED = ".*still being processed by the workers have been cancelled"
"""What joblib says where Ctrl-C ends a run, in a warning; the run says it itself, with a count."""


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
        Flights of the campaign, or of the part of it that was asked for.
    statuses : Counter
        Rows by status, of all that the folder holds.
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
        return sum(n for status, n in self.statuses.items() if status in FAILED)


def run_campaign(
    campaign: Campaign,
    folder: Path,
    *,
    jobs: int = 2,
    engine: Engine | None = None,
    fresh: bool = False,
    chunk: int | None = None,
    backend: str = "auto",
    wanted: Wanted | None = None,
    retry_failed: bool = False,
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
        Workers, and cases side by side; no part of any result.
    engine : Engine, optional
        Who flies, with its own number of workers; no part of any result.
    fresh : bool
        Replace what the folder holds.
    backend : {"auto", "llvm", "numpy"}, or one of them and "+c"
        See `fddbench.runner.flight.Flyer`; no part of any result.
    wanted, retry_failed : array of bool, optional, and bool
        Fly these rows only, (n_detectors, n_cases); fly again the shards that have failed rows and any of these.
    progress, notice : callable
        Told at the beginning and after every chunk; told what slows the run down, and what was damaged and is flown again.

    Raises
    ------
    FddbenchError
        No detector, or one whose rows depend on its company; another campaign's folder, or one that is being written.
    """
    begun, own = time.monotonic(), engine or Engine(jobs=jobs)
    flyer = Flyer(assemble(campaign), backend)
    plan, fingerprint = flyer.assembly.plan, fingerprint_of(campaign)
    refuse_foreign(folder, fresh=fresh)
    flyer = rehearsed(flyer, notice)
    own.require_able(compiled=flyer.compiled, opaque=tuple(flyer.opaque))
    say = notice or _warned
    with locked(folder, notice=say):
        claim(folder, files=campaign.files(), provenance=provenance_for(plan, fingerprint) | in_c(flyer), fresh=fresh)
        left = left_in(folder, say, wanted=wanted, again=FAILED if retry_failed else frozenset())
        told = _Told(before=left.n_wanted - left.n_left, total=left.n_wanted, statuses=left.statuses, progress=progress)
        told.tell()
        # workers of an earlier run may still be there, in the working folder of that time
        work = Work(folder=str(folder.absolute()), fingerprint=fingerprint.sha256, backend=backend)
        interrupted = any(_fly_part(flyer, work, part, engine=own, chunk=chunk, told=told) for part in left.parts)
        if interrupted:
            told.anew(left_in(folder, say, wanted=left.wanted))
        else:
            _few_files(folder, fingerprint.sha256, say)
    return _report(folder, told, interrupted=interrupted, wall_s=time.monotonic() - begun)


def _report(folder: Path, told: "_Told", *, interrupted: bool, wall_s: float) -> RunReport:
    return RunReport(
        folder=folder,
        flights=told.flown,
        continued=told.before,
        total=told.total,
        statuses=told.statuses,
        interrupted=interrupted,
        wall_s=wall_s,
    )


def in_c(flyer: Flyer) -> dict[str, object]:
    """Which detectors fly as C, who compiled it and what it takes, for the provenance; nothing where none does."""
    flown = {name: own.detector for name, own in flyer.assembly.detectors.items() if isinstance(own.detector, InC)}
    loads = loads_in_c(flown)
    return {"flown_as_c": {name: str(each.by) for name, each in flown.items()}, "load_in_c": loads} if flown else {}


def _few_files(folder: Path, fingerprint: str, say: Callable[[str], None]) -> None:
    """Join the many small shards of a large campaign; a disk that has no room for it is no failure of the run."""
    try:
        compact(folder, only=fingerprint, least=ENOUGH)
    except OSError as error:
        say(f"{folder}: its shards stay as small as they are ({error.strerror}); join them with `fddbench compact`")


def _fly_part(flyer: Flyer, work: Work, part: Part, *, engine: Engine, chunk: int | None, told: "_Told") -> bool:
    """Fly what lacks rows of the same detectors; True when Ctrl-C came first."""
    if part.detectors:
        campaign = with_detectors(flyer.assembly.plan.campaign, part.detectors)
        given_up = {name: why for name, why in flyer.given_up.items() if name in {d.name for d in campaign.designs}}
        flyer = Flyer(assemble(campaign), flyer.backend, given_up)
    work = replace(work, given_up=tuple(flyer.given_up.items()), detectors=part.detectors, label=part.label)
    size = chunk or _chunk(flyer)
    chunks = [spans(cases) for cases in cut(flyer.assembly.plan, part.cases, size=size, jobs=engine.jobs)]
    threads = engine.in_threads(compiled=flyer.compiled, opaque=tuple(flyer.opaque))
    with lent(flyer, work) if threads else nullcontext():
        return _fly(Path(work.folder), fly_all(work, chunks, engine=engine, threads=threads), told)


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

    def anew(self, there: Left) -> None:
        """Count what is there; Ctrl-C may have come between the listing of a shard and its count."""
        self.flown, self.statuses = self.total - there.n_left - self.before, there.statuses

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
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=_CANCELLED)
            shards.close()
    return False
