"""What became of faults that had to be found: `right`, `late`, `missed`, `undecided`, or `declared_before`.

The rules are those of the column ``outcome`` in ``fddbench.results.schema``. They hold for the faults of a flight together,
and for each of its faults alone.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import NEVER, Floats
from fddbench.metrics.found import BEFORE, in_flight

__all__ = ["Ends", "Judged", "judged", "seconds"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Ends:
    """How far flights went, (n_cases,) each: the planned last sample, and the sample of departure, `NEVER` for none."""

    last: Floats
    departed: Floats

    @property
    def scored(self) -> Floats:
        """Last sample that was scored; -1 where a flight departed at once."""
        found: Floats = np.minimum(self.last, self.departed - 1.0)
        return found

    @property
    def left(self) -> npt.NDArray[np.bool_]:
        """Whether the flight departed before its end."""
        return np.asarray(self.departed <= self.last, dtype=bool)


@dataclass(frozen=True, kw_only=True, eq=False)
class Judged:
    """What became of the faults, (n_cases,) each.

    Attributes
    ----------
    outcome : array of str
        One of the five.
    at : array
        Sample at which the last of them was found; `NEVER` for not found, `BEFORE` where all were declared before.
    """

    outcome: npt.NDArray[np.str_]
    at: Floats


def judged(
    found: Floats, *, first: Floats, last: Floats, start: Floats, limit_s: Floats, ends: Ends, sample_s: float
) -> Judged:
    """Outcome of some faults of flights together.

    Parameters
    ----------
    found : (n_faults, n_cases) array
        Number of each fault after the last sample, see `fddbench.metrics.found`.
    first, last : (n_faults, n_cases) arrays
        First and last faulty samples; first is `NEVER` for a fault that is not in a flight.
    start : (n_cases,) array
        Sample from which the limit counts: the first of the first ones.
    limit_s : (n_cases,) array
        Detection time limit [s]; its own sample is in time.
    ends : Ends
        How far the flights went.
    sample_s : float
        Sample time [s].
    """
    present = first < NEVER
    # what is not in a flight is below every sample
    number = np.where(present, in_flight(found, first=first, last_scored=ends.scored), BEFORE)
    at: Floats = number.max(axis=0, initial=BEFORE)
    lost = present & (number == NEVER)
    over = (lost & (last <= ends.scored)).any(axis=0)
    passed = seconds(ends.scored - start, sample_s) >= limit_s
    left = ends.left & (ends.departed > start)
    late = seconds(at - start, sample_s) > limit_s
    outcome = np.select(
        [at == BEFORE, (at < NEVER) & ~late, at < NEVER, over | passed | left],
        ["declared_before", "right", "late", "missed"],
        "undecided",
    )
    return Judged(outcome=outcome, at=at)


def seconds(samples: Any, sample_s: float) -> Floats:
    """Times of sample numbers [s], without the digits that binary fractions add."""
    rounded: Floats = np.round(samples * sample_s, 9)
    return rounded
