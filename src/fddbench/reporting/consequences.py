"""What the faults did to the aircraft, scenario by scenario, beside the healthy flights."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from fddbench.interfaces import Consequence, Floats
from fddbench.reporting.formats import DASH, count, short
from fddbench.reporting.labels import label
from fddbench.reporting.tables import Cell

__all__ = ["consequence_heads", "consequence_lines"]


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
    flown = rows[np.asarray((rows["status"] == "ok") & (rows["n_faulty"] > 0), dtype=bool)]
    lines = []
    for scenario, group in flown.groupby("scenario", sort=False):
        flights = group.drop_duplicates(["point", "level", "run"])
        cells = [Cell(str(scenario), str(flights["manoeuvre"].iloc[0])), Cell(count(len(flights)))]
        lines.append([*cells, *(_cell(flights, each) for each in announced)])
    return lines


def _cell(flights: pd.DataFrame, each: Consequence) -> Cell:
    sizes = _sizes(flights, each.name)
    if not len(sizes):
        return Cell(DASH)
    below = f"max {short(sizes.max())}"
    twins = _sizes(flights, f"healthy_{each.name}") if each.how == "peak" else sizes[:0]
    below += f", healthy {short(float(np.median(twins)))}" if len(twins) else ""
    return Cell(short(float(np.median(sizes))), below)


def _sizes(flights: pd.DataFrame, column: str) -> Floats:
    values: Floats = np.abs(flights[column].to_numpy(dtype=np.float64, na_value=np.nan))
    return values[~np.isnan(values)]
