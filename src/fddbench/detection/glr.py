"""Generalised likelihood ratios of steps and ramps in the innovations, for every sensor and every pair of them."""

from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest, total
from fddbench.detection.yaw_moment import NEEDS, Watch, WatchGains, WatchState
from fddbench.detection.yaw_moment.gains import Positive
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict

__all__ = ["Glr", "GlrGains"]


class GlrGains(WatchGains):
    """Filter, comparison, and windows.

    Attributes
    ----------
    windows_samples : whole numbers, rising
        Onsets that are tried: a fault is so many samples old.
    ratio_threshold : float
        Largest ratio, ``2 log`` of the likelihoods, that is no fault [-].
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up", "ratio_threshold": "up"}

    windows_samples: Annotated[tuple[Annotated[int, Field(ge=1, le=200)], ...], Field(min_length=1)]
    ratio_threshold: Positive


@record
class GlrState:
    """Filter and decision; the last innovations [deg/s]; their plain and weighted sums, window after window."""

    watch: WatchState
    window: Rows
    plain: Rows
    weighted: Rows


@dataclass(frozen=True, kw_only=True)
class _Shape:
    """Fault that has grown as w_1 … w_L: sum of w squared, and sum of w."""

    squared: float
    common: float


class Glr:
    """``(g' C^-1 a)^2 / g' C^-1 g`` of the size a that fits each sensor best, over sensors or pairs g, shapes and onsets.

    A hypothesis is a step or a ramp of one size on one sensor, or on two alike, since some onset; the largest ratio of the
    hypotheses with a sensor speaks against it. The sizes of the sensors err together with the prediction: C is
    ``R / Σw² I + P (Σw / Σw²)² 1 1'`` with the variance P of the filter, which grows while it coasts. So a single sensor and
    the other two, which leave the same differences, are told apart by the prediction alone, as well as it is known.

    Model assumed: the yaw-moment equation with estimated shares, see `fddbench.detection.yaw_moment`. Blind to what differs
    by less than `differ_deg_s`; a pair that fails in opposite directions is no hypothesis of its own, it is found as its
    sensors. Noisy with model errors beyond P. Knobs: longer windows find smaller and slower faults, at ratios that a short
    one has not; the threshold trades these for wrong sites; ramps make the ratio of drifts larger. Cost: 655 operations with
    three windows.

    References
    ----------
    Willsky, Jones (1976), A generalized likelihood ratio approach to the detection and estimation of jumps in linear
    systems, IEEE Transactions on Automatic Control 21(1), 108-112. There the filter runs on and the signature of a jump is
    its response; here it coasts, and the signature is the fault itself.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[glr_yaw_rate]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "runaway_b", ["runaway_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["glr_yaw_rate"]["n_declared"][[200, 216], 0]
    array([0., 2.])
    """

    about = "likelihood ratios of steps and ramps in the innovations, of every sensor and pair"
    sees = "sensors"
    recorded = ("likelihood_ratio", "threshold_ratio", "difference_ratio")
    Gains = GlrGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: GlrGains, bus: Bus) -> None:
        self.watches, self.gains = bus.redundant("r_deg_s"), gains
        self.n, self.lengths = len(self.watches), gains.windows_samples
        self.hypotheses = [{i} for i in range(self.n)] + [set(pair) for pair in combinations(range(self.n), 2)]
        self.watch = Watch(gains, sample_s=bus.sample_s, n_sensors=self.n)
        rows = self.n * len(self.lengths)
        self.states = Layout(
            GlrState(watch=self.watch.states.shape, window=self.n * max(self.lengths), plain=rows, weighted=rows)
        )

    @classmethod
    def from_design(cls, gains: GlrGains, bus: Bus) -> "Glr":
        """Detector for a bus that has three or more redundant yaw rates and what their moment is made of."""
        bus.require(*NEEDS)
        bus.redundant("r_deg_s", least=3)
        if list(gains.windows_samples) != sorted(set(gains.windows_samples)):
            raise DesignError(f"windows_samples are {list(gains.windows_samples)}; give each once, the shortest first")
        return cls(gains, bus)

    def start(self, c: Nothing) -> GlrState:
        """Nothing declared, empty windows."""
        return GlrState(watch=self.watch.start(c), window=0.0, plain=0.0, weighted=0.0)

    def step(self, x: GlrState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[GlrState, Verdict]:
        """Verdict after one sample."""
        e, S = self.watch.innovations(x.watch, measured.r_deg_s)
        common = S - self.watch.filter.noise  # what the innovations of all sensors share
        plain, weighted = self._sums(x, e)
        found = [
            against
            for m, L in enumerate(self.lengths)
            for sums, shape in ((plain, _step(L)), (weighted, _ramp(L)))
            for against in [self._against(sums[self.n * m : self.n * (m + 1)], shape, common)]
        ]
        ratio = reduce(np.maximum, found)
        threshold = self.gains.ratio_threshold
        watch, declared, compared = self.watch.step(x.watch, c, n, measured, ratio, ratio > threshold)
        worst = largest(ratio)
        shown = {
            "likelihood_ratio": worst,
            "threshold_ratio": np.full_like(worst, threshold),
            "difference_ratio": compared.ratio,
        }
        window = np.concatenate([e, x.window[: -self.n]])
        after = GlrState(watch=watch, window=window, plain=plain, weighted=weighted)
        return after, Verdict(declared, np.minimum(worst / threshold, compared.ratio), signals=shown)

    def _sums(self, x: GlrState, e: Rows) -> tuple[Rows, Rows]:
        """Sums of the last L innovations, and with the weights 1 … L, the newest L; window after window."""
        plain, weighted = [], []
        for m, L in enumerate(self.lengths):
            own = slice(self.n * m, self.n * (m + 1))
            plain.append(x.plain[own] + (e - x.window[self.n * (L - 1) : self.n * L]))
            weighted.append(x.weighted[own] + (float(L) * e - x.plain[own]))
        return np.concatenate(plain), np.concatenate(weighted)

    def _against(self, sums: Rows, shape: _Shape, variance: Row) -> Rows:
        """Largest ratio of the hypotheses with each sensor, (n_sensors, n_cases)."""
        alpha = self.watch.filter.noise * shape.squared  # of the sums, which are the sizes times Σw²
        beta = variance * (shape.common * shape.common)
        gamma = beta / (alpha + float(self.n) * beta)
        together = gamma * total(sums)
        ratios = []
        for group in self.hypotheses:
            k = float(len(group))
            spoken = total([sums[i] for i in sorted(group)]) - k * together
            ratios.append(spoken * spoken / (alpha * (k - k * k * gamma)))
        with_sensor = [[r for r, g in zip(ratios, self.hypotheses, strict=True) if i in g] for i in range(self.n)]
        return np.stack([largest(own) for own in with_sensor])


def _step(length: int) -> _Shape:
    """Of w = 1."""
    return _Shape(squared=float(length), common=float(length))


def _ramp(length: int) -> _Shape:
    """Of w = 1 … L."""
    L = float(length)
    return _Shape(squared=L * (L + 1.0) * (2.0 * L + 1.0) / 6.0, common=L * (L + 1.0) / 2.0)
