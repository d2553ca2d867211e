"""Share found against the size of a fault, where a scenario draws or sweeps one."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.interfaces import Floats
from fddbench.metrics.association import parted
from fddbench.metrics.clustered import counts_by_run, pooled_intervals
from fddbench.metrics.smallest import Smallest, smallest_found
from fddbench.reporting.page.columns import Columns

__all__ = ["SizeCurve", "size_curve"]

_RATES = ("deg_s", "percent_s", "rad_s", "m_s", "n_s", "g_s")


@dataclass(frozen=True, kw_only=True, eq=False)
class SizeCurve:
    """Counts over parts of the size, and the smallest that is found.

    Attributes
    ----------
    name : str
        Column of the size.
    low, high : (n_parts,) arrays
        Ends of the parts.
    right, flights : (n_parts,) arrays of int
        Flights found in time, and decided ones.
    share_low, share_high : (n_parts,) arrays
        Ends of the 95 % interval of the share, by run [-].
    smallest : Smallest
        Size found in 90 % of flights, by monotone regression; `fddbench pod` fits a curve and its confidence.
    """

    name: str
    low: Floats
    high: Floats
    right: Floats
    flights: Floats
    share_low: Floats
    share_high: Floats
    smallest: Smallest


def size_curve(columns: Columns, sure: "np.ndarray[Any, Any]") -> SizeCurve | None:
    """Curve of the first size that varies among decided flights; None: none does. Times are no sizes."""
    names = [n for n in columns.varied(sure, ("f",)) if not n.endswith("_s") or n.endswith(_RATES)]
    names = [n for n in names if "frequency" not in n and "phase" not in n]
    if not names:
        return None
    size = np.abs(columns.numbers(names[0])[sure])
    known = ~np.isnan(size)
    size, own = size[known], sure[known]
    parts = parted(size)
    if parts is None:
        return None
    right = columns.texts("outcome")[own] == "right"
    hits, trials = counts_by_run(parts.place, right, columns.whole("run", own), len(parts.low))
    low, high = pooled_intervals(hits, trials)
    return SizeCurve(
        name=names[0], low=parts.low, high=parts.high, right=hits.sum(axis=0), flights=trials.sum(axis=0),
        share_low=low, share_high=high, smallest=smallest_found(size, right, columns.whole("run", own)),
    )  # fmt: skip
