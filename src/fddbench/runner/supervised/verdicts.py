"""Verdicts of a detector in processes of its own, and what becomes of the flights when one of these ends."""

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
    """Steps the flights of a batch in one process, or each in its own; a `Verdicts`.

    A process that ends takes all its flights with it. Of several flights nobody is then told to have failed: those that were
    not stepped at that moment are `lost`, the one that was is in `doubt`, and all are to be flown again, that one alone. A
    flight alone is tried three times, on what was measured so far.

    Parameters
    ----------
    detector : Adapted
        One that is `supervisable`.
    n_cases : int
        Flights.
    apart : bool
        Each flight in a process of its own: where none can be flown again.

    Attributes
    ----------
    raised : list
        By flight what ended it, () for nothing.
    lost, doubt : (n,) arrays of int
        Flights to be flown again, together and alone.
    """

    def __init__(self, detector: Adapted, n_cases: int, *, apart: bool = False) -> None:
        self.detector = detector
        self.raised: list[Raised | tuple[()]] = [()] * n_cases
        self.lost, self.doubt = _NONE, _NONE
        groups = np.arange(n_cases)[:, np.newaxis] if apart else np.arange(n_cases)[np.newaxis]
        self.groups = [_Group(detector, group) for group in groups]
        for group in self.groups:
            self._take(group, group.begin())

    def step(self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]) -> Verdict | None:
        """Verdict of one sample on all flights; None where all have ended."""
        shape = Shape.of(self.detector, len(self.raised))
        rows = np.zeros((shape.verdict_rows, shape.n_cases))
        some = False
        for group in self.groups:
            own = group.flights
            if group.over:
                continue
            if len(self.groups) > 1:
                one = SimpleNamespace(**{name: values[..., own] for name, values in vars(measured).items()})
                found, raised = group.step(normals[:, own], one, active[own])
            else:
                found, raised = group.step(normals, measured, active)
            self._take(group, raised)
            if found is not None:
                rows[:, own] = found
                some = True
        return shape.read_verdict(rows) if some else None

    def _take(self, group: "_Group", raised: Raisings) -> None:
        """Note what ended flights; a process that is gone has ended all that were still flying."""
        for i, reason, same in raised:
            self.raised[group.flights[i]] = (reason, same)
        if group.died is None:
            return
        flying = [flight for flight in group.flights.tolist() if not self.raised[flight]]
        for flight in flying:
            self.raised[flight] = _LOST
        if self.detector.one_by_one:
            in_doubt = int(group.flights[group.died])
            self.doubt = np.array([in_doubt])
            self.lost = np.array([flight for flight in flying if flight != in_doubt], dtype=np.int64)
        else:
            self.lost = np.array(flying, dtype=np.int64)

    def close(self) -> None:
        """End its processes."""
        for group in self.groups:
            group.close()


class _Group:
    """Flights of one process."""

    def __init__(self, detector: Adapted, flights: npt.NDArray[np.int64]) -> None:
        self.detector, self.flights, self.alone = detector, flights, len(flights) == 1
        self.shape = Shape.of(detector, len(flights))
        self.process: FlightProcess | None = None
        self.kept: list[bytes] | None = [] if self.alone else None
        self.died: int | None = None
        self.over = False

    def begin(self) -> Raisings:
        """Start the process; what is raised at once."""
        return self._tried(b"")[1]

    def step(
        self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]
    ) -> tuple[Floats | None, Raisings]:
        """Verdict on one sample, and what has been raised now."""
        return self._tried(self.shape.sample(normals, measured, active))

    def _tried(self, message: bytes) -> tuple[Floats | None, Raisings]:
        """Answer of the process, of a new one where it died; one flight alone is tried three times."""
        for tried in range(1, _TRIES + 1):
            try:
                rows, raised = self._answer(message)
            except DiedError as died:
                self.process = None
                if not self.alone:
                    self.died, self.over = died.flight, True
                    return None, []
                # a step that takes too long takes as long again
                if died.kind == "timeout" or tried == _TRIES or self.kept is None:
                    self.over = True
                    return None, [(0, str(died), (died.kind, str(died)))]
                continue
            short = [flight for flight, _, (kind, _) in raised if kind == "memory"]
            if short and not self.alone:  # the others had to share with it
                self.close()
                self.died, self.over = short[0], True
                return None, []
            self._keep(message)
            self.over = self.over or (self.alone and bool(raised))
            return rows, raised
        raise AssertionError

    def _answer(self, message: bytes) -> tuple[Floats | None, Raisings]:
        if self.process is None:
            rows: Floats | None = None
            self.process = self._started()
            raised = self.process.begin()
            for earlier in self.kept or ():
                rows, more = self.process.step(earlier)
                raised += more
            if not message:
                return rows, raised
        return self.process.step(message)

    def _started(self) -> FlightProcess:
        design = self.detector.design
        assert design is not None
        limits = design.limits
        return FlightProcess(_stage_of(self.detector), self.shape, step_s=limits.step_s, memory_mb=limits.memory_mb)

    def _keep(self, message: bytes) -> None:
        """Keep what was measured, to fly it again."""
        if self.kept is not None and message:
            self.kept.append(message)
            if len(self.kept) * len(message) > _MOST_KEPT:
                self.kept = None

    def close(self) -> None:
        """End the process."""
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
