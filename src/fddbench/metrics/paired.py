"""Two detectors on the same flights: what differs, and whether chance alone would differ as much.

Flights of one run share aircraft and air and count as one look: what is tested is whether the net difference of a run, over its
points and levels, is more often positive than negative. With one flight a run this is McNemar's exact test.

References
----------
McNemar (1947), Note on the sampling error of the difference between correlated proportions, Psychometrika 12(2), 153-157.
Bonett and Price (2012), Adjusted Wald confidence interval for a difference of binomial proportions based on paired data,
Journal of Educational and Behavioral Statistics 37(4), 479-488: two more pairs, one of each discordant kind; here two runs.
Holm (1979), A simple sequentially rejective multiple test procedure, Scandinavian Journal of Statistics 6(2), 65-70.
Conover (1999), Practical nonparametric statistics, 3rd ed., chapter 3: the interval of a median by order statistics.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import bdtr, bdtrik, ndtri

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["PairedShares", "PairedTimes", "holm", "paired_shares", "paired_times"]


@dataclass(frozen=True, kw_only=True)
class PairedShares:
    """Two shares of the same flights.

    Attributes
    ----------
    pairs, runs : int
        Flights that both decided, and the runs that they come from.
    only_a, only_b : int
        Flights that count for one alone.
    difference : float or None
        Share of b less share of a [-]; None without a pair.
    low, high : float or None
        Ends of its 95 % interval [-]; None with fewer than two runs.
    p_value : float or None
        Exact, two-sided, by run: how often chance alone gives as much; 1 where nothing differs.
    """

    pairs: int
    runs: int
    only_a: int
    only_b: int
    difference: float | None
    low: float | None
    high: float | None
    p_value: float | None


@dataclass(frozen=True, kw_only=True)
class PairedTimes:
    """Differences of two times of the same flights [s]: the median over runs of b less a, and its interval."""

    pairs: int
    median_s: float | None
    low_s: float | None
    high_s: float | None
    p_value: float | None


def paired_shares(a: npt.ArrayLike, b: npt.ArrayLike, runs: npt.ArrayLike, confidence: float = 0.95) -> PairedShares:
    """Compare two shares of the same flights.

    Parameters
    ----------
    a, b : (n,) arrays of bool
        Whether each flight counts for either.
    runs : (n,) array
        Run of each flight, any labels.
    confidence : float
        Of the interval [-].

    Examples
    --------
    >>> found = paired_shares([1] * 10 + [0] * 10, [1] * 18 + [0] * 2, range(20))
    >>> found.only_a, found.only_b, round(found.difference, 2), round(found.p_value, 4)
    (0, 8, 0.4, 0.0078)
    """
    first, second, label = (np.asarray(each) for each in (a, b, runs))
    if not len(first) == len(second) == len(label):
        raise FddbenchError(f"need as many flights of both and runs, got {len(first)}, {len(second)}, {len(label)}")
    net = second.astype(np.int64) - first.astype(np.int64)
    of_run, size = _by_run(net, label)
    n, g = len(net), len(of_run)
    more = {"pairs": n, "runs": g, "only_a": int(np.sum(net < 0)), "only_b": int(np.sum(net > 0))}
    if n == 0:
        return PairedShares(**more, difference=None, low=None, high=None, p_value=None)
    low, high = _ends(of_run / size.mean(), confidence) if g > 1 else (None, None)
    return PairedShares(**more, difference=float(net.mean()), low=low, high=high, p_value=_sign_test(of_run))


def paired_times(a_s: npt.ArrayLike, b_s: npt.ArrayLike, runs: npt.ArrayLike, confidence: float = 0.95) -> PairedTimes:
    """Compare two times of the same flights [s]; flights without both times are left out.

    The median is that of the means of the runs; its interval is exact whatever their distribution, and has no ends where there
    are too few runs for the confidence.
    """
    difference = np.asarray(b_s, dtype=np.float64) - np.asarray(a_s, dtype=np.float64)
    known = ~np.isnan(difference)
    total, size = _by_run(difference[known], np.asarray(runs)[known])
    if not known.any():
        return PairedTimes(pairs=0, median_s=None, low_s=None, high_s=None, p_value=None)
    ordered, n = np.sort(np.round(total / size, 12)), len(total)
    beyond = _cut_off(n, (1.0 - confidence) / 2.0)
    low, high = (float(ordered[beyond - 1]), float(ordered[n - beyond])) if beyond else (None, None)
    middle = float(np.median(ordered))
    return PairedTimes(pairs=int(known.sum()), median_s=middle, low_s=low, high_s=high, p_value=_sign_test(ordered))


def holm(p_values: npt.ArrayLike) -> Floats:
    """Adjusted for how many are looked at: below 0.05 holds for all together in 95 % of the cases; NaN stays and counts not.

    >>> holm([0.01, 0.04, 0.03]).round(3).tolist()
    [0.03, 0.06, 0.06]
    """
    p = np.asarray(p_values, dtype=np.float64)
    adjusted, known = np.full(len(p), np.nan), np.flatnonzero(~np.isnan(p))
    order = known[np.argsort(p[known], kind="stable")]
    factors = np.arange(len(order), 0, -1)
    adjusted[order] = np.minimum(np.maximum.accumulate(factors * p[order]), 1.0)
    return adjusted


def _by_run(values: npt.NDArray[Any], runs: npt.NDArray[Any]) -> tuple[Floats, Floats]:
    """Sum and number of the values of each run."""
    _, place = np.unique(runs, return_inverse=True)
    weights = values.astype(np.float64)
    return np.bincount(place, weights=weights).astype(np.float64), np.bincount(place).astype(np.float64)


def _cut_off(n: int, level: float) -> int:
    """Order statistics cut off at either end, so many that fewer of n fair coins show heads with this probability at most."""
    most = max(int(np.ceil(bdtrik(level, n, 0.5))), 0)
    while most and bdtr(most - 1, n, 0.5) > level:
        most -= 1
    return most


def _ends(of_run: Floats, confidence: float) -> tuple[float, float]:
    """Interval of the mean over runs, two of them added: one for either side."""
    own = np.concatenate([of_run, [1.0, -1.0]])
    mean, error = float(own.mean()), float(np.sqrt(np.mean((own - own.mean()) ** 2) / len(own)))
    away = float(ndtri(0.5 + confidence / 2.0)) * error
    return max(mean - away, -1.0), min(mean + away, 1.0)


def _sign_test(of_run: Floats) -> float:
    """How often as many runs of one sign, two-sided; runs without a difference say nothing."""
    up, down = int(np.sum(of_run > 0.0)), int(np.sum(of_run < 0.0))
    return float(min(2.0 * bdtr(min(up, down), up + down, 0.5), 1.0)) if up + down else 1.0
