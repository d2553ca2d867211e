"""Which parameters go with failure: shares of failed flights over parts of each, ranked by an association free of chance.

Cramér's V of the table failed or not × part of the parameter, less what chance alone gives (Bergsma)::

    phi2 = chi2 / n,   phi2' = max(0, phi2 - (m-1) / (n-1)),   m' = m - (m-1)^2 / (n-1),   r' = 2 - 1 / (n-1)
    V    = sqrt(phi2' / (min(m', r') - 1))                      m parts

0: no more than chance, 1: the parameter decides. It ranks; it is no cause.

References
----------
Bergsma (2013), A bias-correction for Cramér's V and Tschuprow's T, Journal of the Korean Statistical Society 42(3), 323-328.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.metrics.clustered import counts_by_run, pooled_intervals

__all__ = ["Association", "Parts", "associations", "cramers_v", "parted"]

_FEW, _PARTS = 6, 6

Places = npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Parts:
    """A parameter cut into parts.

    Attributes
    ----------
    place : (n,) array of int
        Part of each flight; -1: it has no value.
    low, high : (n_parts,) arrays
        Smallest and largest value in each, equal where a part is one value.
    """

    place: Places
    low: Floats
    high: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Association:
    """A parameter and how strongly it goes with failure.

    Attributes
    ----------
    name : str
    v : float
        Association [-].
    lower, upper : (n_parts,) arrays
        Smallest and largest value of each part.
    failed, flights : (n_parts,) arrays of int
        Flights of each part that failed, and all.
    low, high : (n_parts,) arrays
        Ends of the 95 % interval of the failed share [-], by run.
    """

    name: str
    v: float
    lower: Floats
    upper: Floats
    failed: Places
    flights: Places
    low: Floats
    high: Floats


def parted(values: Floats) -> Parts | None:
    """Each value a part where there are at most six, else six parts of about equally many flights; None: nothing varies.

    >>> parted(np.array([1.0, 2.0, 2.0])).place.tolist()
    [0, 1, 1]
    """
    known = ~np.isnan(values)
    few = np.unique(values[known])
    if len(few) < 2:
        return None
    if len(few) <= _FEW:
        place = np.searchsorted(few, values)
        return Parts(place=np.where(known, place, -1).astype(np.int64), low=few, high=few)
    edges = np.unique(np.quantile(values[known], np.linspace(0.0, 1.0, _PARTS + 1)))
    place = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
    ends = np.array(list(pairwise(edges)))
    return Parts(place=np.where(known, place, -1).astype(np.int64), low=ends[:, 0], high=ends[:, 1])


def cramers_v(failed: Places | Floats, flights: Places | Floats) -> float:
    """Association of failures with parts, without what chance gives; 0 where all or none failed.

    >>> round(cramers_v(np.array([0, 25]), np.array([25, 25])), 2), cramers_v(np.array([5, 5]), np.array([25, 25]))
    (1.0, 0.0)
    """
    k, n = np.asarray(failed, float), np.asarray(flights, float)
    k, n = k[n > 0], n[n > 0]
    total, parts = float(n.sum()), len(n)
    share = float(k.sum()) / total if total else 0.0
    if parts < 2 or not 0.0 < share < 1.0 or total < 3:
        return 0.0
    phi2 = float(((k - share * n) ** 2 / (share * (1.0 - share) * n)).sum()) / total
    corrected = max(0.0, phi2 - (parts - 1) / (total - 1))
    least = min(parts - (parts - 1) ** 2 / (total - 1), 2.0 - 1.0 / (total - 1)) - 1.0
    return float(min(np.sqrt(corrected / least), 1.0)) if least > 0.0 else 0.0


def associations(
    parts: Mapping[str, Parts], failed: npt.NDArray[np.bool_], run: npt.ArrayLike, *, most: int = 4
) -> list[Association]:
    """Parameters that go with failure, strongest first; none where all or none failed, or where chance gives as much.

    Parameters
    ----------
    parts : mapping of str to Parts
        Of the same flights.
    failed : (n,) array of bool
    run : (n,) array
        Run of each flight: intervals are by run.
    most : int
        At most so many.
    """
    if not len(failed) or failed.all() or not failed.any():
        return []
    ranked = []
    for name, own in parts.items():
        n = np.bincount(own.place[own.place >= 0], minlength=len(own.low))
        k = np.bincount(own.place[(own.place >= 0) & failed], minlength=len(own.low))
        ranked.append((cramers_v(k, n), name, k, n))
    strongest = sorted((each for each in ranked if each[0] > 0.0), key=lambda each: -each[0])[:most]
    found = []
    for v, name, k, n in strongest:
        own = parts[name]
        low, high = pooled_intervals(*counts_by_run(own.place, failed, run, len(k)))
        found.append(
            Association(name=name, v=v, lower=own.low, upper=own.high, failed=k, flights=n, low=low, high=high)
        )
    return found
