"""Flying with NumPy, sample by sample, all cases side by side: the reference, and the way of detectors that are opaque."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.linear import total
from fddbench.errors import DesignError, reason_of
from fddbench.interfaces import Floats, Verdict
from fddbench.metrics.scoring import NEVER
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.fused import checked

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
        self.score = assembly.scoring.start(len(batch.cases))
        self.raised = ""
        self.kept: dict[str, list[Floats]] = {full: [] for full in recorded if full.startswith(f"{name}:")}
        try:
            self.state = assembly.detectors[name].start(len(batch.cases))
        except (Exception, SystemExit) as error:  # a user's detector may raise anything; it becomes a row
            self.raised = reason_of(error)

    def step(self, measured: SimpleNamespace, sample: float, departed: Floats) -> None:
        """Verdict on one sample, scored."""
        if self.raised or not (sample < departed).any():
            return
        n_cases = len(self.batch.cases)
        try:
            detector = self.assembly.detectors[self.name]
            after, verdict = detector.step(self.state, SimpleNamespace(**vars(measured)))
            if np.shape(after) != (detector.states.size, n_cases):
                raise DesignError(f"a step gives a state of {(detector.states.size, n_cases)}, got {np.shape(after)}")
            checked(verdict, detector, len(self.assembly.loop.bus.sites), n_cases)
            self.score = self.assembly.scoring.step(
                self.score, verdict, self.batch.score_constants, sample, sample < departed
            )
            self.state = after
            for full, rows in self.kept.items():
                shown = np.asarray(_shown(verdict, full.split(":", 1)[1]), dtype=float)
                rows.append(np.broadcast_to(shown, (n_cases,)))
        except (Exception, SystemExit) as error:  # a user's detector may raise anything; it becomes a row
            self.raised = reason_of(error)

    def finish(self) -> tuple[Floats, list[str]]:
        """Final score, (n_score, n_cases), and what was raised for each case ("": nothing)."""
        n_cases = len(self.batch.cases)
        if not self.raised or (n_cases == 1 and self.alone):
            return self.score, [self.raised] * n_cases
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


def _shown(verdict: Verdict, signal: str) -> Floats:
    """A signal of a verdict by name."""
    if signal == "n_declared":
        number: Floats = total(verdict.declared * 1.0)
        return number
    shown: Floats = verdict.ratio if signal == "ratio" else verdict.signals[signal]
    return shown


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
    loop, state = assembly.loop, batch.state
    departed = np.full(len(batch.cases), NEVER)
    flights = [DetectorFlight(assembly, name, batch, recorded) for name in names]
    kept: dict[str, list[Floats]] = {
        full: [] for full in recorded if full.split(":")[0] in ("measured", "truth", "departed")
    }
    last = int(assembly.scoring.constants.unpack(batch.score_constants).last.max())
    with np.errstate(all="ignore"):
        for first in range(0, last + 1, _TILE):
            for j, drawn in enumerate(assembly.normals(batch, first, min(_TILE, last + 1 - first))):
                sample = float(first + j)
                state, measured, truth, gone = loop.step(state, batch.constants, drawn, sample)
                departed = np.where(gone, np.minimum(departed, sample), departed)
                _protect(measured)
                for flight in flights:
                    flight.step(measured, sample, departed)
                _keep(kept, measured, truth, departed)
                if flights and not recorded and all(flight.raised for flight in flights):
                    return departed, {}, flights
    return departed, {full: np.array(rows) for full, rows in kept.items()}, flights


def _protect(measured: SimpleNamespace) -> None:
    """Make the bus read-only: a detector that wrote to it would change the flight of all others."""
    for name, value in vars(measured).items():
        view = value.view()
        view.flags.writeable = False
        setattr(measured, name, view)


def _keep(
    kept: Mapping[str, list[Floats]], measured: SimpleNamespace, truth: Mapping[str, Floats], departed: Floats
) -> None:
    """Write one sample of the loop's signals."""
    for full, rows in kept.items():
        source, _, name = full.partition(":")
        value = departed if source == "departed" else truth[name] if source == "truth" else getattr(measured, name)
        rows.append(np.atleast_2d(value))
