"""Comparison in pairs: of two sensors that differ, the one farther from its prediction is suspected."""

from functools import reduce
from itertools import combinations
from operator import or_
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, largest

__all__ = ["Compared", "Miscompare", "MiscompareState"]

_CEILING = 10.0
"""Differences count as at most so many limits, so that a wild reading is forgotten in a few time constants."""


@record
class MiscompareState:
    """Mean square difference of every pair over its limit squared [-], (n_pairs, n_cases)."""

    mean_square: Rows


@record
class Compared:
    """What a comparison found.

    Attributes
    ----------
    suspected : (n_sensors, n_cases) rows of bool
        Whether the sensor differs from one with a smaller statistic.
    differ : (n_cases,) row of bool
        Whether any two sensors that are not declared differ, now or in the mean: a predictor should coast.
    ratio : (n_cases,) row
        Root mean square difference of the pair that differs most, over its limit [-].
    """

    suspected: Rows
    differ: Row
    ratio: Row


class Miscompare:
    """Which sensors differ from others, and of each two that differ the one whose statistic is larger.

    The rule holds for one faulty sensor, for two that fail alike (both lose against the healthy one) and for two that fail
    differently, with any number of sensors. It stands and falls with the prediction: half as far off as the fault is large
    it accuses the healthy sensor. Two sensors differ when the mean square of their difference over `mean_s` is beyond the
    limit; then noise, which crosses zero, differs as steadily as a jump.

    Parameters
    ----------
    limit_deg_s : float
        Largest root mean square difference that is none [deg/s].
    mean_s : float
        Time constant of the mean square [s].
    sample_s : float
        Sample time [s].
    n_sensors : int
        Redundant sensors.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, limit_deg_s: float, *, mean_s: float, sample_s: float, n_sensors: int) -> None:
        self.pairs = tuple(combinations(range(n_sensors), 2))
        self.scale = 1.0 / limit_deg_s
        self.share = float(1.0 - exp(np.array(-sample_s / mean_s)))
        self.states = Layout(MiscompareState(mean_square=len(self.pairs)))

    def start(self, c: Nothing) -> MiscompareState:
        """All agree."""
        del c
        return MiscompareState(mean_square=0.0)

    def step(
        self, x: MiscompareState, c: Nothing, n: Nothing, sensors_deg_s: Rows, statistic: Rows, declared: Rows
    ) -> tuple[MiscompareState, Compared]:
        """State, and what the comparison found.

        Parameters
        ----------
        sensors_deg_s : (n_sensors, n_cases) rows
            Readings [deg/s].
        statistic : (n_sensors, n_cases) rows
            How much speaks against each sensor, not negative; any unit.
        declared : (n_sensors, n_cases) rows
            1 where a sensor is already declared: it is compared with nobody.
        """
        del c, n
        y, s = sensors_deg_s, statistic
        apart = np.stack([y[i] - y[j] for i, j in self.pairs]) * self.scale
        limited = np.minimum(np.abs(apart), _CEILING)
        squared = limited * limited
        mean_square = x.mean_square + self.share * (squared - x.mean_square)
        live = np.stack([declared[i] + declared[j] for i, j in self.pairs]) < 0.5
        differs = (mean_square > column([1.0])) & live
        suspected = [
            reduce(or_, [differs[k] & (s[i] > s[self._other(k, i)]) for k, pair in enumerate(self.pairs) if i in pair])
            for i in range(len(y))
        ]
        beyond = np.where(live, np.maximum(mean_square, squared), 0.0)
        worst = largest(np.where(live, mean_square, 0.0))
        found = Compared(suspected=np.stack(suspected), differ=largest(beyond) > 1.0, ratio=np.sqrt(worst))
        return MiscompareState(mean_square=mean_square), found

    def _other(self, pair: int, sensor: int) -> int:
        i, j = self.pairs[pair]
        return j if sensor == i else i
