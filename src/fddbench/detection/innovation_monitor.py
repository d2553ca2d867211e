"""Kalman filter on the yaw-moment equation and a test of the innovation of every sensor."""

from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.yaw_moment import NEEDS, Watch, WatchGains, WatchState
from fddbench.detection.yaw_moment.gains import Positive
from fddbench.interfaces import Bus, Verdict

__all__ = ["InnovationMonitor", "InnovationMonitorGains"]


class InnovationMonitorGains(WatchGains):
    """Filter, comparison, and test.

    Attributes
    ----------
    innovation_threshold : float
        Largest mean of ``e^2 / S`` of a sensor that is no fault [-]; 1 in the long run.
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up", "innovation_threshold": "up"}

    innovation_threshold: Positive


@record
class InnovationMonitorState:
    """Filter and decision; mean squares of the innovations [-], a row a sensor."""

    watch: WatchState
    mean_square: Rows


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
        self.watches, self.threshold = bus.redundant("r_deg_s"), gains.innovation_threshold
        n = len(self.watches)
        self.watch = Watch(gains, sample_s=bus.sample_s, n_sensors=n)
        self.share = float(1.0 - exp(np.array(-bus.sample_s / gains.mean_s)))
        self.states = Layout(InnovationMonitorState(watch=self.watch.states.shape, mean_square=n))

    @classmethod
    def from_design(cls, gains: InnovationMonitorGains, bus: Bus) -> "InnovationMonitor":
        """Monitor for a bus that has redundant yaw rates and what their moment is made of."""
        bus.require(*NEEDS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> InnovationMonitorState:
        """Nothing declared."""
        return InnovationMonitorState(watch=self.watch.start(c), mean_square=0.0)

    def step(
        self, x: InnovationMonitorState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[InnovationMonitorState, Verdict]:
        """Verdict after one sample."""
        e, S = self.watch.innovations(x.watch, measured.r_deg_s)
        mean_square = x.mean_square + self.share * (e * e / S - x.mean_square)
        watch, declared, found = self.watch.step(x.watch, c, n, measured, mean_square, mean_square > self.threshold)
        ratio = largest(mean_square) / self.threshold
        shown = {"innovation_ratio": ratio, "difference_ratio": found.ratio, "predicted_deg_s": x.watch.filter.r_deg_s}
        after = InnovationMonitorState(watch=watch, mean_square=mean_square)
        return after, Verdict(declared, np.minimum(ratio, found.ratio), signals=shown)
