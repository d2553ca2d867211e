"""The decision among redundant sensors whose filters are alike: who differs, and of those the one with the larger estimate."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.detection.decision import Confirmation, ConfirmationState, Miscompare, MiscompareState
from fddbench.detection.lpv_filter.gains import SensorsEntry
from fddbench.interfaces import Floats

__all__ = ["SensorsDecision", "SensorsState"]


@record
class SensorsState:
    """Mean square of every estimate; comparison; declarations."""

    mean_square: Rows
    compared: MiscompareState
    confirmed: ConfirmationState


class SensorsDecision:
    """Suspects a sensor that differs from one with a smaller estimate while its own is beyond its threshold.

    What the model does not know reaches the filters of all sensors alike: it moves every estimate, no difference.

    Parameters
    ----------
    entry : SensorsEntry
    thresholds : (n, 1) array
        Root mean square estimate of each sensor that is no fault, in its unit.
    confirm_s, sample_s : float
        How long a suspicion must stand, and the clock [s].
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, entry: SensorsEntry, thresholds: Floats, *, confirm_s: float, sample_s: float) -> None:
        n = len(thresholds)
        self.limits = thresholds * thresholds
        self.share = float(1.0 - exp(np.array(-sample_s / entry.mean_s)))
        self.miscompare = Miscompare(entry.differ, mean_s=entry.mean_s, sample_s=sample_s, n_sensors=n)
        self.confirmation = Confirmation(confirm_s, sample_s=sample_s, n_sites=n)
        self.states = Layout(
            SensorsState(mean_square=n, compared=self.miscompare.states.shape, confirmed=self.confirmation.states.shape)
        )

    def start(self, c: Nothing) -> SensorsState:
        """All agree."""
        return SensorsState(mean_square=0.0, compared=self.miscompare.start(c), confirmed=self.confirmation.start(c))

    def step(
        self, x: SensorsState, c: Nothing, n: Nothing, readings: Rows, estimate: Rows
    ) -> tuple[SensorsState, Rows]:
        """State, and the declared sensors as 1 or 0, (n_sensors, n_cases), of readings and estimates in one unit."""
        squared = estimate * estimate
        mean_square = x.mean_square + self.share * (squared - x.mean_square)
        compared, found = self.miscompare.step(x.compared, c, n, readings, mean_square, x.confirmed.declared)
        suspected = found.suspected & (mean_square > self.limits)
        confirmed, declared = self.confirmation.step(x.confirmed, c, n, suspected)
        return SensorsState(mean_square=mean_square, compared=compared, confirmed=confirmed), declared
