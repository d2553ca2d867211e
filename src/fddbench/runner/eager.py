"""Flying with NumPy, sample by sample, all cases side by side: the reference, and the way of detectors that are opaque."""

from collections.abc import Callable, Mapping, Sequence
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Nothing, Rows
from fddbench.designs.adapted import Adapted
from fddbench.interfaces import NEVER, Floats, Sample, Verdict
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.fused import shown
from fddbench.runner.lasting import ConsequenceFlight
from fddbench.runner.reconfiguration import acted_on, nothing_declared, without_commander
from fddbench.runner.supervised.verdicts import Supervised, supervisable
from fddbench.runner.verdicts import Verdicts, verdicts_of

__all__ = ["DetectorFlight", "feed_eagerly", "flown_only", "fly_eagerly"]

_TILE = 50
"""Samples whose random numbers are drawn together; no part of any result."""
_TOGETHER = 2
"""How often flights fly again together after a process of theirs has ended, before each flies alone; no part of any result."""


Cases = npt.NDArray[np.int64]
Feed = Callable[[Batch, "Sequence[DetectorFlight]"], None]


class DetectorFlight:
    """One detector on one batch, fed with measured signals sample by sample.

    A step of many flights that raises ends the detector's flight here; `finish` then flies it again in ever smaller company,
    so that a case's row does not depend on it.

    Parameters
    ----------
    assembly : Assembly
        What flies.
    name : str
        The detector.
    batch : Batch
        Cases.
    recorded : sequence of str
        Outputs to keep; those that begin with another name are left to others.
    alone : bool
        Whether a case flown alone here is the last word. Signals recorded from compiled flights show not-a-number after a
        departure, so what raises on them is flown again.
    feed : callable, optional
        Flies a batch once more and shows it to such flights, until all of them have raised; with NumPy by default.
    tried : int
        How often flights of this company were lost with a process that ended.
    hear : bool
        Whether every verdict is kept in `heard`, (n, n_cases) rows called `names` a sample; not-a-number where a flight has
        raised.

    Attributes
    ----------
    declared : (n_sites, n_cases) array
        Where the aircraft acts on it, the sites that it declared at the last sample, 0 or 1; none where it has raised.
    """

    def __init__(
        self,
        assembly: Assembly,
        name: str,
        batch: Batch,
        recorded: Sequence[str] = (),
        *,
        alone: bool = True,
        feed: Feed | None = None,
        tried: int = 0,
        hear: bool = False,
    ) -> None:
        self.assembly, self.name, self.batch = assembly, name, batch
        self.detector, self.scoring, n_cases = assembly.detectors[name], assembly.scoring_of[name], len(batch.cases)
        self.constants = self.scoring.constants.unpack(batch.score_constants)
        self.score = self.scoring.states.spread(self.scoring.start(self.constants), n_cases)
        self.kept: dict[str, list[Floats]] = {full: [] for full in recorded if full.startswith(f"{name}:")}
        self.feed, self.tried, self.again = feed or self._feed, tried, list[tuple[Cases, DetectorFlight]]()
        self.hear, self.heard = hear, list[Floats]()
        self.names = _names(self.detector)
        # one that commands is never flown again without the others, who have seen what it made of their flight
        self.commands = name == assembly.commander
        self.last_word = self.detector.one_by_one or self.commands or (n_cases == 1 and alone)
        self.verdicts: Verdicts = self._verdicts(n_cases)
        self.declared = nothing_declared(assembly, n_cases)

    @property
    def over(self) -> bool:
        """Whether every flight has raised."""
        return all(self.verdicts.raised)

    def step(self, seen: Sample, sample: float, departed: Floats) -> None:
        """Verdict on what is measured at one sample, scored."""
        active = (sample < departed) & (sample <= self.constants.last)
        if self.over or not active.any():
            return
        verdict = self.verdicts.step(self._drawn(int(sample)), seen.measured, active)
        if self.commands:
            self.declared = np.zeros_like(self.declared) if verdict is None else acted_on(verdict)
        if verdict is not None:
            self._score(verdict, self.scoring.actual(seen), sample, departed)

    def _score(self, verdict: Verdict, actual: Rows, sample: float, departed: Floats) -> None:
        """Score of one more sample."""
        alive = sample < departed
        self.score, number = self.scoring.step(self.score, self.constants, Nothing(), verdict, actual, sample, alive)
        if not self.kept and not self.hear:
            return
        shows, flying = shown(verdict, number), np.array([not raised for raised in self.verdicts.raised])
        if self.hear:
            estimate = () if verdict.estimate is None else tuple(np.atleast_2d(verdict.estimate))
            signals = [shows[name] for name in self.detector.recorded]
            rows = [*verdict.declared, verdict.alarm, verdict.residual, *estimate, *signals]
            self.heard.append(np.array([np.where(flying, row, np.nan) for row in rows]))
        for full, kept in self.kept.items():
            kept.append(np.where(flying, np.asarray(shows[full.split(":", 1)[1]], dtype=float), np.nan))

    def _verdicts(self, n_cases: int) -> Verdicts:
        """How it comes to verdicts: in a process of its own what is somebody's ordinary Python."""
        if supervisable(self.detector):
            return Supervised(self.detector, n_cases, last=self.commands)
        return verdicts_of(self.detector, n_cases)

    def _feed(self, batch: Batch, flights: "Sequence[DetectorFlight]") -> None:
        feed_eagerly(self.assembly, batch, flights, until_over=True)

    def _drawn(self, sample: int) -> Floats:
        """Random numbers of the detector at a sample."""
        draws = self.detector.draws
        if not draws.streams:
            return np.zeros((0, len(self.batch.cases)))
        drawn: Floats = self.assembly.normals(draws, self.batch, sample, 1)[0]
        return drawn

    def finish(self) -> tuple[Floats, list[str]]:
        """Final score, (n_score, n_cases), and what was raised for each case ("": nothing)."""
        n_cases, raised = len(self.batch.cases), self.verdicts.raised
        score, errors = self.scoring.states.pack(self.score, n_cases), [each[0] if each else "" for each in raised]
        if isinstance(self.verdicts, Supervised):
            self.verdicts.close()
        for company in self._flown_again():
            tried = self.tried + 1
            batch = self.batch.take(company)
            again = DetectorFlight(self.assembly, self.name, batch, tuple(self.kept), feed=self.feed, tried=tried)
            self.feed(batch, [again])
            score[:, company], texts = again.finish()
            for case, text in zip(company.tolist(), texts, strict=True):
                errors[case] = text
            self.again.append((company, again))
        return score, errors

    def _flown_again(self) -> list[Cases]:
        """Companies in which flights are flown again whose end is not theirs alone."""
        raised, every = self.verdicts.raised, np.arange(len(self.batch.cases))
        if isinstance(self.verdicts, Supervised) and self.detector.one_by_one:
            # a process that ends has harmed others; where that happens again, each flies alone
            lost = self.verdicts.lost
            together = [lost] if len(lost) and self.tried < _TOGETHER else [lost[i : i + 1] for i in range(len(lost))]
            return [*together, *([self.verdicts.doubt] if len(self.verdicts.doubt) else [])]
        if self.last_word or not any(raised):
            return []
        # halves, so that the sound cases of a large batch still fly side by side
        return [half for half in np.array_split(every, 2) if len(half)]

    def tape(self) -> dict[str, Floats]:
        """What was kept, (n_time, n_rows, n_cases) each; not-a-number from where the detector raised on."""
        found, n_time = {}, int(self.constants.last.max()) + 1
        for full, rows in self.kept.items():
            n_rows = len(self.assembly.loop.bus.sites) if full.endswith(":declared") else 1
            found[full] = np.full((n_time, n_rows, len(self.batch.cases)), np.nan)
            if rows:
                found[full][: len(rows)] = np.reshape(rows, (len(rows), n_rows, -1))
        for company, again in self.again:
            for full, rows_again in again.tape().items():
                found[full][: len(rows_again), :, company] = rows_again
        return found


def _names(detector: Adapted) -> tuple[str, ...]:
    """What a verdict says, row by row."""
    sites = detector.bus.names
    of = {None: (), "sites": tuple(f"estimate of {site}" for site in sites)}
    estimates = of.get(detector.estimates, (f"estimate of {detector.estimates}",))
    return (*(f"declaration of {site}" for site in sites), "alarm", "residual", *estimates, *detector.recorded)


def fly_eagerly(
    assembly: Assembly, batch: Batch, recorded: Sequence[str] = (), names: Sequence[str] | None = None
) -> tuple[dict[str, Floats], Floats, dict[str, list[str]], dict[str, Floats], Floats]:
    """Scores, departures, errors, recordings and consequences of a batch; all detectors or those named, no compiler."""
    flown = assembly.detectors if names is None else names
    flights = [DetectorFlight(assembly, name, batch, recorded) for name in flown]
    lasting = ConsequenceFlight(assembly, batch)
    departed, tape = feed_eagerly(assembly, batch, flights, recorded, lasting=lasting)
    scores, errors = {}, {}
    for flight in flights:
        scores[flight.name], errors[flight.name] = flight.finish()
    for flight in flights:
        tape |= flight.tape()
    if assembly.commander in errors:
        errors = without_commander(assembly.commander, errors)
    return scores, departed, errors, flown_only(assembly, batch, departed, tape), lasting.rows()


def flown_only(assembly: Assembly, batch: Batch, departed: Floats, tape: Mapping[str, Floats]) -> dict[str, Floats]:
    """Recordings, not-a-number where a flight has departed or ended."""
    ends = assembly.ends(batch)
    time = np.arange(int(ends.max()) + 1.0)[:, np.newaxis, np.newaxis]
    beyond = (time > ends) | (time > departed)
    return {name: np.where(beyond, np.nan, rows) for name, rows in tape.items()}


def feed_eagerly(
    assembly: Assembly,
    batch: Batch,
    flights: Sequence[DetectorFlight],
    recorded: Sequence[str] = (),
    *,
    until_over: bool = False,
    lasting: ConsequenceFlight | None = None,
) -> tuple[Floats, dict[str, Floats]]:
    """Fly the loop and show it to detectors; departures, and recordings of the loop.

    Where the aircraft acts on a detector that is not among them, that one is flown besides. With `until_over` it stops when
    all detectors have raised; then not every departure is known.
    """
    loop = assembly.loop
    flown, commander = _with_commander(assembly, batch, flights)
    state, constants = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    departed = np.full(len(batch.cases), NEVER)
    kept: dict[str, list[Floats]] = {
        full: [] for full in recorded if full.split(":")[0] in ("measured", "truth", "voted", "added", "departed")
    }
    last = int(assembly.scoring.constants.unpack(batch.score_constants).last.max())
    with np.errstate(all="ignore"):
        for first in range(0, last + 1, _TILE):
            for j, drawn in enumerate(assembly.normals(loop.draws, batch, first, min(_TILE, last + 1 - first))):
                sample = float(first + j)
                more = {} if commander is None else {"declared": commander.declared}
                state, seen = loop.step(state, constants, loop.draws.unpack(drawn), np.float64(sample), **more)
                departed = np.where(seen.departed, np.minimum(departed, sample), departed)
                _protect(seen.measured)
                for flight in flown:
                    flight.step(seen, sample, departed)
                if lasting is not None:
                    lasting.step(seen, sample, departed)
                _keep(kept, seen, departed)
                if until_over and all(flight.over for flight in flights):
                    return departed, {}
    return departed, {full: np.array(rows) for full, rows in kept.items()}


def _with_commander(
    assembly: Assembly, batch: Batch, flights: Sequence[DetectorFlight]
) -> tuple[Sequence[DetectorFlight], DetectorFlight | None]:
    """All flights of detectors there must be, and that of the one on which the aircraft acts; None where it acts on none."""
    name = assembly.commander
    if not name:
        return flights, None
    own = next((flight for flight in flights if flight.name == name), None)
    if own is not None:
        return flights, own
    besides = DetectorFlight(assembly, name, batch)
    return (*flights, besides), besides


def _protect(measured: SimpleNamespace) -> None:
    """Make the bus read-only: a detector that wrote to it would change the flight of all others."""
    for name, value in vars(measured).items():
        view = value.view()
        view.flags.writeable = False
        setattr(measured, name, view)


def _keep(kept: Mapping[str, list[Floats]], seen: Sample, departed: Floats) -> None:
    """Write one sample of the loop's signals."""
    for full, rows in kept.items():
        source, _, name = full.partition(":")
        single = {"departed": departed, "added": seen.added}
        named = {"measured": vars(seen.measured), "truth": seen.truth, "voted": seen.voted}
        rows.append(np.atleast_2d(named[source][name] if source in named else single[source]))
