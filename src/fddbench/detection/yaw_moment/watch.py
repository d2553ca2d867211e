"""What monitors of the innovations share: the filter, who is compared with whom, and what is declared."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.detection.decision import (
    Compared,
    Confirmation,
    ConfirmationState,
    Miscompare,
    MiscompareState,
    live_mean,
    live_sensors,
)
from fddbench.detection.yaw_moment.equation import YawMoment
from fddbench.detection.yaw_moment.filter import YawMomentFilter, YawMomentState
from fddbench.detection.yaw_moment.gains import WatchGains

__all__ = ["Watch", "WatchState"]


@record
class WatchState:
    """Filter, comparison, declarations."""

    filter: YawMomentState
    compared: MiscompareState
    confirmed: ConfirmationState


class Watch:
    """Innovations of redundant yaw rates for a statistic, and what follows from the statistic.

    The filter is corrected with the mean of the sensors that are not declared, and coasts while any two of these differ, so
    that a fault which is large enough to count does not enter it: the innovations then show the fault itself. A sensor is
    declared, for good, that is suspected by its statistic, and differs from one whose statistic is smaller, for the
    confirmation time.

    Parameters
    ----------
    gains : WatchGains
        Of filter, comparison and confirmation.
    sample_s : float
        Sample time [s].
    n_sensors : int
        Redundant sensors.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: WatchGains, *, sample_s: float, n_sensors: int) -> None:
        self.moment, self.filter = YawMoment(), YawMomentFilter(gains.filter, sample_s)
        self.miscompare = Miscompare(gains.differ_deg_s, mean_s=gains.mean_s, sample_s=sample_s, n_sensors=n_sensors)
        self.confirmation = Confirmation(gains.confirm_s, sample_s=sample_s, n_sites=n_sensors)
        self.states = Layout(
            WatchState(
                filter=self.filter.states.shape,
                compared=self.miscompare.states.shape,
                confirmed=self.confirmation.states.shape,
            )
        )

    def start(self, c: Nothing) -> WatchState:
        """Nothing declared."""
        return WatchState(
            filter=self.filter.start(c), compared=self.miscompare.start(c), confirmed=self.confirmation.start(c)
        )

    def innovations(self, x: WatchState, r_deg_s: Rows) -> tuple[Rows, Row]:
        """Sensors less their prediction [deg/s], (n_sensors, n_cases), and the variance of one [(deg/s)^2], (n_cases,)."""
        return r_deg_s - x.filter.r_deg_s, self.filter.innovation_variance(x.filter)

    def step(
        self, x: WatchState, c: Nothing, n: Nothing, measured: SimpleNamespace, statistic: Rows, beyond: Rows
    ) -> tuple[WatchState, Rows, Compared]:
        """State, declared sites as 1 or 0, (n_sensors, n_cases), and the comparison.

        Parameters
        ----------
        measured : signals of the bus
            Of this sample.
        statistic : (n_sensors, n_cases) rows
            How much speaks against each sensor; not negative, any unit.
        beyond : (n_sensors, n_cases) rows of bool
            Whether that is enough to suspect it.
        """
        compared, found = self.miscompare.step(x.compared, c, n, measured.r_deg_s, statistic, x.confirmed.declared)
        confirmed, declared = self.confirmation.step(x.confirmed, c, n, found.suspected & beyond)
        live = live_mean(measured.r_deg_s, declared), live_sensors(declared)
        filtered, _ = self.filter.step(x.filter, c, n, *live, np.logical_not(found.differ), self.moment.parts(measured))
        return WatchState(filter=filtered, compared=compared, confirmed=confirmed), declared, found
