"""The smallest fault that is found in a given share of flights, of faults of many sizes.

The share of flights in which a fault is found rises with its size; nothing else is supposed. Flights are sorted by size and
cut, from the largest down, into a first group of at least ten and groups of at least four, never between equal sizes. The
shares of the groups are made monotone by isotonic regression, the estimate of greatest likelihood that never falls with the
size: neighbours that contradict it are pooled. The answer is the median size of the smallest group whose share is large
enough. Beside it stands what it rests on: the flights of all groups down to that one, how many were found, and the interval of
their share, by run. The first group is larger because the share of the few largest faults would often be 1 by chance.

Of sizes that are drawn evenly, and found with a share that rises from 10 to 90 % over a fifth of their range, 30 flights give
a size that is too large by about 8 % of the range, 60 by 2 %, each with a scatter of 10 %: few flights err to the large side.

References
----------
Ayer, Brunk, Ewing, Reid, Silverman (1955), An empirical distribution function for sampling with incomplete information,
Annals of Mathematical Statistics 26(4), 641-647.
Barlow, Bartholomew, Bremner, Brunk (1972), Statistical inference under order restrictions, Wiley.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.metrics.clustered import PooledShare, korn_graubard

__all__ = ["ABOUT", "ABOVE", "AT_MOST", "LEAST", "Smallest", "smallest_found"]

LEAST = 30
"""Flights below which nothing is said."""
_FIRST_GROUP, _GROUP = 10, 4
_ROUNDING = 1e-12

ABOUT, AT_MOST, ABOVE = "about", "at_most", "above"
"""How the smallest size stands to the number given: near it, below all sizes flown, above all sizes flown."""


@dataclass(frozen=True, kw_only=True)
class Smallest:
    """Smallest size that is found.

    Attributes
    ----------
    flights, found : int
        All flights, and those whose fault was found.
    relation : str or None
        `ABOUT`; `AT_MOST`: even the smallest faults flown are found; `ABOVE`: not even the largest are; None: too few flights.
    size : float or None
        Median size of the group of flights that decides, in the unit of the sizes.
    share : PooledShare or None
        Share found of the flights with faults of at least about this size; with `ABOVE`, of those with the largest.
    """

    flights: int
    found: int
    relation: str | None = None
    size: float | None = None
    share: PooledShare | None = None


def smallest_found(size: Floats, found: npt.NDArray[np.bool_], run: Any, *, share: float = 0.9) -> Smallest:
    """Smallest size found in at least this share of flights.

    Parameters
    ----------
    size : (n,) array
        Size of the fault in each flight, in any unit.
    found : (n,) array of bool
        Whether it was found.
    run : (n,) array
        Run of each flight: flights of one run are no independent witnesses.
    share : float
        Between 0 and 1 [-].

    Examples
    --------
    >>> size = np.linspace(0.0, 10.0, 201)
    >>> answer = smallest_found(size, size > 4.0, np.arange(201))
    >>> answer.relation, abs(answer.size - 4.0) < 0.5, answer.share.share
    ('about', True, 1.0)
    """
    n, hits = len(size), int(np.sum(found))
    if n < LEAST:
        return Smallest(flights=n, found=hits)
    groups = _groups(np.asarray(size, dtype=float))
    shares, counts = [np.mean(found[group]) for group in groups], [len(group) for group in groups]
    from scipy.optimize import isotonic_regression  # takes as long as many a campaign flies, and few ask for maps

    monotone = isotonic_regression(shares, weights=counts, increasing=False).x
    enough = int(np.sum(monotone >= share - _ROUNDING))
    last = max(enough - 1, 0)
    large = np.concatenate(groups[: last + 1])
    return Smallest(
        flights=n,
        found=hits,
        relation=ABOVE if enough == 0 else AT_MOST if enough == len(groups) else ABOUT,
        size=float(np.median(size[groups[last]])),
        share=korn_graubard(found[large], np.asarray(run)[large]),
    )


def _groups(size: Floats) -> list[npt.NDArray[np.int64]]:
    """Places of the flights of each group, the largest sizes first."""
    order = np.argsort(-size, kind="stable")
    ends = np.append(np.flatnonzero(np.diff(size[order])) + 1, len(size))  # a group may end here: the next size differs
    cuts = [0]
    for end in ends.tolist():
        if end - cuts[-1] >= (_GROUP if len(cuts) > 1 else _FIRST_GROUP):
            cuts.append(end)
    if cuts[-1] < len(size):
        cuts.append(len(size))  # the few smallest
    return [order[a:b] for a, b in pairwise(cuts)]
