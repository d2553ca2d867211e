"""The guaranteed gamma of each design beside what it detects, because the one does not follow from the other."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.shares import decided, share
from fddbench.reporting.formats import DASH, count, interval, percent, seconds
from fddbench.reporting.tables import Cell

__all__ = ["guarantee_lines"]


def guarantee_lines(rows: pd.DataFrame, events: pd.DataFrame, designs: Sequence[Mapping[str, Any]]) -> list[list[Cell]]:
    """One line per detector, the largest share of right flights first; empty unless some design has a gamma.

    Columns: detector, gamma, right and wrong-site flights of the decided faulty ones, faults of overlapping scenarios found
    in time, and the median of their detection times.
    """
    gammas = {design["name"]: design.get("gamma") for design in designs}
    if len(gammas) < 2 or all(gamma is None for gamma in gammas.values()):
        return []
    ok = rows[["detector", "outcome", "n_faulty", "run", "status"]]
    ok = ok[_is(ok, "status", "ok")]
    lines = []
    for name, gamma in gammas.items():
        flown, own = ok[_is(ok, "detector", name)], events[_is(events, "detector", name) & _is(events, "status", "ok")]
        faulty = flown[np.asarray(flown["n_faulty"] > 0, dtype=bool)]
        sure = faulty[decided(faulty)]
        cells = [
            Cell(str(name)),
            Cell(DASH if gamma is None else f"{gamma:.4f}"),
            _share(sure, "right"),
            _share(sure, "wrong_site"),
            *_of_events(own[decided(own)]),
        ]
        voted = any(design["name"] == name and design.get("sees") == "voted" for design in designs)
        lines.append((voted, -float(_is(sure, "outcome", "right").sum()) / max(len(sure), 1), cells))
    # those that see the voted signal alone come by themselves
    return [cells for _, _, cells in sorted(lines, key=lambda line: line[:2])]


def _of_events(own: pd.DataFrame) -> list[Cell]:
    """Faults found in time by their own limits, and the median of all detection times."""
    if own.empty:
        return [Cell(DASH), Cell(DASH)]
    time_s = own["detection_time_s"].to_numpy(dtype=np.float64, na_value=np.nan)
    found = time_s[~np.isnan(time_s)]
    median = np.quantile(found, 0.5, method="inverted_cdf") if len(found) else None
    return [_share(own, "right"), Cell(seconds(median))]


def _share(sure: pd.DataFrame, outcome: str) -> Cell:
    if sure.empty:
        return Cell(DASH)
    hits = _is(sure, "outcome", outcome)
    found = share("x", hits, sure["run"])
    ends = interval(found["x_low_percent"], found["x_high_percent"])
    return Cell(
        f"{percent(found['x_percent'])} %", f"{count(hits.sum())} of {count(len(sure))}{f': {ends}' if ends else ''}"
    )


def _is(table: pd.DataFrame, column: str, value: Any) -> Any:
    return np.asarray(table[column] == value, dtype=bool)
