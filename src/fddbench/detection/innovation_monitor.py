"""Kalman filter on the yaw-moment equation and a test of the innovation of every sensor."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.decision import (
    Confirmation,
    ConfirmationState,
    Miscompare,
    MiscompareState,
    live_mean,
    live_sensors,
)
from fddbench.detection.yaw_moment import NEEDS, YawMoment, YawMomentFilter, YawMomentGains, YawMomentState
from fddbench.interfaces import Bus, Verdict

__all__ = ["InnovationMonitor", "InnovationMonitorGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class InnovationMonitorGains(BaseModel):
    """Filter and test.

    Attributes
    ----------
    filter : YawMomentGains
        What the filter believes.
    differ_deg_s : float
        Root mean square difference of two sensors that is none [deg/s].
    mean_s : float
        Time constant of the mean squares [s].
    innovation_threshold : float
        Largest mean of ``e^2 / S`` of a sensor that is no fault [-]; 1 in the long run.
    confirm_s : float
        How long a sensor must be suspected [s].
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up", "innovation_threshold": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    filter: YawMomentGains
    differ_deg_s: Positive
    mean_s: Positive
    innovation_threshold: Positive
    confirm_s: NonNegative


@record
class InnovationMonitorState:
    """Filter; mean squares of the innovations [-]; comparison; declarations."""

    filter: YawMomentState
    mean_square: Rows
    compared: MiscompareState
    confirmed: ConfirmationState


class InnovationMonitor:
    """Declares a sensor whose innovations are too large, and larger than those of one from which it differs.

    Model assumed: the yaw-moment row of the published lateral LPV model, scheduled by measured mass, X_cg, altitude and
    airspeed, with shares of its moments that are estimated; sideslip measured relative to the air, so gusts drop out. The
    filter takes the mean of the sensors that are not declared, and coasts while these differ. Blind where the sensors differ
    by less than `differ_deg_s`: a common error of all three, and a pair so slow that the filter follows it before they
    differ. Noisy with what the equation does not have: sideslip bias, a gust moment of another size than the model's; these
    open the test while it coasts, as its variance grows. Knobs: a smaller `differ_deg_s` finds smaller and slower faults and
    alarms on the sensors' own errors; `innovation_threshold` (``fddbench tune``) trades small faults against wrong sites;
    smaller walks of the filter believe the model more. Cost: 381 operations, less than half of the sliding-mode scheme.

    References
    ----------
    Mehra, Peschon (1971), An innovations approach to fault detection and diagnosis in dynamic systems, Automatica 7(5),
    637-640. The comparison in pairs is ours.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[kalman_monitor_yaw_rate]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["kalman_monitor_yaw_rate"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "Kalman filter on the yaw moment, test of the innovation of every sensor"
    sees = "sensors"
    recorded = ("innovation_ratio", "difference_ratio", "predicted_deg_s")
    Gains = InnovationMonitorGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: InnovationMonitorGains, bus: Bus) -> None:
        T, self.watches = bus.sample_s, bus.redundant("r_deg_s")
        n, self.threshold = len(self.watches), gains.innovation_threshold
        self.moment, self.filter = YawMoment(), YawMomentFilter(gains.filter, T)
        self.miscompare = Miscompare(gains.differ_deg_s, mean_s=gains.mean_s, sample_s=T, n_sensors=n)
        self.confirmation = Confirmation(gains.confirm_s, sample_s=T, n_sites=n)
        self.share = float(1.0 - exp(np.array(-T / gains.mean_s)))
        self.states = Layout(
            InnovationMonitorState(
                filter=self.filter.states.shape, mean_square=n, compared=self.miscompare.states.shape,
                confirmed=self.confirmation.states.shape,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: InnovationMonitorGains, bus: Bus) -> "InnovationMonitor":
        """Monitor for a bus that has redundant yaw rates and what their moment is made of."""
        bus.require(*NEEDS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> InnovationMonitorState:
        """Nothing declared."""
        return InnovationMonitorState(
            filter=self.filter.start(c), mean_square=0.0, compared=self.miscompare.start(c),
            confirmed=self.confirmation.start(c),
        )  # fmt: skip

    def step(
        self, x: InnovationMonitorState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[InnovationMonitorState, Verdict]:
        """Verdict after one sample."""
        r_deg_s, out = measured.r_deg_s, x.confirmed.declared
        innovation = r_deg_s - x.filter.r_deg_s
        normalised = innovation * innovation / self.filter.innovation_variance(x.filter)
        mean_square = x.mean_square + self.share * (normalised - x.mean_square)
        compared, found = self.miscompare.step(x.compared, c, n, r_deg_s, mean_square, out)
        suspected = found.suspected & (mean_square > self.threshold)
        confirmed, declared = self.confirmation.step(x.confirmed, c, n, suspected)
        live = live_mean(r_deg_s, declared), live_sensors(declared)
        after, _ = self.filter.step(x.filter, c, n, *live, ~found.differ, self.moment.parts(measured))
        state = InnovationMonitorState(filter=after, mean_square=mean_square, compared=compared, confirmed=confirmed)
        ratio = largest(mean_square) / self.threshold
        shown = {"innovation_ratio": ratio, "difference_ratio": found.ratio, "predicted_deg_s": x.filter.r_deg_s}
        return state, Verdict(declared, np.minimum(ratio, found.ratio), signals=shown)
