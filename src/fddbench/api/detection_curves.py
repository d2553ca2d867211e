"""Probability of detection against the size of a fault, of a folder of results."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from pandas.api.types import is_bool_dtype, is_numeric_dtype

from fddbench.errors import FddbenchError, did_you_mean
from fddbench.metrics.shares import column, decided, flown_of
from fddbench.reporting.found_by_size import curve_of, sizes_among
from fddbench.reporting.labels import of_a_fault
from fddbench.results.table import load

__all__ = ["CURVES", "pod"]

CURVES = pa.schema(
    [
        column("scenario", pa.string(), "name of the scenario"),
        column("detector", pa.string(), "name of the design"),
        column("size", pa.string(), "column of the rows that holds the size of the fault"),
        column("flights", pa.int64(), "decided flights that the curve is fitted to"),
        column("runs", pa.int64(), "independent runs that they come from"),
        column("right", pa.int64(), "those in which the fault was found in time"),
        column("smallest", pa.float64(), "smallest size flown"),
        column("largest", pa.float64(), "largest size flown"),
        column(
            "size_50", pa.float64(), "size found in 50 % of flights; null: the curve never is there, or none is fitted"
        ),
        column("size_90", pa.float64(), "size found in 90 % of flights; null: likewise"),
        column("size_90_95", pa.float64(), "upper end of size_90 at 95 % confidence; null: the flights do not tell"),
        column("floor_percent", pa.float64(), "share of the smallest faults [%]"),
        column("ceiling_percent", pa.float64(), "share of the largest faults [%]"),
        column("spread", pa.float64(), "standard deviation of the logarithm of the size [-]"),
        column("design_effect", pa.float64(), "by how much flights of one run tell less [-]"),
        column("about", pa.string(), "in words: what the curve says, or why there is none"),
    ]
)


def pod(folder: str | Path, size: str = "") -> pd.DataFrame:
    """One line per scenario, detector and size that was drawn or swept: columns of `CURVES`.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    size : str
        Column of the rows, ``"f1_amplitude_percent"``; by default every number of a fault that differs, but for times.

    Raises
    ------
    FddbenchError
        No folder of results, no such column, or no fault with a size that differs.
    """
    rows = load(folder, fair=True)
    sizes = [name for name in rows.columns if of_a_fault(name)]
    if size and size not in rows.columns:
        hint = did_you_mean(size, sizes)
        raise FddbenchError(
            " ".join(filter(None, [f"the rows have no column {size!r}.", hint, f"Sizes: {', '.join(sizes) or 'none'}"]))
        )
    if size and (not is_numeric_dtype(rows[size]) or is_bool_dtype(rows[size])):
        raise FddbenchError(f"the column {size!r} holds no numbers. Sizes: {', '.join(sizes) or 'none'}")
    chosen = [size] if size else sizes_among(sizes)
    flown = flown_of(rows)
    lines = [
        {"scenario": scenario, "detector": detector, "size": name, **line}
        for name in chosen
        for (scenario, detector), group in flown.groupby(["scenario", "detector"], sort=False)
        for line in _line(group, name)
    ]
    if not lines:
        raise FddbenchError(
            f"no fault in {folder} has a size that differs; sweep one, amplitude_percent: {{grid: [0.5, 1, 2, 4]}}, or draw "
            "it, {log_uniform: [0.5, 4]}"
        )
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=CURVES).to_pandas(types_mapper=pd.ArrowDtype)
    return found


def _line(group: pd.DataFrame, name: str) -> Iterator[dict[str, Any]]:
    values = group[name].to_numpy(dtype=float, na_value=np.nan)
    if len(np.unique(values[~np.isnan(values)])) < 2:
        return
    sure = decided(group) & ~np.isnan(values)
    right = np.asarray(group["outcome"] == "right", dtype=bool)[sure]
    a, run = np.abs(values[sure]), group["run"].to_numpy()[sure]
    fit, about = curve_of(a, right, run, name)
    line = {
        "flights": int(sure.sum()), "runs": len(np.unique(run)), "right": int(right.sum()), "about": about,
        "smallest": float(a.min()) if len(a) else None, "largest": float(a.max()) if len(a) else None,
    }  # fmt: skip
    if fit is not None:
        line |= {
            "size_50": fit.size_50, "size_90": fit.size_90, "size_90_95": fit.size_90_95, "spread": fit.spread,
            "floor_percent": 100.0 * fit.floor, "ceiling_percent": 100.0 * fit.ceiling, "design_effect": fit.design_effect,
        }  # fmt: skip
    yield line
