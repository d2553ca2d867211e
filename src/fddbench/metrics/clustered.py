"""Shares pooled over points, levels or scenarios: intervals that know which rows are the same aircraft in the same air.

Rows of one run fail together and tell less than as many independent flights. Run g of G has y_g hits in n_g rows,
``N = sum n_g``, ``p = sum y_g / N``::

    v     = G/(G-1) sum (y_g - p n_g)^2 / N^2
    n_eff = min(p (1-p) / v, N)                      N where v = 0, and where every run has one row
    n_eff = min(n_eff, G)                            fewer than 3 runs with a hit, or fewer than 3 with a miss
    n*    = n_eff (t_(N-1) / t_(G-1))^2,  x* = p n*  t: 1-a/2 quantiles of Student, a = 1 - confidence

and the interval is that of Clopper and Pearson for x* of n*, both real. The last cap is ours: where all runs agree v is 0,
and 0 of 225 rows would look like "below 1.6 %" although only 25 aircraft flew; without it 25 runs of nine rows that fail
together (p = 0.02) hold the truth in 38 % of the campaigns.

References
----------
Korn and Graubard (1998), Confidence intervals for proportions with small expected number of positive counts estimated
from survey data, Survey Methodology 24(2), 193-201.
Parker et al. (2017), National Center for Health Statistics data presentation standards for proportions, Vital and Health
Statistics 2(175): the cap at N.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats
from fddbench.metrics.intervals import beta_interval

__all__ = ["PooledShare", "counts_by_run", "korn_graubard", "pooled_intervals", "quantile_ratio", "sums_by_run"]


@dataclass(frozen=True, kw_only=True)
class PooledShare:
    """A share of rows and its interval; null means that the rows do not tell.

    Attributes
    ----------
    hits, trials, runs : int
        Rows that count, all rows, and the independent runs that they come from.
    share : float or None
        Hits over trials [-]; None without a trial.
    effective_trials : float or None
        As many independent rows would tell as much [-], before the correction for few runs; None without an interval.
    low, high : float or None
        Ends of the interval [-]; None with fewer than two runs.
    """

    hits: int
    trials: int
    runs: int
    share: float | None
    effective_trials: float | None = None
    low: float | None = None
    high: float | None = None


def korn_graubard(
    hits: npt.ArrayLike, runs: npt.ArrayLike, *, trials: npt.ArrayLike | None = None, confidence: float = 0.95
) -> PooledShare:
    """Share of rows that come from several runs, with its interval by run; the formula is that of this module.

    One row in every run: exactly Clopper and Pearson. One run in all: a share and no interval.

    Parameters
    ----------
    hits : (n,) array of bool or int
        Whether each row counts; with `trials` how many do.
    runs : (n,) array
        Run of each row, any labels; equal labels are one run wherever they stand.
    trials : int or (n,) array of int, optional
        Rows that each entry stands for; by default 1.
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    PooledShare
        Counts, share and interval.

    Raises
    ------
    FddbenchError
        Arrays of different lengths, a row without a run, hits outside 0 to trials.

    Examples
    --------
    25 runs of nine rows each, of which three had 9, 5 and 1 hits:

    >>> pooled = korn_graubard([9, 5, 1] + [0] * 22, range(25), trials=9)
    >>> pooled.hits, pooled.trials, round(pooled.share, 4), round(pooled.effective_trials, 3)
    (15, 225, 0.0667, 30.857)
    >>> round(pooled.low, 4), round(pooled.high, 4)
    (0.0074, 0.2279)

    No hit at all is that of 25 runs, not of 225 rows:

    >>> none = korn_graubard([0] * 25, range(25), trials=9)
    >>> none.low, round(none.high, 4)
    (0.0, 0.1494)
    """
    y, n = np.asarray(hits), np.asarray(1 if trials is None else trials)
    n = np.broadcast_to(n, y.shape) if n.ndim == 0 else n
    by_run = sums_by_run(runs, hits=y, trials=n)
    if not np.all((y >= 0) & (y <= n)):
        raise FddbenchError(
            "need 0 <= hits <= trials in every row; without `trials` a row is one trial, hits are 0 or 1"
        )
    seen = by_run["trials"] > 0
    return _pooled(by_run["hits"][seen], by_run["trials"][seen], confidence)


def _pooled(y_g: Floats, n_g: Floats, confidence: float) -> PooledShare:
    """Share and interval of hits and rows of each run, (n_runs,)."""
    trials, runs = float(n_g.sum()), len(n_g)
    pooled = PooledShare(hits=int(y_g.sum()), trials=int(trials), runs=runs, share=None)
    if runs == 0:
        return pooled
    share = float(y_g.sum()) / trials
    if runs == 1:
        return replace(pooled, share=share)
    effective = _effective_trials(y_g, n_g)
    shrunk = effective * quantile_ratio(int(trials), runs, confidence) ** 2
    low, high = beta_interval(share * shrunk, shrunk, confidence)
    return replace(pooled, share=share, effective_trials=effective, low=float(low), high=float(high))


def _effective_trials(y_g: Floats, n_g: Floats) -> float:
    """n_eff, before the quantiles; y_g N - n_g sum(y) is whole, so runs that agree have exactly v = 0."""
    n_runs, hits, trials = len(n_g), float(y_g.sum()), float(n_g.sum())
    v = n_runs / (n_runs - 1) * float((((y_g * trials - n_g * hits) / trials**2) ** 2).sum())
    p = hits / trials
    effective = trials if v == 0.0 or trials == n_runs else min(p * (1.0 - p) / v, trials)
    if min(np.count_nonzero(y_g > 0), np.count_nonzero(y_g < n_g)) < 3:
        effective = min(effective, float(n_runs))
    return effective


def counts_by_run(
    place: npt.NDArray[np.integer[Any]], hit: npt.NDArray[np.bool_], run: npt.ArrayLike, n_places: int
) -> tuple[Floats, Floats]:
    """Hits and rows of each run at each place, (n_runs, n_places) each: what `pooled_intervals` takes.

    Parameters
    ----------
    place : (n,) array of int
        Where each row counts, 0 to n_places - 1; one below 0 counts nowhere.
    hit : (n,) array of bool
    run : (n,) array
        Run of each row, any labels.
    n_places : int

    Examples
    --------
    >>> hits, trials = counts_by_run(np.array([0, 1, 1, -1]), np.array([True, False, True, True]), [7, 7, 9, 9], 2)
    >>> hits.tolist(), trials.tolist()
    ([[1.0, 0.0], [0.0, 1.0]], [[1.0, 1.0], [0.0, 1.0]])
    """
    _, runs = np.unique(np.asarray(run), return_inverse=True)
    known, shape = place >= 0, (int(runs.max(initial=-1)) + 1, n_places)
    hits, trials = np.zeros(shape), np.zeros(shape)
    np.add.at(trials, (runs[known], place[known]), 1.0)
    np.add.at(hits, (runs[known & hit], place[known & hit]), 1.0)
    return hits, trials


def pooled_intervals(hits: Floats, trials: Floats, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Intervals of `korn_graubard` of many shares of the same runs at once; NaN where fewer than two runs have a row.

    Parameters
    ----------
    hits, trials : (n_runs, n_shares) arrays
        Rows of each run that count, and all of them.
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    low, high : (n_shares,) arrays
        Ends of the intervals [-].

    Examples
    --------
    >>> low, high = pooled_intervals(np.array([[1.0, 1.0]] * 3 + [[0.0, 1.0]]), np.ones((4, 2)))
    >>> low.round(3).tolist(), high.round(3).tolist()
    ([0.194, 0.398], [0.994, 1.0])
    """
    from scipy.special import stdtrit

    n_runs, n = (trials > 0).sum(axis=0).astype(np.float64), trials.sum(axis=0)
    low, high = np.full(hits.shape[1], np.nan), np.full(hits.shape[1], np.nan)
    several = n_runs > 1
    if not several.any():
        return low, high
    y_g, n_g, g, n = hits[:, several], trials[:, several], n_runs[several], n[several]
    y = y_g.sum(axis=0)
    p = y / n
    v = g / (g - 1.0) * (((y_g * n - n_g * y) / n**2) ** 2).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = np.where((v == 0.0) | (n == g), n, np.minimum(p * (1.0 - p) / v, n))
    few = np.minimum((y_g > 0).sum(axis=0), (y_g < n_g).sum(axis=0)) < 3
    effective = np.where(few, np.minimum(effective, g), effective)
    level = (1.0 + confidence) / 2.0
    shrunk = effective * (stdtrit(n - 1.0, level) / stdtrit(g - 1.0, level)) ** 2
    low[several], high[several] = beta_interval(np.minimum(p * shrunk, shrunk), shrunk, confidence)
    return low, high


def sums_by_run(runs: npt.ArrayLike, **values: npt.ArrayLike) -> dict[str, Floats]:
    """Sum of each of the (n,) `values` over the entries of every run, (n_runs,), runs in order of appearance.

    >>> sums_by_run([7, 3, 7], alarms=[1, 0, 1])["alarms"]
    array([2., 0.])
    """
    import pandas as pd

    labels = pd.Series(runs)
    codes, known = pd.factorize(labels)
    columns = {name: np.asarray(column, dtype=np.float64) for name, column in values.items()}
    lengths = {"runs": labels.shape} | {name: column.shape for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        raise FddbenchError(f"need one entry a row in each, got the shapes {lengths}")
    if np.any(codes < 0):
        raise FddbenchError(f"need a run for every row, {int((codes < 0).sum())} of {len(codes)} have none")
    return {
        name: np.bincount(codes, weights=column, minlength=len(known)).astype(np.float64)
        for name, column in columns.items()
    }


def quantile_ratio(n: int, n_runs: int, confidence: float) -> float:
    """Student's quantile of n - 1 over that of n_runs - 1 degrees of freedom: few runs know their own spread badly.

    >>> round(quantile_ratio(225, 25, 0.95) ** 2, 4)
    0.9116
    """
    from scipy.special import stdtrit

    if not 0.0 < confidence < 1.0:
        raise FddbenchError(f"need 0 < confidence < 1, got {confidence=}; write 95 % as 0.95")
    level = (1.0 + confidence) / 2.0
    return float(stdtrit(n - 1, level) / stdtrit(n_runs - 1, level))
