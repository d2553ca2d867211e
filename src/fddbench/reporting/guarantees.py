"""The guaranteed gamma of each design beside what it detects, because the one does not follow from the other."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.summary import rate_with_interval, true_detection
from fddbench.reporting.formats import DASH, count, interval, percent, seconds
from fddbench.reporting.tables import Cell

__all__ = ["guarantee_lines"]


def guarantee_lines(rows: pd.DataFrame, events: pd.DataFrame, designs: Sequence[Mapping[str, Any]]) -> list[list[Cell]]:
    """One line per detector, the best true detection first; empty unless some design has a gamma.

    Columns: detector, gamma, true detections of all flown flights with faults, false alarms of all flown flights, faults
    of overlapping scenarios found in time, and the median of their detection times.
    """
    gammas = {design["name"]: design.get("gamma") for design in designs}
    if len(gammas) < 2 or all(gamma is None for gamma in gammas.values()):
        return []
    ok = rows[_is(rows, "status", "ok")]
    lines = []
    for name, gamma in gammas.items():
        flown, own = ok[_is(ok, "detector", name)], events[_is(events, "detector", name) & _is(events, "status", "ok")]
        faulty = flown[np.asarray(flown["n_faulty"] > 0, dtype=bool)]
        hits = int(true_detection(faulty).sum())
        cells = [
            Cell(str(name)),
            Cell(DASH if gamma is None else f"{gamma:.4f}"),
            _share(hits, len(faulty)),
            _share(int(_true(flown, "false_alarm").sum()), len(flown)),
            *_of_events(own),
        ]
        lines.append((hits / max(len(faulty), 1), cells))
    return [cells for _, cells in sorted(lines, key=lambda line: -line[0])]


def _of_events(own: pd.DataFrame) -> list[Cell]:
    """Faults found in time with nothing declared on them before, and the median of all detection times."""
    if own.empty:
        return [Cell(DASH), Cell(DASH)]
    good = ~_true(own, "missed") & ~_true(own, "censored") & ~_true(own, "false_alarm")
    time_s = own["detection_time_s"].to_numpy(dtype=np.float64, na_value=np.nan)
    found = time_s[~np.isnan(time_s)]
    return [
        _share(int(good.sum()), len(own)),
        Cell(seconds(np.quantile(found, 0.5, method="inverted_cdf") if len(found) else None)),
    ]


def _share(hits: int, trials: int) -> Cell:
    if not trials:
        return Cell(DASH)
    found = rate_with_interval("x", hits, trials)
    ends = interval(found["x_low_percent"], found["x_high_percent"])
    return Cell(f"{percent(found['x_percent'])} %", f"{count(hits)} of {count(trials)}: {ends}")


def _is(table: pd.DataFrame, column: str, value: Any) -> Any:
    return np.asarray(table[column] == value, dtype=bool)


def _true(table: pd.DataFrame, column: str) -> Any:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan) == 1.0
