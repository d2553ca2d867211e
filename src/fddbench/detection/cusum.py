"""Cumulative sums of the innovations of every sensor, upward and downward."""

from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.yaw_moment import NEEDS, Watch, WatchGains, WatchState
from fddbench.detection.yaw_moment.gains import NonNegative, Positive
from fddbench.interfaces import Bus, Verdict

__all__ = ["Cusum", "CusumGains"]

_CEILING = 4.0
"""Sums stop at so many thresholds: what they have run up is run down again in a time that does not grow with the fault."""


class CusumGains(WatchGains):
    """Filter, comparison, and sums.

    Attributes
    ----------
    drift_sigma : float
        Taken off every sample, in standard deviations of the innovation [-]; half of the smallest shift worth finding.
    sum_threshold_sigma : float
        Largest sum that is no fault, in standard deviations [-].
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up", "sum_threshold_sigma": "up"}

    drift_sigma: NonNegative
    sum_threshold_sigma: Positive


@record
class CusumState:
    """Filter and decision; sums upward and downward [-], a row a sensor."""

    watch: WatchState
    up: Rows
    down: Rows


class Cusum:
    """``s[k] = max(0, s[k-1] ± e/√S - drift)`` of every sensor; the larger of its two sums speaks against it.

    Model assumed: the yaw-moment equation with estimated shares, see `fddbench.detection.yaw_moment`; innovations white and
    of unit variance while healthy. Blind to shifts below the drift, and to what differs by less than `differ_deg_s`; noise
    of zero mean runs the sums up only because it is larger than the drift. Noisy with model errors: an offset beyond the
    drift runs a sum up in time, whatever its size, which only the comparison then keeps from an accusation. Knobs: the drift
    says how small a shift counts, the threshold how long it takes, about threshold / (shift - drift) samples. Cost: 397
    operations.

    References
    ----------
    Page (1954), Continuous inspection schemes, Biometrika 41(1/2), 100-115.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[cusum_yaw_rate]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["cusum_yaw_rate"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "two-sided cumulative sum of the innovations of every sensor"
    sees = "sensors"
    recorded = ("sum_sigma", "threshold_sigma", "difference_ratio")
    Gains = CusumGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: CusumGains, bus: Bus) -> None:
        self.watches, self.gains = bus.redundant("r_deg_s"), gains
        n = len(self.watches)
        self.watch = Watch(gains, sample_s=bus.sample_s, n_sensors=n)
        self.states = Layout(CusumState(watch=self.watch.states.shape, up=n, down=n))

    @classmethod
    def from_design(cls, gains: CusumGains, bus: Bus) -> "Cusum":
        """Detector for a bus that has redundant yaw rates and what their moment is made of."""
        bus.require(*NEEDS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> CusumState:
        """Sums at zero, nothing declared."""
        return CusumState(watch=self.watch.start(c), up=0.0, down=0.0)

    def step(self, x: CusumState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[CusumState, Verdict]:
        """Verdict after one sample."""
        drift, threshold = self.gains.drift_sigma, self.gains.sum_threshold_sigma
        e, S = self.watch.innovations(x.watch, measured.r_deg_s)
        shift = e / np.sqrt(S)
        up = np.minimum(np.maximum(x.up + (shift - drift), 0.0), _CEILING * threshold)
        down = np.minimum(np.maximum(x.down - (shift + drift), 0.0), _CEILING * threshold)
        sums = np.maximum(up, down)
        watch, declared, found = self.watch.step(x.watch, c, n, measured, sums, sums > threshold)
        worst = largest(sums)
        shown = {
            "sum_sigma": worst,
            "threshold_sigma": np.full_like(worst, threshold),
            "difference_ratio": found.ratio,
        }
        after = CusumState(watch=watch, up=up, down=down)
        return after, Verdict(declared, np.minimum(worst / threshold, found.ratio), signals=shown)
