"""A detector of ordinary Python as it flies: one flight at a time, numbers in and numbers out."""

from collections.abc import Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Nothing
from fddbench.designs.adapted import Adapted
from fddbench.errors import DesignError
from fddbench.interfaces import Floats, Verdict

__all__ = ["OneFlight", "flights_of"]


def flights_of(measured: SimpleNamespace) -> Iterator[SimpleNamespace]:
    """One sample of many flights, flight by flight: a float for a single signal, a read-only 1-D array for several rows.

    The arrays are copies, so that no flight reaches the readings of another, nor those of a later sample.
    """
    columns = [_column(np.asarray(rows)) for rows in vars(measured).values()]
    for values in zip(*columns, strict=True):
        yield SimpleNamespace(**dict(zip(vars(measured), values, strict=True)))


def _column(rows: Floats) -> Sequence[Any]:
    """Readings of a signal, one entry a flight."""
    if rows.ndim == 1:
        values: list[float] = rows.tolist()
        return values
    # on bytes, which nobody can unlock: the others' readings of this sample lie beside one's own
    return list(np.frombuffer(rows.T.tobytes(), dtype=rows.dtype).reshape(rows.shape[::-1]))


class OneFlight:
    """What a detector decides on one flight, as a list of numbers.

    Parameters
    ----------
    adapted : Adapted
        The detector, what it leaves out filled in.

    Attributes
    ----------
    parts : dict of str to slice
        Where in the list the declared sites, residual, alarm, estimate and signals are.
    """

    def __init__(self, adapted: Adapted) -> None:
        self.adapted = adapted
        self.estimates = adapted.estimates
        of_sites = len(adapted.watches) if self.estimates == "sites" else 1
        counts = {
            "declared": len(adapted.watches) if adapted.isolates else 0,
            "residual": 1,
            "alarm": 1,
            "estimate": 0 if self.estimates is None else of_sites,
            "signals": len(adapted.recorded),
        }
        self.parts: dict[str, slice] = {}
        for name, count in counts.items():
            self.parts[name] = slice(self.size, self.size + count)

    @property
    def size(self) -> int:
        """Numbers of a decision."""
        return max((part.stop for part in self.parts.values()), default=0)

    def start(self) -> Any:
        """State of a flight before its first sample: whatever the detector gives, rows of a `Layout` at their length."""
        own = self.adapted
        begun = own.detector.start(Nothing()) if own.full else own.detector.start()
        if own.has_states:
            begun = own.own_states.unpack(own.own_states.pack(begun)[:, 0].copy())
        return begun if own.every == 1 else (0, begun, [])

    def step(self, state: Any, drawn: Any, measured: SimpleNamespace) -> tuple[Any, list[float]]:
        """State after one sample of one flight, and the decision on it.

        Raises
        ------
        BaseException
            Whatever the detector raises; DesignError for a decision that is none.
        """
        if self.adapted.every == 1:
            return self._own_step(state, drawn, measured)
        since, kept, held = state
        if since == 0:
            kept, held = self._own_step(kept, drawn, measured)
        return ((since + 1) % self.adapted.every, kept, held), held

    def _own_step(self, state: Any, drawn: Any, measured: SimpleNamespace) -> tuple[Any, list[float]]:
        """One step of the detector."""
        own = self.adapted
        given = own.detector.step(state, Nothing(), drawn, measured) if own.full else own.detector.step(state, measured)
        if not isinstance(given, tuple) or len(given) != 2:
            raise DesignError(f"a step gives (state, Verdict), got {type(given).__name__}")
        after, verdict = given
        if not isinstance(verdict, Verdict):
            raise DesignError(f"a step gives (state, Verdict), got {type(verdict).__name__} as verdict")
        return after, self._numbers(verdict)

    def _numbers(self, verdict: Verdict) -> list[float]:
        """Decision as numbers in the order of `parts`."""
        own = self.adapted
        if not own.isolates and (verdict.alarm is None or verdict.declared is not None):
            raise DesignError("a detector with isolates = False gives an alarm and declares no sites (declared=None)")
        declared = _several(verdict.declared, len(own.watches), "declared") if own.isolates else []
        alarm = float(any(declared)) if verdict.alarm is None else _number(verdict.alarm, "alarm")
        numbers = [*declared, _number(verdict.residual, "residual"), alarm, *self._estimate(verdict.estimate)]
        if verdict.signals.keys() != set(own.recorded):
            raise DesignError(
                f"recorded announces {sorted(own.recorded)}, the verdict shows {sorted(verdict.signals)}; make them equal"
            )
        numbers += [_number(verdict.signals[name], name) for name in own.recorded]
        return numbers

    def _estimate(self, estimate: Any) -> list[float]:
        self.adapted.require_announced(estimate)
        if self.estimates is None:
            return []
        if self.estimates == "sites":
            return _several(estimate, len(self.adapted.watches), "estimate")
        return [_number(estimate, "estimate")]


def _number(value: Any, what: str) -> float:
    """A number, true or false, or an array of no axis, as a float."""
    if isinstance(value, float | int):
        return float(value)
    array = np.asarray(value)
    if array.shape != () or array.dtype.kind not in "bfiu":
        raise DesignError(f"a verdict on one flight needs {what} as one real number, got {_shown(value, array)}")
    return float(array)


def _several(values: Any, count: int, what: str) -> list[float]:
    """So many numbers of a list or 1-D array."""
    if isinstance(values, list | tuple) and len(values) == count:
        return [_number(value, what) for value in values]
    array = np.asarray(values)
    if array.shape != (count,) or array.dtype.kind not in "bfiu":
        raise DesignError(
            f"a verdict on one flight needs {what} as a list of {count} real numbers, one a watched site, got "
            f"{_shown(values, array)}"
        )
    return [float(value) for value in array]


def _shown(value: Any, array: Any) -> str:
    """What came instead."""
    if array.dtype.kind == "O" and array.shape == ():
        return type(value).__name__
    return f"{type(value).__name__} of shape {array.shape} and dtype {array.dtype}"
