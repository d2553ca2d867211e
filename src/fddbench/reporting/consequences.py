"""What the faults did to the aircraft, scenario by scenario, beside the healthy flights."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from fddbench.interfaces import Consequence, Floats
from fddbench.reporting.formats import DASH, count, short
from fddbench.reporting.labels import label
from fddbench.reporting.tables import Cell

__all__ = ["Worst", "consequence_heads", "consequence_lines", "worst_scenarios"]


def consequence_heads(announced: Sequence[Consequence]) -> tuple[str, ...]:
    """Heads of `consequence_lines`: scenario, flights, and the columns in words, ``peak bank [deg]``."""
    return ("scenario", "flights", *(label(each.name) for each in announced))


def consequence_lines(rows: pd.DataFrame, announced: Sequence[Consequence]) -> list[list[Cell]]:
    """One line of cells a faulty scenario; empty where the rows say nothing of it.

    A flight is the same for all detectors, so each counts once. Median of the absolute values, below it the largest, and of
    peaks the median of the healthy twins.
    """
    if not announced or any(each.name not in rows for each in announced):
        return []
    lines = []
    for scenario, flights in _flights(rows):
        cells = [Cell(scenario, str(flights["manoeuvre"].iloc[0])), Cell(count(len(flights)))]
        lines.append([*cells, *(_cell(flights, each) for each in announced)])
    return lines


@dataclass(frozen=True, kw_only=True)
class Worst:
    """Column, faulty scenario where it is worst, its median of absolute values there, and that of the healthy twins.

    In the unit at the end of the name of the column; `healthy` is of peaks alone, else None.
    """

    name: str
    scenario: str
    median: float
    healthy: float | None = None


def worst_scenarios(rows: pd.DataFrame, announced: Sequence[Consequence]) -> list[Worst]:
    """The scenario with the largest median of each, of peaks the largest above that of the healthy twins.

    Of equal ones the first; none of what no flight tells, and none where the numbers are printed like those of healthy flights.
    """
    own = [each for each in announced if each.name in rows]
    found: dict[str, tuple[float, Worst]] = {}
    for scenario, flights in _flights(rows) if own else ():
        for each in own:
            median, healthy = _median(flights, each.name), _healthy(flights, each)
            if median is None or short(median) == short(healthy or 0.0):
                continue
            above = median - (healthy or 0.0)
            if above > found.get(each.name, (0.0,))[0]:
                found[each.name] = (above, Worst(name=each.name, scenario=scenario, median=median, healthy=healthy))
    return [found[each.name][1] for each in own if each.name in found]


def _flights(rows: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Flown flights of each faulty scenario, each once whatever the number of detectors."""
    flown = rows[np.asarray((rows["status"] == "ok") & (rows["n_faulty"] > 0), dtype=bool)]
    for scenario, group in flown.groupby("scenario", sort=False):
        yield str(scenario), group.drop_duplicates(["point", "level", "run"])


def _cell(flights: pd.DataFrame, each: Consequence) -> Cell:
    sizes = _sizes(flights, each.name)
    if not len(sizes):
        return Cell(DASH)
    below = f"max {short(sizes.max())}"
    healthy = _healthy(flights, each)
    below += f", healthy {short(healthy)}" if healthy is not None else ""
    return Cell(short(float(np.median(sizes))), below)


def _healthy(flights: pd.DataFrame, each: Consequence) -> float | None:
    """Median of the healthy twins, of peaks."""
    return _median(flights, f"healthy_{each.name}") if each.how == "peak" else None


def _median(flights: pd.DataFrame, column: str) -> float | None:
    sizes = _sizes(flights, column)
    return float(np.median(sizes)) if len(sizes) else None


def _sizes(flights: pd.DataFrame, column: str) -> Floats:
    values: Floats = np.abs(flights[column].to_numpy(dtype=np.float64, na_value=np.nan))
    return values[~np.isnan(values)]
