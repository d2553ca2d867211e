"""Lines of the printed table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tests.bench.measure import spread


@dataclass(frozen=True, kw_only=True)
class Line:
    """Something measured beside what is asked of it.

    Attributes
    ----------
    what : str
        In words.
    values : sequence of float
        One a repeat; empty: skipped, `note` says why.
    asked : float or None
        Limit of the median; None: nothing is asked.
    least : bool
        The limit is a lower one.
    unit, note : str
        Behind the numbers.
    """

    what: str
    values: Sequence[float] = ()
    asked: float | None = None
    least: bool = True
    unit: str = "x"
    note: str = ""

    def __str__(self) -> str:
        if not len(self.values):
            return f"{self.what:<52} skipped: {self.note}"
        asked = "" if self.asked is None else f"{'>=' if self.least else '<='} {self.asked:g} {self.unit}"
        middle = float(np.median(self.values))
        met = "" if self.asked is None else "met" if (middle >= self.asked) == self.least else "MISSED"
        return f"{self.what:<52} {spread(self.values) + ' ' + self.unit:<30} {asked:<14} {met:<7} {self.note}"


HEADER = f"{'':<52} {'min / median / max':<30} {'asked':<14}"
