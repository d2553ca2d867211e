"""Share found against the size of a fault, where a scenario draws or sweeps one: counts of parts, and the fitted curve."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.interfaces import Floats
from fddbench.metrics.association import parted
from fddbench.metrics.clustered import counts_by_run, pooled_intervals
from fddbench.metrics.detection_curve import DetectionCurve
from fddbench.reporting.found_by_size import curve_of, no_curve, sizes_among
from fddbench.reporting.page.columns import Columns

__all__ = ["SizeCurve", "size_curve"]

_NOT_HERE = "its curve is that of fddbench pod, not drawn here"


@dataclass(frozen=True, kw_only=True, eq=False)
class SizeCurve:
    """Counts over parts of the size, and what a fitted curve says.

    Attributes
    ----------
    name : str
        Column of the size.
    low, high : (n_parts,) arrays
        Ends of the parts.
    middle : (n_parts,) array
        Geometric mean of the sizes flown in each.
    right, flights : (n_parts,) arrays of int
        Flights found in time, and decided ones.
    share_low, share_high : (n_parts,) arrays
        Ends of the 95 % interval of the share, by run [-].
    curve : DetectionCurve or None
        As `fddbench pod` fits it; None: these flights give none, or it was not asked for.
    could_be_fitted : bool
        Whether these flights give one, asked for or not.
    said : str
        In words, as `fddbench pod` says it.
    """

    name: str
    low: Floats
    high: Floats
    middle: Floats
    right: Floats
    flights: Floats
    share_low: Floats
    share_high: Floats
    curve: DetectionCurve | None
    could_be_fitted: bool
    said: str


def size_curve(columns: Columns, sure: "np.ndarray[Any, Any]", *, fit: bool = False) -> SizeCurve | None:
    """Of the first size that varies among decided flights; None: none does.

    Parameters
    ----------
    columns : Columns
        The rows.
    sure : (n,) array of int
        Places of the decided flights of a cell.
    fit : bool
        Whether a curve is fitted, which takes 0.1 s.
    """
    names = [n for n in sizes_among(columns.varied(sure, ("f",))) if "frequency" not in n and "phase" not in n]
    if not names:
        return None
    size = np.abs(columns.numbers(names[0])[sure])
    known = ~np.isnan(size)
    size, own = size[known], sure[known]
    parts = parted(size)
    if parts is None:
        return None
    right, run = np.asarray(columns.texts("outcome")[own] == "right", dtype=bool), columns.whole("run", own)
    hits, trials = counts_by_run(parts.place, right, run, len(parts.low))
    low, high = pooled_intervals(hits, trials)
    why_not = no_curve(size, right)
    curve, said = curve_of(size, right, run, names[0]) if fit else (None, why_not or _NOT_HERE)
    return SizeCurve(
        name=names[0], low=parts.low, high=parts.high, middle=_middles(size, parts.place, len(parts.low)),
        right=hits.sum(axis=0), flights=trials.sum(axis=0), share_low=low, share_high=high, curve=curve,
        could_be_fitted=not why_not, said=said,
    )  # fmt: skip


def _middles(size: Floats, place: "np.ndarray[Any, Any]", n: int) -> Floats:
    """Geometric mean of the sizes at each place; NaN where there is none above 0."""
    there = size > 0.0
    flown = np.bincount(place[there], minlength=n).astype(np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Floats = np.exp(np.bincount(place[there], weights=np.log(size[there]), minlength=n) / flown)
    return found
