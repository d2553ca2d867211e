"""How a detector comes to the verdicts of many flights: all side by side in one step, or each flight by itself."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Nothing, mapped
from fddbench.designs.adapted import Adapted
from fddbench.designs.one_flight import OneFlight, flights_of
from fddbench.designs.reasons import reason_at, same_line
from fddbench.errors import by_statement, raise_interrupt
from fddbench.interfaces import Floats, Verdict

__all__ = ["OneByOne", "Raised", "SideBySide", "Verdicts", "verdicts_of"]

Raised = tuple[str, tuple[str, str]]
"""What a step raised: the reason in a row, and what two of the same error at the same line share; () for nothing."""


class Verdicts(Protocol):
    """Steps the flights of a batch; `raised` says by flight what its detector raised, "" for nothing."""

    raised: list[Raised | tuple[()]]

    def step(self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]) -> Verdict | None:
        """Verdict of one sample on all flights; None where all have raised. Flights that are not active do not matter.

        `normals`, (4 n, n_cases), are what the detector draws.
        """
        ...


def _unwatched(flight: int) -> None:
    del flight


def verdicts_of(
    detector: Adapted, n_cases: int, *, watch: Callable[[int], None] = _unwatched, too_much: str = ""
) -> "SideBySide | OneByOne":
    """The way of a detector.

    Parameters
    ----------
    watch : callable
        Told which flight is stepped next.
    too_much : str
        Reason of a row whose detector got no more memory; "": as of any other error.
    """
    kind = OneByOne if detector.one_by_one else SideBySide
    return kind(detector, n_cases, watch, too_much)


def _raised(error: BaseException, detector: Any, too_much: str) -> Raised:
    """What a step raised; a MemoryError of its own, by `raise`, is an error as any other."""
    raise_interrupt(error)
    reason, same = reason_at(error, detector), same_line(error, detector)
    if too_much and isinstance(error, MemoryError) and not by_statement(error):
        return too_much, ("memory", "")
    return reason, same


def _unpacked(detector: Adapted, normals: Floats) -> Any:
    """Random numbers by name."""
    return detector.draws.unpack(normals) if detector.draws.streams else Nothing()


class SideBySide:
    """One step for all flights; when it raises, nobody knows for which."""

    def __init__(self, detector: Adapted, n_cases: int, watch: Callable[[int], None], too_much: str) -> None:
        self.detector, self.n_cases, self.watch, self.too_much = detector, n_cases, watch, too_much
        self.raised: list[Raised | tuple[()]] = [()] * n_cases
        try:
            self.state = detector.states.spread(detector.start(Nothing()), n_cases)
        except BaseException as error:  # a user's detector may raise anything; it becomes a row
            self._raise(error)

    def step(self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]) -> Verdict | None:
        """Verdict of one sample on all flights."""
        del active
        self.watch(0)
        try:
            drawn = _unpacked(self.detector, normals)
            after, verdict = self.detector.step(self.state, Nothing(), drawn, measured)
            self.detector.states.check(after, self.n_cases)
        except BaseException as error:
            self._raise(error)
            return None
        self.state = after
        return verdict

    def _raise(self, error: BaseException) -> None:
        self.raised = [_raised(error, self.detector.detector, self.too_much)] * self.n_cases


class OneByOne:
    """A step a flight, each with a state of its own; a flight that raises leaves the others alone."""

    def __init__(self, detector: Adapted, n_cases: int, watch: Callable[[int], None], too_much: str) -> None:
        self.detector, self.one = detector, OneFlight(detector)
        self.watch, self.too_much = watch, too_much
        self.raised: list[Raised | tuple[()]] = [()] * n_cases
        self.flying = np.ones(n_cases, dtype=bool)
        self.states: list[Any] = [None] * n_cases
        for i in range(n_cases):
            watch(i)
            try:
                self.states[i] = self.one.start()
            except BaseException as error:
                self._raise(i, error)

    def step(self, normals: Floats, measured: SimpleNamespace, active: npt.NDArray[np.bool_]) -> Verdict | None:
        """Verdict of one sample on all flights; nothing is declared on those that raised or are not active."""
        drawn = _unpacked(self.detector, normals)
        numbers = np.zeros((len(self.states), self.one.size))
        flies, draws = (active & self.flying).tolist(), bool(self.detector.draws.streams)
        for i, own in enumerate(flights_of(measured)):
            if not flies[i]:
                continue
            self.watch(i)
            random = mapped(lambda rows, i=i: rows[..., i], drawn) if draws else drawn
            try:
                self.states[i], numbers[i] = self.one.step(self.states[i], random, own)
            except BaseException as error:
                self._raise(i, error)
        return self._verdict(numbers) if self.flying.any() else None

    def _raise(self, i: int, error: BaseException) -> None:
        self.raised[i], self.flying[i] = _raised(error, self.detector.detector, self.too_much), False

    def _verdict(self, numbers: Floats) -> Verdict:
        """Verdict on all flights of their numbers, (n_cases, n)."""
        rows = {name: numbers[:, part].T for name, part in self.one.parts.items()}
        estimate = rows["estimate"] if self.one.estimates is not None else None
        return self.detector.spoken(
            Verdict(
                rows["declared"] if self.detector.isolates else None,
                rows["residual"][0],
                signals=dict(zip(self.detector.recorded, rows["signals"], strict=True)),
                alarm=rows["alarm"][0],
                estimate=estimate if estimate is None or self.one.estimates == "sites" else estimate[0],
            )
        )
