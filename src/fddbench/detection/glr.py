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
    """``2 log`` of the likelihoods that a sensor is faulty and that it is not, over sensors and pairs, shapes and onsets.

    A hypothesis is a step or a ramp since some onset: of one size on one sensor, of one size on two, or of two sizes on two
    (which costs a threshold, since two sizes fit more). Its ratio is ``(g' C^-1 a)^2 / g' C^-1 g`` with the sizes a that fit
    each sensor best, or what it leaves unexplained less than no fault does. The sizes err together with the prediction: C is
    ``R / Σw² I + P (Σw / Σw²)² 1 1'``, with the variance P of the filter, which grows while it coasts. A single sensor and
    the other two leave the same differences, so they are told apart by the prediction, as well as it is known. What speaks
    against a sensor is the largest ratio with it less the largest one without.

    Model assumed: the yaw-moment equation with estimated shares, see `fddbench.detection.yaw_moment`. Blind to what differs
    by less than `differ_deg_s`. Noisy with model errors beyond P. Knobs: longer windows find smaller and slower faults, at
    ratios that a short one has not; the threshold trades these for wrong sites. Cost: 694
    operations with two windows.

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
    >>> flight.detectors["glr_yaw_rate"]["n_declared"][[200, 217], 0]
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
        pairs = tuple(combinations(range(self.n), 2))
        self.alike = (*((i,) for i in range(self.n)), *pairs)
        self.hypotheses = (*self.alike, *pairs)
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
        tried = [
            self._ratios(sums[self.n * m : self.n * (m + 1)], shape, common)
            for m, L in enumerate(self.lengths)
            for sums, shape in ((plain, _step(L)), (weighted, _ramp(L)))
        ]
        ratio = self._against([reduce(np.maximum, one) for one in zip(*tried, strict=True)])
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

    def _ratios(self, sums: Rows, shape: _Shape, common: Row) -> list[Row]:
        """Ratio of every hypothesis for one shape and onset; of the sums, which are the sizes times Σw²."""
        alpha, beta = self.watch.filter.noise * shape.squared, common * (shape.common * shape.common)
        s, n, every = list(sums), float(self.n), total(sums)
        gamma = beta / (alpha + n * beta)
        together, ratios = gamma * every, []
        for group in self.alike:
            k = float(len(group))
            spoken = total([s[i] for i in group]) - k * together
            ratios.append(spoken * spoken / (alpha * (k - k * k * gamma)))
        squares = sums * sums
        all_left = total(squares) - together * every
        share = beta / (alpha + (n - 2.0) * beta)
        for pair in self.alike[self.n :]:
            rest = [i for i in range(self.n) if i not in pair]
            sum_left = total([s[i] for i in rest])
            left = total([squares[i] for i in rest]) - share * sum_left * sum_left
            ratios.append((all_left - left) / alpha - self.gains.ratio_threshold)
        return ratios

    def _against(self, ratios: list[Row]) -> Rows:
        """Best ratio with each sensor less the best without it, (n_sensors, n_cases), not negative."""
        rows = []
        for i in range(self.n):
            own = [r for r, group in zip(ratios, self.hypotheses, strict=True) if i in group]
            other = [r for r, group in zip(ratios, self.hypotheses, strict=True) if i not in group]
            rows.append(np.maximum(largest(own) - np.maximum(largest(other), 0.0), 0.0))
        return np.stack(rows)


def _step(length: int) -> _Shape:
    """Of w = 1."""
    return _Shape(squared=float(length), common=float(length))


def _ramp(length: int) -> _Shape:
    """Of w = 1 … L."""
    L = float(length)
    return _Shape(squared=L * (L + 1.0) * (2.0 * L + 1.0) / 6.0, common=L * (L + 1.0) / 2.0)
