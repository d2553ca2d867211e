"""Seven models of the three yaw rates, healthy, one faulty or two, and how probable each of them is."""

from collections.abc import Mapping
from itertools import combinations
from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest, product, total
from fddbench.detection.decision import Standing, StandingGains, StandingState
from fddbench.detection.gust_filter import LATERAL_SIGNALS, GustFilter, GustFilterGains, GustFilterState, lateral
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict
from fddbench.units import RAD_PER_DEG

__all__ = ["MultipleModel", "MultipleModelGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class MultipleModelGains(StandingGains):
    """Numbers of the probabilities, and of the filters.

    Attributes
    ----------
    filter : GustFilterGains
        Of each filter; made by ``fddbench design``.
    agree_deg_s : float
        Standard deviation of a healthy sensor about the mean of the healthy ones [deg/s].
    fault_span_deg_s : float
        A faulty reading is anywhere within a span of this [deg/s], with the same density.
    evidence_samples : float
        Errors of the model last; so many samples count as one [-].
    least_probability : float
        No model falls below this share of the most probable one [-], so that it can come back.
    certain_probability : float
        A model is believed above this probability [-].
    """

    THRESHOLDS: ClassVar[Mapping[str, str]] = {"agree_deg_s": "up"}

    filter: GustFilterGains
    agree_deg_s: Positive
    fault_span_deg_s: Positive
    evidence_samples: Annotated[float, Field(ge=1.0, allow_inf_nan=False)]
    least_probability: Annotated[float, Field(gt=0.0, lt=0.1)]
    certain_probability: Annotated[float, Field(gt=0.5, lt=1.0)]


@record
class MultipleModelState:
    """The filters; log probabilities of the models, the most probable at 0; who stands accused or is declared."""

    filters: tuple[GustFilterState, ...]
    log_probability: Rows
    standing: StandingState


class MultipleModel:
    """Believes the model that explains all readings best: nobody faulty, one sensor, or two of them.

    Every model has a Kalman filter on the mean of the sensors that it holds for healthy; these must agree, and a faulty one
    may read anything; two faulty ones may read the same or not, whichever is more probable. Bayes' rule turns what a sample
    says into probabilities, none of which may fall below a bound.

    Model assumed: that of `KalmanGust`. Blind to faults too small to leave the agreement of the sensors, about four times
    `agree_deg_s`. The evidence adds up, so a small fault is told in time; so do errors of the model, which are no white
    noise: for them `evidence_samples` counts many samples as one. Knobs: that number trades delay for wrong decisions; the
    bound lets a verdict turn within that many units of evidence; `agree_deg_s` is the threshold. Cost: 1142 operations a
    sample.

    References
    ----------
    Magill (1965), Optimal adaptive estimation of sampled stochastic processes, IEEE Transactions on Automatic Control 10(4),
    434-439; Maybeck (1999), Multiple model adaptive algorithms for detecting and compensating sensor and actuator/surface
    failures in aircraft flight control systems, International Journal of Robust and Nonlinear Control 9(14), 1051-1070.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[multiple_model]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["multiple_model"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "seven Kalman filters, healthy, one faulty sensor or two, weighed by their probabilities"
    Gains = MultipleModelGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: MultipleModelGains, bus: Bus) -> None:
        self.gains, self.watches = gains, bus.redundant("r_deg_s", least=3)
        n = len(self.watches)
        self.modes = [faulty for size in range(n) for faulty in combinations(range(n), size)]
        self.recorded = tuple("p_" + ("_".join(self.watches[i] for i in m) or "healthy") for m in self.modes)
        self.filter, self.standing = GustFilter(gains.filter, bus), Standing.of(gains, bus, n)
        self.floor = float(np.log(gains.least_probability))
        self.states = Layout(
            MultipleModelState(
                filters=(self.filter.states.shape,) * n, log_probability=len(self.modes),
                standing=self.standing.states.shape,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: MultipleModelGains, bus: Bus) -> "MultipleModel":
        """Detector for a bus with the lateral signals and three yaw rates."""
        bus.require(*LATERAL_SIGNALS)
        if bus.signals["r_deg_s"] != 3:
            raise DesignError(f"its models are of three yaw rates, this benchmark has {bus.signals['r_deg_s']}")
        return cls(gains, bus)

    def start(self, c: Nothing) -> MultipleModelState:
        """In trim, all models as probable."""
        filters = tuple(self.filter.start(c) for _ in self.watches)
        return MultipleModelState(filters=filters, log_probability=0.0, standing=self.standing.start(c))

    def step(
        self, x: MultipleModelState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[MultipleModelState, Verdict]:
        """Verdict after one sample."""
        now, r_deg_s = lateral(measured), measured.r_deg_s
        filters, white = [], []
        for i, state in enumerate(x.filters):
            e = self.filter.innovation(state, now, r_deg_s[i] * RAD_PER_DEG)
            filters.append(self.filter.step(state, c, n, now, e, np.ones_like(e[0]))[0])
            white.append(product(self.filter.W, e))
        evidence = np.stack([self._log_likelihood(mode, white, r_deg_s) for mode in self.modes])
        log_p = x.log_probability + evidence / self.gains.evidence_samples
        log_p = np.maximum(log_p - largest(log_p), self.floor)
        p = exp(log_p)
        p = p / total(p)
        believed = np.where(p > self.gains.certain_probability, 1.0, 0.0)
        accused = np.stack([
            total([believed[m] for m, mode in enumerate(self.modes) if i in mode]) for i in range(len(self.watches))
        ])  # fmt: skip
        standing, declared = self.standing.step(x.standing, c, n, accused, total(accused) > 0.0)
        after = MultipleModelState(filters=tuple(filters), log_probability=log_p, standing=standing)
        residual = (1.0 - p[0]) / self.gains.certain_probability
        return after, Verdict(declared, residual, signals={name: p[m] for m, name in enumerate(self.recorded)})

    def _log_likelihood(self, mode: tuple[int, ...], white: list[Rows], r_deg_s: Rows) -> Row:
        """Of the sample, up to a constant that all models share.

        The filter of a model flies on the mean of its healthy sensors. All filters have the same gains and are linear, so it
        is the mean of the filters of these sensors and need not be flown.
        """
        g, healthy = self.gains, [i for i in range(len(r_deg_s)) if i not in mode]
        share = 1.0 / len(healthy)
        e = share * total([white[i] for i in healthy])
        found = -0.5 * total(e * e) + self._together([r_deg_s[i] for i in healthy])
        if not mode:
            return found
        apart = -float(np.log(g.fault_span_deg_s))
        alone = float(len(mode)) * apart
        return found + np.maximum(apart + self._together([r_deg_s[i] for i in mode]), alone)

    def _together(self, readings: list[Row]) -> Row:
        """Log density of readings of the same about their mean."""
        n, sigma = len(readings), self.gains.agree_deg_s
        mean = total(readings) * (1.0 / n)
        off = total([(r - mean) * (r - mean) for r in readings])
        return off * (-0.5 / (sigma * sigma)) - (n - 1) * float(np.log(np.sqrt(2.0 * np.pi) * sigma))
