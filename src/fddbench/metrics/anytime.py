"""Evidence that may be looked at as often as one likes: capital won by betting on one bounded number after the other.

Number i of an aircraft is turned into a gain ``g_i >= -1`` whose expectation is at most 0, whatever came before, where the
hypothesis holds. Who stakes the share c of his capital on every one has ``K_n = prod (1 + c g_i)``, a nonnegative
supermartingale of expectation at most 1, and so has the mean over several c, fixed beforehand (`bets`). By Ville's inequality
``max_n K_n`` ever reaches 1/a with probability at most a: a hypothesis that is refuted when it does is refuted falsely in at
most a of the campaigns, however often one looks and whenever one stops. The mean over few bets costs little against the best
one, which nobody knows beforehand: at 99 % against 98 % it decides 77 % of the campaigns within 1500 aircraft, the best one
84 %, plug-in bets (aGRAPA) 47 %, because a share near 1 shows its variance late, and half of each 67 %.

References
----------
Waudby-Smith and Ramdas (2024), Estimating means of bounded random variables by betting, Journal of the Royal Statistical
Society B 86(1), 1-27: the capital process, mixtures of bets, confidence sequences by inversion.
Ville (1939), Etude critique de la notion de collectif, Gauthier-Villars: the inequality.
Shafer (2021), Testing by betting, Journal of the Royal Statistical Society A 184(2), 407-431.
"""

from collections.abc import Callable
from math import log

import numpy as np

from fddbench.interfaces import Floats

__all__ = ["bets", "edge", "first_crossing", "log_capital", "numbers_needed"]

_MOST = 1e9
"""Numbers beyond which a decision is none."""


def bets(mean: float) -> Floats:
    """Shares of the capital to stake, where the bounded number has this mean [0 to 1] on the boundary, (n_bets,), each below 1.

    For a yes or no of probability q the best share is ``(q - mean) / (1 - mean)``: four for means near 1, where q can only be
    a little larger, and ten from a quarter above the mean on for small ones, where it can be much.

    >>> bets(0.98).tolist()
    [0.2, 0.4, 0.6, 0.9]
    """
    return np.array([0.2, 0.4, 0.6, 0.9]) if mean >= 0.5 else np.geomspace(0.25 * mean, 0.95, 10)


def log_capital(gains: Floats, staked: Floats) -> Floats:
    """Logarithm of the capital after each gain, (n,): the mean over the bets.

    Parameters
    ----------
    gains : (n,) array
        At least -1, in the order in which they came.
    staked : (n_bets,) array
        Shares of the capital, 0 to below 1.

    Examples
    --------
    >>> log_capital(np.array([1.0, -1.0]), np.array([0.5])).round(4).tolist()
    [0.4055, -0.2877]
    """
    each = np.cumsum(np.log1p(np.outer(staked, np.maximum(gains, -1.0))), axis=1)
    most = each.max(axis=0)
    found: Floats = most + np.log(np.exp(each - most).mean(axis=0))
    return found


def first_crossing(gains: Floats, staked: Floats, confidence: float) -> int | None:
    """Numbers after which the hypothesis is refuted for good, None while it is not.

    Parameters
    ----------
    confidence : float
        One less the largest probability of a false refutation.
    """
    if not len(gains):
        return None
    over = log_capital(gains, staked) >= -log(1.0 - confidence)
    return int(over.argmax()) + 1 if over.any() else None


def numbers_needed(gains: Floats, staked: Floats, confidence: float) -> int | None:
    """Numbers, those so far among them, after which the hypothesis is refuted if they go on as they were; None for never."""
    if not len(gains):
        return None
    growth = np.log1p(np.outer(staked, np.maximum(gains, -1.0))).mean(axis=1)
    wanted = -log(1.0 - confidence)

    def enough(n: float) -> bool:
        each = n * growth
        return bool(each.max() + log(float(np.exp(each - each.max()).mean())) >= wanted)

    if growth.max() <= 0.0 or not enough(_MOST):
        return None
    low, high = 0.0, _MOST
    while high - low > 0.5:
        middle = (low + high) / 2.0
        low, high = (low, middle) if enough(middle) else (middle, high)
    return int(np.ceil(high - 1e-9))


def edge(refuted: Callable[[float], bool]) -> float:
    """Largest number from 0 to 1 up to which everything is refuted, to 1e-9; 0 where nothing is."""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if refuted(middle) else (low, middle)
    return low


_HALVINGS = 30
