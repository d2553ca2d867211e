"""Maps of detectability: the smallest fault that is found in 90 % of flights, cell by cell of an envelope."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from fddbench.errors import FddbenchError
from fddbench.interfaces import Detectability, Floats
from fddbench.metrics.shares import column, decided, percents, share_columns
from fddbench.metrics.smallest import smallest_found

__all__ = ["DETECTABLE", "SHARE", "summarize_detectable"]

Mask = npt.NDArray[np.bool_]

SHARE = 0.9
"""Share of flights in which a fault of the smallest size is found [-]."""

_PER_CELL, _MOST_CELLS, _FEW_VALUES = 50, 8, 12
"""Flights of a cell that its width aims at, cells along an axis at most, and values that have a cell each."""
_TOLERANCE_S = 1e-9

DETECTABLE = pa.schema(
    [
        column("scenario", pa.string(), "name of the scenario"),
        column("detector", pa.string(), "name of the design"),
        column("site", pa.string(), "site whose faults these are"),
        column("x", pa.string(), "what varies along the horizontal axis"),
        column("y", pa.string(), "what varies along the vertical axis"),
        column("x_low", pa.float64(), "lower edge of the cell; null: the whole envelope"),
        column("x_high", pa.float64(), "its upper edge"),
        column("y_low", pa.float64(), "lower edge on the other axis"),
        column("y_high", pa.float64(), "its upper edge"),
        column("size", pa.string(), "size of the fault as its kind writes it; a share where it is multiplied"),
        column("times", pa.string(), "by whose magnitude the size is multiplied; null: by nothing"),
        column("times_median", pa.float64(), "median of that magnitude in the cell"),
        column("small", pa.bool_(), "that median is small: all of it would be a small fault"),
        column("flights", pa.int64(), "decided flights"),
        column("found", pa.int64(), "those whose fault was found in time, whatever was declared before its onset"),
        column("smallest", pa.float64(), f"smallest size found in {100 * SHARE:g} % of flights; null: too few flights"),
        column("relation", pa.string(), "about; at_most: even the smallest flown; above: not even the largest flown"),
        column("large", pa.int64(), "flights with faults of at least about this size; above: those with the largest"),
        *share_columns("large_found", "those of them whose fault was found in time"),
    ]
)


def summarize_detectable(rows: pd.DataFrame, maps: Sequence[Detectability]) -> pd.DataFrame:
    """Lines of `DETECTABLE`: by map, scenario and detector the whole envelope, then its cells.

    A scenario is on a map if its faults sit on the site of the map alone and their size was drawn or swept; a detector if it
    watches that site. Cells aim at 50 flights each. Where an axis has few values, as on a grid, each has a cell of its own.

    Parameters
    ----------
    rows : DataFrame
        As ``fddbench.load`` gives them, with what the maps need of a flight as columns ``p_<name>``.
    maps : sequence of Detectability
        What the benchmark asks for.

    Raises
    ------
    FddbenchError
        A map needs what the rows do not have.
    """
    lines = [line for each in maps for line in _lines(rows, each)]
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=DETECTABLE).to_pandas(types_mapper=pd.ArrowDtype)
    return found


def _lines(rows: pd.DataFrame, wanted: Detectability) -> Iterator[dict[str, Any]]:
    """Lines of one map."""
    names = {name: f"p_{name}" for name in (*wanted.axes, *filter(None, [wanted.times]))}
    missing = [name for name, full in names.items() if full not in rows.columns]
    if missing:
        raise FddbenchError(
            f"the map of detectability of {wanted.site} needs {missing}, neither a parameter of the plant nor a number that "
            "`derived` of the benchmark gives"
        )
    size = f"f1_{wanted.size}"
    if size not in rows.columns:
        return
    shown = _on_map(rows, wanted.site, (size, *names.values()))
    for scenario in shown["scenario"].unique():
        flown = _where(shown, shown["scenario"] == scenario)
        flights = flown.drop_duplicates("case")
        points = int(flights["point"].nunique())
        edges = [_edges(_numbers(flights, names[axis]), len(flights), points) for axis in wanted.axes]
        for detector in flown["detector"].unique():
            own = _where(flown, flown["detector"] == detector)
            if not own["watched"].to_numpy(dtype=bool, na_value=False).any():
                continue
            who = {"scenario": scenario, "detector": detector, "site": wanted.site, "size": wanted.size}
            who |= {"x": wanted.axes[0], "y": wanted.axes[1], "times": wanted.times or None}
            for cell in _cells(own[decided(own)], wanted, edges):
                yield who | cell


def _on_map(rows: pd.DataFrame, site: str, needed: Sequence[str]) -> pd.DataFrame:
    """Flown rows with faults of one site alone that have all that the map needs."""
    flown = _where(rows, (rows["status"] == "ok") & (rows["faulty_sites"] == site))
    numbers = np.stack([_numbers(flown, name) for name in needed])
    return _where(flown, np.isfinite(numbers).all(axis=0))


def _cells(own: pd.DataFrame, wanted: Detectability, edges: Sequence[Floats]) -> Iterator[dict[str, Any]]:
    """Of the decided flights of a detector the whole envelope, then its cells."""
    magnitude = np.abs(_numbers(own, f"p_{wanted.times}")) if wanted.times else np.ones(len(own))
    share_of_it = wanted.times and wanted.size.endswith("_percent")
    sizes = _numbers(own, f"f1_{wanted.size}") * magnitude / (100.0 if share_of_it else 1.0)
    in_time = _numbers(own, "detection_time_s") <= _numbers(own, "detection_time_limit_s") + _TOLERANCE_S
    runs = own["run"].to_numpy(dtype=np.int64)
    for cell, mine in _inside(own, wanted, edges):
        median = float(np.median(magnitude[mine])) if wanted.times and mine.any() else None
        small = median is not None and median < wanted.hatch_below
        yield cell | {"times_median": median, "small": small} | _answer(sizes[mine], in_time[mine], runs[mine])


def _inside(own: pd.DataFrame, wanted: Detectability, edges: Sequence[Floats]) -> Iterator[tuple[dict[str, Any], Mask]]:
    """Cells, and which flights are in them: first the whole envelope, then row by row."""
    yield dict.fromkeys(("x_low", "x_high", "y_low", "y_high")), np.ones(len(own), dtype=bool)
    x, y = (_place(_numbers(own, f"p_{axis}"), ends) for axis, ends in zip(wanted.axes, edges, strict=True))
    for j, (y_low, y_high) in enumerate(pairwise(edges[1].tolist())):
        for i, (x_low, x_high) in enumerate(pairwise(edges[0].tolist())):
            yield {"x_low": x_low, "x_high": x_high, "y_low": y_low, "y_high": y_high}, (x == i) & (y == j)


def _answer(sizes: Floats, in_time: Mask, runs: npt.NDArray[np.int64]) -> dict[str, Any]:
    """Columns of the smallest fault found in some flights."""
    answer = smallest_found(sizes, in_time, runs, share=SHARE)
    line: dict[str, Any] = {"flights": answer.flights, "found": answer.found}
    if answer.share is not None:
        large = answer.share
        line |= {"smallest": answer.size, "relation": answer.relation, "large": large.trials}
        line |= percents("large_found", large.share, large.low, large.high)
    return line


def _edges(values: Floats, n_flights: int, n_points: int) -> Floats:
    """Edges of the cells along an axis; of more values than points they are drawn, however few flights there are."""
    own = np.unique(values)
    if len(own) == 1:
        half = max(0.05 * abs(float(own[0])), 0.5)
        return np.array([own[0] - half, own[0] + half])
    if len(own) <= min(_FEW_VALUES, n_points):
        middle = 0.5 * (own[1:] + own[:-1])
        return np.array([2.0 * own[0] - middle[0], *middle, 2.0 * own[-1] - middle[-1]])
    count = min(max(round(np.sqrt(n_flights / _PER_CELL)), 1), _MOST_CELLS)
    return np.linspace(own[0], own[-1], count + 1)


def _place(values: Floats, edges: Floats) -> npt.NDArray[np.int64]:
    """Cell of each value along an axis; the last edge belongs to the last cell."""
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)


def _where(table: pd.DataFrame, condition: Any) -> pd.DataFrame:
    """Rows where a condition holds; null does not."""
    return table[np.asarray(pd.Series(condition).astype("boolean").fillna(value=False), dtype=bool)]


def _numbers(table: pd.DataFrame, name: str) -> Floats:
    values: Floats = table[name].to_numpy(dtype=np.float64, na_value=np.nan)
    return values
