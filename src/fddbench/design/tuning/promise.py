"""What thresholds that were chosen on some flights promise on others.

A threshold that leaves k of n flights beyond itself is, to the resolution of the search, the (k+1)-th largest of their peaks,
so the share of all flights beyond it is not k/n but a beta variable, ``P ~ B(k + d, n + 1 - k - d)`` with d = 1: its mean is
(k + 1)/(n + 1), whatever the peaks are distributed like. With d thresholds chosen each for itself on the same flights, d more
flights have been used up. That is why 1 % on the flights of tuning are more on others. The rate per hour is likewise a gamma
variable, ``G(k + d) / T``. Flights of one run are one aircraft in the same air: k, n and T are the effective ones of
`fddbench.metrics.clustered` and `fddbench.metrics.exposure`.

References
----------
Wilks (1941), Determination of sample sizes for setting tolerance limits, Annals of Mathematical Statistics 12(1), 91-96.
Tukey (1947), Nonparametric estimation II: statistically equivalent blocks and tolerance regions, Annals of Mathematical
Statistics 18(4), 529-539.
"""

from dataclasses import dataclass
from math import ceil, inf
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy.special import betaincinv, gammaincinv
from scipy.stats import beta

from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.metrics.clustered import quantile_ratio
from fddbench.metrics.exposure import alarm_rate

__all__ = ["Healthy", "Promise", "Target", "promise"]

_INTERVAL = 0.95


@dataclass(frozen=True, kw_only=True, eq=False)
class Healthy:
    """Distinct healthy flights of a detector, (n_flights,) each.

    Attributes
    ----------
    alarm : array of bool
        Whether there was a false alarm.
    time_s : array
        Time to it, or to the end [s].
    run : array
        Run of the flight; flights of one run are one aircraft in the same air.
    """

    alarm: npt.NDArray[np.bool_]
    time_s: Floats
    run: npt.NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class Promise:
    """False alarms on the flights of tuning and, expected, on others, by the unit of the target.

    Attributes
    ----------
    alarms, flights, runs : int
        Distinct flights with a false alarm, all distinct flights, and their runs.
    hours : float
        Flight up to the first alarm [h].
    here : float
        Share of these flights [-], or alarms per hour of them [1/h].
    expected : float
        Mean of the same on other flights.
    low, high : float
        Ends of its interval with 95 % confidence.
    limit : float
        What it stays below with the confidence of the target; `expected` where the target has none.
    """

    alarms: int
    flights: int
    runs: int
    hours: float
    here: float
    expected: float
    low: float
    high: float
    limit: float


@dataclass(frozen=True, kw_only=True)
class Target:
    """False alarms that are allowed.

    Attributes
    ----------
    most : float
        Share of flights, 0 to below 1 [-], or alarms per hour, above 0 [1/h].
    per : {"flight", "hour"}
        Which of both.
    on : {"these", "others"}
        The flights of tuning, as counted; or all others, as they promise.
    confidence : float or None
        With which it shall hold on others [-]; None: on average.
    """

    most: float
    per: Literal["flight", "hour"] = "flight"
    on: Literal["these", "others"] = "others"
    confidence: float | None = None

    def __post_init__(self) -> None:
        """Refuse what no flights can keep."""
        least_ok = self.most > 0.0 or (self.on == "these" and self.most == 0.0)
        if not least_ok or (self.per == "flight" and self.most >= 1.0) or not self.most < inf:
            need = "a share above 0 and below 1, e.g. 0.01" if self.per == "flight" else "a rate above 0, e.g. 0.1"
            raise DesignError(f"a target of false alarms per {self.per} is {need}; got {self.most:g}")
        if self.confidence is not None and not 0.5 <= self.confidence < 1.0:
            raise DesignError(f"a confidence is from 0.5 to below 1, e.g. 0.95; got {self.confidence:g}")

    @property
    def words(self) -> str:
        """The target in words."""
        most = f"{100.0 * self.most:g} % of the flights" if self.per == "flight" else f"{self.most:g} per hour"
        if self.on == "these":
            return f"at most {most}"
        how = "on average" if self.confidence is None else f"with {100.0 * self.confidence:g} % confidence"
        return f"at most {most} on other flights, {how}"

    def kept(self, promised: Promise) -> bool:
        """Whether it is kept."""
        found = promised.here if self.on == "these" else promised.limit
        return found <= self.most * (1.0 + 1e-12)

    def runs_needed(self, fitted: int, hours_a_run: float) -> int:
        """Independent runs without a false alarm with which the target would just be kept."""
        if self.on == "these":
            return 1
        if self.per == "hour":
            hours = fitted if self.confidence is None else float(gammaincinv(fitted, self.confidence))
            return ceil(hours / self.most / hours_a_run - 1e-9)
        if self.confidence is None:
            return ceil(fitted / self.most - 1.0 - 1e-9)
        low, high = fitted, fitted
        while beta.ppf(self.confidence, fitted, high - fitted + 1) > self.most:
            low, high = high, 2 * high
        while high - low > 1:
            middle = (low + high) // 2
            too_few = beta.ppf(self.confidence, fitted, middle - fitted + 1) > self.most
            low, high = (middle, high) if too_few else (low, middle)
        return high


def promise(healthy: Healthy, target: Target, *, fitted: int = 1) -> Promise:
    """What flights say of thresholds that were chosen on them.

    Parameters
    ----------
    fitted : int
        Thresholds chosen each for itself; 1 for one factor on all.

    Raises
    ------
    DesignError
        There are fewer than two runs, or no flight lasts.
    """
    rate = alarm_rate(healthy.alarm, healthy.time_s, healthy.run, confidence=_INTERVAL)
    if rate.runs < 2 or rate.exposure_h == 0.0:
        raise DesignError(
            f"{rate.flights} healthy flights of {rate.runs} run(s), {rate.exposure_h:.3g} h up to the first alarm, tell "
            "nothing of other flights; tune on more runs (dispersions.monte_carlo.runs)"
        )
    tail = (1.0 - _INTERVAL) / 2.0
    if target.per == "flight":
        n = (rate.share.effective_trials or 0.0) * quantile_ratio(rate.flights, rate.runs, _INTERVAL) ** 2
        k, here = n * rate.alarms / rate.flights, rate.alarms / rate.flights
        expected = min((k + fitted) / (n + 1.0), 1.0)
        low, limits = rate.share.low, [_share(k, n, fitted, level) for level in _levels(target, tail)]
    else:
        weight = quantile_ratio(rate.flights, rate.runs, _INTERVAL) ** 2 / (rate.design_effect or 1.0)
        k, hours, here = weight * rate.alarms, weight * rate.exposure_h, rate.alarms / rate.exposure_h
        expected = (k + fitted) / hours
        low, limits = rate.low, [float(gammaincinv(k + fitted, level)) / hours for level in _levels(target, tail)]
    return Promise(
        alarms=rate.alarms, flights=rate.flights, runs=rate.runs, hours=rate.exposure_h, here=here, expected=expected,
        low=low or 0.0, high=limits[0], limit=expected if target.confidence is None else limits[1],
    )  # fmt: skip


def _levels(target: Target, tail: float) -> tuple[float, float]:
    """Of the upper end of the interval, and of the confidence of the target."""
    return 1.0 - tail, target.confidence or 0.5


def _share(k: float, n: float, fitted: int, level: float) -> float:
    """Quantile of the share of other flights beyond thresholds; 1 where nothing is left to tell."""
    return float(betaincinv(k + fitted, n + 1.0 - k - fitted, level)) if n + 1.0 - k - fitted > 0.0 else 1.0
