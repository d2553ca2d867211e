"""Flying with NumPy, sample by sample, all cases side by side: the reference, and the way of detectors that are opaque."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Nothing
from fddbench.errors import reason_of
from fddbench.interfaces import NEVER, Floats, Sample
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.fused import shown

__all__ = ["DetectorFlight", "fly_eagerly"]

_TILE = 50
"""Samples whose random numbers are drawn together; no part of any result."""


class DetectorFlight:
    """One detector on one batch, fed with measured signals sample by sample.

    A step that raises ends the detector's flight here; `finish` then flies it again in ever smaller company, so that a
    case's row does not depend on it.

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
    """

    def __init__(
        self, assembly: Assembly, name: str, batch: Batch, recorded: Sequence[str] = (), *, alone: bool = True
    ) -> None:
        self.assembly, self.name, self.batch, self.alone = assembly, name, batch, alone
        self.detector, self.scoring, n_cases = assembly.detectors[name], assembly.scoring_of[name], len(batch.cases)
        self.constants = self.scoring.constants.unpack(batch.score_constants)
        self.score = self.scoring.states.spread(self.scoring.start(self.constants), n_cases)
        self.raised = ""
        self.kept: dict[str, list[Floats]] = {full: [] for full in recorded if full.startswith(f"{name}:")}
        try:
            self.state = self.detector.states.spread(self.detector.start(Nothing()), n_cases)
        except (Exception, SystemExit) as error:  # a user's detector may raise anything; it becomes a row
            self.raised = reason_of(error)

    def step(self, seen: Sample, sample: float, departed: Floats) -> None:
        """Verdict on what is measured at one sample, scored."""
        if self.raised or not (sample < departed).any():
            return
        n_cases = len(self.batch.cases)
        try:
            after, verdict = self.detector.step(self.state, Nothing(), self._drawn(int(sample)), seen.measured)
            self.detector.states.check(after, n_cases)
            actual, alive = self.scoring.actual(seen), sample < departed
            self.score, number = self.scoring.step(
                self.score, self.constants, Nothing(), verdict, actual, sample, alive
            )
            self.state = after
            shows = shown(verdict, number) if self.kept else {}
            for full, rows in self.kept.items():
                rows.append(np.broadcast_to(np.asarray(shows[full.split(":", 1)[1]], dtype=float), (n_cases,)))
        except (Exception, SystemExit) as error:  # a user's detector may raise anything; it becomes a row
            self.raised = reason_of(error)

    def _drawn(self, sample: int) -> Any:
        """Random numbers of the detector at a sample, by name."""
        draws = self.detector.draws
        if not draws.streams:
            return Nothing()
        return draws.unpack(self.assembly.normals(draws, self.batch, sample, 1)[0])

    def finish(self) -> tuple[Floats, list[str]]:
        """Final score, (n_score, n_cases), and what was raised for each case ("": nothing)."""
        n_cases = len(self.batch.cases)
        if not self.raised or (n_cases == 1 and self.alone):
            return self.scoring.states.pack(self.score, n_cases), [self.raised] * n_cases
        # halves, so that the sound cases of a large batch still fly side by side
        halves = [half for half in np.array_split(np.arange(n_cases), 2) if len(half)]
        parts = [_fly(self.assembly, self.batch.take(half), [self.name], ())[2][0].finish() for half in halves]
        return np.concatenate([score for score, _ in parts], axis=1), [text for _, texts in parts for text in texts]

    def tape(self, n_time: int) -> dict[str, Floats]:
        """What was kept, (n_time, 1, n_cases) each; not-a-number from where the detector raised on."""
        found = {}
        for full, rows in self.kept.items():
            found[full] = np.full((n_time, 1, len(self.batch.cases)), np.nan)
            if rows:
                found[full][: len(rows), 0] = rows
        return found


def fly_eagerly(
    assembly: Assembly, batch: Batch, recorded: Sequence[str] = ()
) -> tuple[dict[str, Floats], Floats, dict[str, list[str]], dict[str, Floats]]:
    """Scores, departures, errors and recordings of a batch; all detectors, no compiler."""
    departed, tape, flights = _fly(assembly, batch, list(assembly.detectors), recorded)
    scores, errors = {}, {}
    for flight in flights:
        scores[flight.name], errors[flight.name] = flight.finish()
    ends = assembly.scoring.constants.unpack(batch.score_constants).last
    time = np.arange(int(ends.max()) + 1.0)[:, np.newaxis, np.newaxis]
    beyond = (time > ends) | (time > departed)
    for flight in flights:
        tape |= flight.tape(len(time))
    return scores, departed, errors, {name: np.where(beyond, np.nan, rows) for name, rows in tape.items()}


def _fly(
    assembly: Assembly, batch: Batch, names: Sequence[str], recorded: Sequence[str]
) -> tuple[Floats, dict[str, Floats], list[DetectorFlight]]:
    """Departures, recordings of the loop, and the flights of the named detectors."""
    loop = assembly.loop
    state, constants = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    departed = np.full(len(batch.cases), NEVER)
    flights = [DetectorFlight(assembly, name, batch, recorded) for name in names]
    kept: dict[str, list[Floats]] = {
        full: [] for full in recorded if full.split(":")[0] in ("measured", "truth", "voted", "added", "departed")
    }
    last = int(assembly.scoring.constants.unpack(batch.score_constants).last.max())
    with np.errstate(all="ignore"):
        for first in range(0, last + 1, _TILE):
            for j, drawn in enumerate(assembly.normals(loop.draws, batch, first, min(_TILE, last + 1 - first))):
                sample = float(first + j)
                state, seen = loop.step(state, constants, loop.draws.unpack(drawn), np.float64(sample))
                departed = np.where(seen.departed, np.minimum(departed, sample), departed)
                _protect(seen.measured)
                for flight in flights:
                    flight.step(seen, sample, departed)
                _keep(kept, seen, departed)
                if flights and not recorded and all(flight.raised for flight in flights):
                    return departed, {}, flights
    return departed, {full: np.array(rows) for full, rows in kept.items()}, flights


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
