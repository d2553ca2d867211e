"""False alarms per flight hour: alarms over an exposure that ends at the first alarm.

Of f distinct flights of G runs, run g has d_g alarms (at most one a flight) in t_g of healthy flight up to them;
``D = sum d_g``, ``T = sum t_g``. D/T is the likelihood's maximum for a constant rate and flights that are watched until
their first alarm. Its interval is Garwood's at the *effective* exposure::

    deff = max(1, G/(G-1) sum (d_g - D/T t_g)^2 / D)    f/G where D = 0
    deff = max(deff, f/G)                               where fewer than 3 runs have an alarm
    k    = (t_(f-1) / t_(G-1))^2 / deff                 t: 1-a/2 quantiles of Student, a = 1 - confidence
    low  = G(a/2; k D) / (k T),  high = G(1-a/2; k D + 1) / (k T)    G: quantiles of the gamma distribution

The same run at four points is not four runs: without deff the interval covers down to 68 % there, and 80 % where alarms
bunch early. Where the rate is not constant, D/T is the mean rate until the first alarm in flights of this length.

References
----------
Garwood (1936), Fiducial limits for the Poisson distribution, Biometrika 28(3/4), 437-442.
Cochran (1977), Sampling Techniques, 3rd edition, Wiley, chapter 6: the design effect of a ratio. Putting both together is
ours.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats
from fddbench.metrics.clustered import PooledShare, korn_graubard, quantile_ratio, sums_by_run
from fddbench.metrics.intervals import poisson_rate

__all__ = ["AlarmRate", "alarm_rate"]


@dataclass(frozen=True, kw_only=True)
class AlarmRate:
    """How often a detector raises a false alarm; null means that the flights do not tell.

    Attributes
    ----------
    alarms, flights, runs : int
        Distinct flights with a false alarm, all distinct flights, and the independent runs that they come from.
    exposure_h : float
        Healthy flight up to the first alarm [h].
    per_hour : float or None
        Alarms over exposure [1/h], the mean rate until the first alarm in flights of this length; None without exposure.
    design_effect : float or None
        Variance over that of independent flights of a constant rate [-], at least 1; None without an interval.
    low, high : float or None
        Ends of the interval of the rate [1/h]; None with fewer than two runs or without exposure.
    share : PooledShare
        Share of distinct flights with a false alarm, with its interval by run; it needs no constant rate.
    """

    alarms: int
    flights: int
    runs: int
    exposure_h: float
    per_hour: float | None
    design_effect: float | None = None
    low: float | None = None
    high: float | None = None
    share: PooledShare


def alarm_rate(
    alarms: npt.ArrayLike, time_s: npt.ArrayLike, runs: npt.ArrayLike, *, confidence: float = 0.95
) -> AlarmRate:
    """Rate of false alarms of distinct flights, with its interval by run; the formula is that of this module.

    Without exposure (every flight alarms at sample 0) a count and no rate. One run: a rate and no interval.

    Parameters
    ----------
    alarms : (n_flights,) array of bool
        Whether each distinct flight had a false alarm.
    time_s : (n_flights,) array
        Time to it, or to the end of the healthy stretch [s]; see `fddbench.metrics.distinct.distinct_flights`.
    runs : (n_flights,) array
        Run of each flight, any labels.
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    AlarmRate
        Counts, exposure, rate and share with their intervals.

    Raises
    ------
    FddbenchError
        Arrays of different lengths, a flight without a run, an alarm other than 0 or 1, or a time that is negative or
        not a number.

    Examples
    --------
    Ten runs of 60 s, of which three alarm at 1 s:

    >>> rate = alarm_rate([True] * 3 + [False] * 7, [1.0] * 3 + [60.0] * 7, range(10))
    >>> rate.alarms, round(rate.exposure_h * 3600.0, 6), round(rate.design_effect, 4)
    (3, 423.0, 1.5649)
    >>> round(rate.per_hour, 2), round(rate.low, 2), round(rate.high, 2)
    (25.53, 2.89, 94.46)
    """
    d, t = np.asarray(alarms, dtype=np.float64), np.asarray(time_s, dtype=np.float64)
    if not np.all((d == 0.0) | (d == 1.0)):
        raise FddbenchError("need alarms of 0 or 1: a flight alarms once, however often the detector lets go")
    if not np.all((t >= 0.0) & (t < np.inf)):
        raise FddbenchError(
            "need a time >= 0 for every flight: to its first alarm, or to the end of its healthy stretch"
        )
    by_run = sums_by_run(runs, alarms=d, time_s=t)
    d_g, t_g = by_run["alarms"], by_run["time_s"]
    n_alarms, n_runs, hours = float(d_g.sum()), len(d_g), float(t_g.sum()) / 3600.0
    share, per_hour = korn_graubard(d, runs, confidence=confidence), n_alarms / hours if hours else None
    counts = {"alarms": int(n_alarms), "flights": len(d), "runs": n_runs}
    rate = AlarmRate(**counts, exposure_h=hours, per_hour=per_hour, share=share)
    if hours == 0.0 or n_runs < 2:
        return rate
    effect = _design_effect(d_g, t_g, len(d))
    kappa = quantile_ratio(len(d), n_runs, confidence) ** 2 / effect
    low, high = poisson_rate(kappa * n_alarms, kappa * hours, confidence)
    return replace(rate, design_effect=effect, low=float(low), high=float(high))


def _design_effect(d_g: Floats, t_g: Floats, flights: int) -> float:
    """Of alarms and time of each run, at least 1: what runs that alarm together or early take from the exposure."""
    n_runs, n_alarms = len(d_g), float(d_g.sum())
    if n_alarms == 0.0:
        return flights / n_runs
    spread = float(((d_g - n_alarms / float(t_g.sum()) * t_g) ** 2).sum())
    effect = max(1.0, n_runs / (n_runs - 1) * spread / n_alarms)
    return max(effect, flights / n_runs) if np.count_nonzero(d_g) < 3 else effect
