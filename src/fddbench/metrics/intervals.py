"""Exact confidence intervals: a share of flights (Clopper-Pearson) and a rate per hour (Garwood).

They hold for independent flights. What pools flights of the same runs has `fddbench.metrics.clustered` and
`fddbench.metrics.exposure`, which ask for the same quantiles at a smaller, no longer whole number of flights or hours.
"""

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["beta_interval", "clopper_pearson", "poisson_rate"]


def clopper_pearson(hits: npt.ArrayLike, trials: npt.ArrayLike, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Exact interval of a probability from `hits` in `trials`, with equal tails.

    The ends are quantiles of beta distributions: ``low = B(a/2; k, n-k+1)``, 0 for k = 0, and
    ``high = B(1-a/2; k+1, n-k)``, 1 for k = n, with ``a = 1 - confidence``. Whatever the true probability, the interval
    holds it in at least this share of campaigns; for k = 0 in 100 flights it still reaches 3.6 %.

    Parameters
    ----------
    hits, trials : int or (...) arrays of them
        Counts, broadcast against each other.
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    low, high : (...) arrays
        Ends of the interval, as shares [-].

    Raises
    ------
    FddbenchError
        Counts that no experiment gives, or no trial at all: nothing flown has no rate.

    References
    ----------
    Clopper and Pearson (1934), The use of confidence or fiducial limits illustrated in the case of the binomial,
    Biometrika 26(4), 404-413.

    Examples
    --------
    >>> low, high = clopper_pearson([0, 100], 100)
    >>> [round(float(end), 4) for end in (*low, *high)]
    [0.0, 0.9638, 0.0362, 1.0]
    """
    k, n = np.asarray(hits, dtype=np.float64), np.asarray(trials, dtype=np.float64)
    if not np.all((k >= 0) & (k <= n) & (n >= 1)):
        raise FddbenchError(
            f"need 0 <= hits <= trials and trials >= 1, got {hits=}, {trials=}; "
            "with trials 0 there is no rate: callers show the count and leave the interval empty"
        )
    return beta_interval(k, n, confidence)


def beta_interval(hits: npt.ArrayLike, trials: npt.ArrayLike, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Formula of `clopper_pearson` for real numbers: effective hits in effective trials, ``0 <= hits <= trials``.

    Parameters
    ----------
    hits, trials : float or (...) arrays of them
        Effective numbers, broadcast against each other; neither need be whole, `trials` may lie below 1.
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    low, high : (...) arrays
        Ends of the interval, as shares [-].

    Raises
    ------
    FddbenchError
        Hits outside 0 to trials, or no trial at all.

    Examples
    --------
    >>> low, high = beta_interval(1.8754, 28.131)
    >>> round(float(low), 4), round(float(high), 4)
    (0.0074, 0.2279)
    """
    from scipy.special import betaincinv

    x, n = np.broadcast_arrays(np.asarray(hits, dtype=np.float64), np.asarray(trials, dtype=np.float64))
    tail = _tail(confidence)
    if not np.all((x >= 0) & (x <= n) & (n > 0)):
        raise FddbenchError(f"need 0 <= hits <= trials and trials > 0, got {hits=}, {trials=}")
    low = np.where(x > 0, betaincinv(np.where(x > 0, x, 1.0), n - x + 1.0, tail), 0.0)
    high = np.where(x < n, betaincinv(x + 1.0, np.where(x < n, n - x, 1.0), 1.0 - tail), 1.0)
    return low, high


def poisson_rate(events: npt.ArrayLike, hours: npt.ArrayLike, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Exact interval of a rate from `events` counted in `hours`, with equal tails.

    Quantiles of gamma distributions: ``low = G(a/2; k) / T``, 0 for k = 0, and ``high = G(1-a/2; k+1) / T``, with
    ``a = 1 - confidence``. No false alarm in T hours still allows 3.69 / T per hour.

    Parameters
    ----------
    events : float or (...) array
        Counted events, or their effective number, which need not be whole.
    hours : float or (...) array
        Exposure [h].
    confidence : float
        Between 0 and 1 [-].

    Returns
    -------
    low, high : (...) arrays
        Ends of the interval [1/h].

    Raises
    ------
    FddbenchError
        Negative counts, or no exposure: without an hour there is no rate.

    References
    ----------
    Garwood (1936), Fiducial limits for the Poisson distribution, Biometrika 28(3/4), 437-442.

    Examples
    --------
    >>> low, high = poisson_rate(0, 10.0)
    >>> float(low), round(float(high), 4)
    (0.0, 0.3689)
    """
    from scipy.special import gammaincinv

    k, t = np.broadcast_arrays(np.asarray(events, dtype=np.float64), np.asarray(hours, dtype=np.float64))
    tail = _tail(confidence)
    if not np.all((k >= 0) & (t > 0) & np.isfinite(t)):
        raise FddbenchError(
            f"need events >= 0 and hours > 0, got {events=}, {hours=}; "
            "with no exposure there is no rate: callers show the count and leave the interval empty"
        )
    low = np.where(k > 0, gammaincinv(np.where(k > 0, k, 1.0), tail), 0.0) / t
    return low, gammaincinv(k + 1.0, 1.0 - tail) / t


def _tail(confidence: float) -> float:
    if not 0.0 < confidence < 1.0:
        raise FddbenchError(f"need 0 < confidence < 1, got {confidence=}; write 95 % as 0.95")
    return (1.0 - confidence) / 2.0
