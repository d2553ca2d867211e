"""Flights that went wrong: over which part of the envelope, and the worst of them with the line that flies them again."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.metrics.shares import decided, share
from fddbench.reporting.formats import DASH, count, interval, percent, present, rate, seconds, short
from fddbench.reporting.labels import label
from fddbench.reporting.tables import Cell

__all__ = ["WORST", "failure_tables", "worst_lines"]

WORST = ("flight", "detector", "outcome", "time [s]", "margin", "flown at", "again")
"""Heads of what `worst_lines` gives."""

_BINS, _FEW, _LEAST_PLACES = 4, 8, 8
_WRONG = ("false_alarm", "wrong_site", "late", "missed")
_MOST, _MOST_OF_SCENARIO = 10, 2


def failure_tables(rows: pd.DataFrame, axes: Sequence[tuple[str, str]]) -> list[dict[str, Any]]:
    """Share of decided faulty flights that were not right over parameters of the envelope, and of the grid.

    A line per detector and number of faulty sites; none where nothing went wrong or where hardly any flights differ.
    """
    flown = rows[np.asarray((rows["status"] == "ok") & (rows["n_faulty"] > 0), dtype=bool)]
    sure = flown[decided(flown)]
    names = _parameters(sure, axes)
    outcome = np.asarray(sure["outcome"], dtype=object)
    if len(sure.drop_duplicates(["point", "run"])) < _LEAST_PLACES or not np.any(np.isin(outcome, _WRONG)):
        return []
    return [_binned(sure, name) for name in names]


def _parameters(sure: pd.DataFrame, axes: Sequence[tuple[str, str]]) -> list[str]:
    """Columns of the envelope, then those of few values, of several that vary together the first."""
    asked = [f"p_{name}" for pair in axes for name in pair if f"p_{name}" in sure]
    others = [name for name in sure.columns if name.startswith("p_") and name not in asked]
    few = [name for name in others if 1 < sure[name].nunique() <= _FEW]
    alike: dict[tuple[int, ...], str] = {}
    for name in few:
        alike.setdefault(tuple(np.unique(_numbers(sure, name), return_inverse=True)[1].tolist()), name)
    return [name for name in asked if sure[name].nunique() > 1] + list(alike.values())


def _binned(sure: pd.DataFrame, name: str) -> dict[str, Any]:
    values = _numbers(sure, name)
    places, heads = _places(values)
    lines = []
    numbers = sorted(int(n) for n in sure["n_faulty"].unique())
    for detector, n_faulty in ((name, n) for name in sure["detector"].unique() for n in numbers):
        own = np.asarray((sure["detector"] == detector) & (sure["n_faulty"] == n_faulty), dtype=bool)
        cells = [Cell(str(detector), f"{n_faulty} faulty site{'s' if n_faulty > 1 else ''}")]
        for i in range(len(heads)):
            here = sure[own & (places == i)]
            wrong = np.isin(np.asarray(here["outcome"], dtype=object), _WRONG)
            cells.append(_failed(wrong, here["run"]))
        lines.append(cells)
    return {"heads": (label(name), *heads), "lines": lines}


def _places(values: Floats) -> tuple[npt.NDArray[np.int64], list[str]]:
    """Bin of each flight, and what the bins are called: the values themselves where there are few, else of equal widths."""
    few = np.unique(values)
    if len(few) <= _FEW:
        return np.searchsorted(few, values), [f"{value:.6g}" for value in few]
    edges = np.linspace(few[0], few[-1], _BINS + 1)
    names = [f"{short(edges[i])} … {short(edges[i + 1])}" for i in range(_BINS)]
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, _BINS - 1), names


def _failed(wrong: npt.NDArray[np.bool_], runs: Any) -> Cell:
    if not len(wrong):
        return Cell(DASH)
    of = share("x", wrong, runs)
    ends = interval(of["x_low_percent"], of["x_high_percent"])
    counts = f"{count(wrong.sum())} of {count(len(wrong))}{f': {ends}' if ends else ''}"
    return Cell(f"{percent(of['x_percent'])} %", counts, alarm=bool(wrong.any()))


def worst_lines(rows: pd.DataFrame, axes: Sequence[tuple[str, str]], folder: str) -> list[list[Cell]]:
    """Ten worst flights of the first detector, two of a scenario at most, each with the line of Python that flies it again.

    Worst is first a false alarm or a healthy site declared, then a fault not found, then the slowest against its limit; of
    equals the one whose residual was largest.
    """
    if rows.empty:
        return []
    first = rows["detector"].iloc[0]
    flown = rows[np.asarray((rows["status"] == "ok") & (rows["detector"] == first), dtype=bool)]
    outcome = np.asarray(flown["outcome"], dtype=object)
    rank = np.select(
        [np.isin(outcome, ("false_alarm", "wrong_site")), outcome == "missed", outcome == "late"], [3, 2, 1], 0
    )
    slow = np.nan_to_num(_numbers(flown, "normalized_detection_time"), nan=0.0)
    margin = np.fmax(
        np.nan_to_num(_numbers(flown, "margin_healthy"), nan=0.0), np.where(rank == 0, 0.0, _margin(flown))
    )
    order = np.lexsort((-margin, -slow, -rank))
    names = [f"p_{name}" for pair in axes for name in pair if f"p_{name}" in rows and rows[f"p_{name}"].nunique() > 1]
    lines: list[list[Cell]] = []
    taken: dict[str, int] = {}
    for i in order.tolist():
        line = flown.iloc[i]
        scenario = str(line["scenario"])
        if taken.get(scenario, 0) >= _MOST_OF_SCENARIO:
            continue
        taken[scenario] = taken.get(scenario, 0) + 1
        lines.append(_worst(line, names, folder))
        if len(lines) == _MOST:
            break
    return lines


def _worst(line: "pd.Series[Any]", names: Sequence[str], folder: str) -> list[Cell]:
    times = {"false_alarm": "false_alarm_time_s", "wrong_site": "wrong_site_time_s"}
    time_s = line[times.get(str(line["outcome"]), "detection_time_s")]
    margin = line["margin_faulty"] if present(line["margin_faulty"]) else line["margin_healthy"]
    outcome = str(line["outcome"]) if present(line["outcome"]) else DASH
    return [
        Cell(str(line["case"])),
        Cell(str(line["detector"])),
        Cell(outcome.replace("_", " "), alarm=outcome in _WRONG),
        Cell(seconds(time_s)),
        Cell(rate(margin)),
        Cell(", ".join(f"{label(name)} {short(float(line[name]))}" for name in names)),
        Cell(f'fddbench.signals("{folder}", "{line["scenario"]}", ["{line["case"]}"])'),
    ]


def _margin(flown: pd.DataFrame) -> Floats:
    return np.nan_to_num(_numbers(flown, "margin_faulty"), nan=0.0)


def _numbers(table: pd.DataFrame, column: str) -> Floats:
    found: Floats = table[column].to_numpy(dtype=np.float64, na_value=np.nan)
    return found
