"""Verdicts of a detector in processes of its own, and what becomes of the flights when one of these ends."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt

from fddbench.designs.adapted import Adapted
from fddbench.interfaces import Floats, Verdict
from fddbench.runner.supervised.order import Order
from fddbench.runner.supervised.processes import DiedError, FlightProcess, Raisings
from fddbench.runner.supervised.stages import Stage, can_supervise
from fddbench.runner.supervised.wire import Shape
from fddbench.runner.verdicts import Raised

__all__ = ["Supervised", "supervisable"]

_TRIES = 3
_MOST_KEPT = 64_000_000
"""Bytes of what was measured in a flight that are kept, to fly it again when its process dies."""
_LOST: Raised = ("crashed: its process ended in another flight", ("lost", ""))
_NONE: npt.NDArray[np.int64] = np.empty(0, dtype=np.int64)


def supervisable(detector: Adapted) -> bool:
    """Whether a detector is opaque, and can be built once more in a process of its own."""
    return bool(detector.opaque) and detector.design is not None and can_supervise()


class Supervised:
    """Steps the flights of a batch in one process; a `Verdicts`.

    A process that ends takes all its flights with it. Of several flights nobody is then told to have failed: those that were
    not stepped at that moment are `lost`, the one that was is in `doubt`, and all are to be flown again, that one alone. A
    flight alone is tried three times, on what was measured so far; so are flights that cannot be flown again, the one that
    ends them left out in the end.

    Parameters
    ----------
    detector : Adapted
        One that is `supervisable`.
    n_cases : int
        Flights.
    last : bool
        These flights cannot be flown again.

    Attributes
    ----------
    raised : list
        By flight what ended it, () for nothing.
    lost, doubt : (n,) arrays of int
        Flights to be flown again, together and alone.
    """

    def __init__(self, detector: Adapted, n_cases: int, *, last: bool = False) -> None:
        self.detector, self.shape = detector, Shape.of(detector, n_cases)
        self.raised: list[Raised | tuple[()]] = [()] * n_cases
        self.lost, self.doubt = _NONE, _NONE
        self.process: FlightProcess | None = None
        self.kept: list[bytes] | None = [] if last or n_cases == 1 else None
        self.again = self.kept is not None
        self.deaths: Counter[int] = Counter()
        self._tried(b"")

    @property
    def over(self) -> bool:
        """Whether every flight has ended."""
        return all(self.raised)

    def step(self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]) -> Verdict | None:
        """Verdict of one sample on all flights; None where all have ended."""
        if self.over:
            return None
        rows = self._tried(self.shape.sample(normals, measured, active))
        return None if rows is None else self.shape.read_verdict(rows)

    def _tried(self, message: bytes) -> Floats | None:
        """Answer of the process, of a new one where it died."""
        while not self.over:
            try:
                rows, raised = self._answer(message)
            except DiedError as died:
                self.process = None
                self._died(died.flight, died.kind, str(died))
                continue
            short = [(flight, reason) for flight, reason, (kind, _) in raised if kind == "memory"]
            if short and len(self.raised) > 1:  # the others had to share with it
                self.close()
                self._died(short[0][0], "memory", short[0][1])
                continue
            for flight, reason, same in raised:
                self.raised[flight] = self.raised[flight] or (reason, same)
            self._keep(message)
            return rows
        return None

    def _died(self, flight: int, kind: str, reason: str) -> None:
        """Note a death: try again, leave the flight out, or give all flights up to be flown again."""
        self.deaths[flight] += 1
        if self.kept is not None and not self.raised[flight]:
            # a step that takes too long takes as long again
            if kind != "crashed" or self.deaths[flight] == _TRIES:
                self.raised[flight] = (reason, (kind, reason))
            return
        flying = np.flatnonzero([not ended for ended in self.raised])
        for each in flying.tolist():
            self.raised[each] = (reason, (kind, reason)) if self.again else _LOST
        if not self.again:
            alone = self.detector.one_by_one
            self.doubt = flying[flying == flight] if alone else _NONE
            self.lost = flying[flying != flight] if alone else flying

    def _answer(self, message: bytes) -> tuple[Floats | None, Raisings]:
        if self.process is None:
            self.process = self._started()
            raised = self.process.begin()
            rows: Floats | None = None
            for earlier in self.kept or ():
                rows, more = self.process.step(self._without_ended(earlier))
                raised += more
            if not message:
                return rows, raised
        return self.process.step(self._without_ended(message))

    def _without_ended(self, message: bytes) -> bytes:
        """A sample in which flights that have ended are not active."""
        if not self.deaths:
            return message
        n = len(self.raised)
        active = np.frombuffer(message, dtype=bool, offset=len(message) - n) & [not ended for ended in self.raised]
        return message[:-n] + active.tobytes()

    def _started(self) -> FlightProcess:
        assert self.detector.design is not None
        limits = self.detector.design.limits
        return FlightProcess(_stage_of(self.detector), self.shape, step_s=limits.step_s, memory_mb=limits.memory_mb)

    def _keep(self, message: bytes) -> None:
        """Keep what was measured, to fly it again."""
        if self.kept is not None and message:
            self.kept.append(message)
            if len(self.kept) * len(message) > _MOST_KEPT:
                self.kept = None

    def close(self) -> None:
        """End its process."""
        if self.process is not None:
            self.process.close()
        self.process = None


def _stage_of(detector: Adapted) -> Stage:
    """Stage of a detector, made when it is first needed and ended with it."""
    found = vars(detector).get("_stage")
    if not isinstance(found, Stage):
        assert detector.design is not None
        found = vars(detector)["_stage"] = Stage(Order.of(detector.design, detector.bus))
    return found
