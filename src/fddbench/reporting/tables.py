"""The tables of the page: rows of formatted cells, ready for the template."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.shares import decided, share
from fddbench.reporting.formats import count, interval, present, seconds

__all__ = ["Cell", "event_lines", "reason_lines"]


@dataclass(frozen=True)
class Cell:
    """A table cell: its text, a small line below it, whether it must catch the eye, rows it spans."""

    text: str
    small: str = ""
    alarm: bool = False
    rows: int = 1


def reason_lines(rows: pd.DataFrame) -> list[list[Cell]]:
    """Status, reason, scenarios, flights and rows of everything that has no score; most frequent first."""
    lost = rows[np.asarray(rows["status"] != "ok", dtype=bool)]
    known = lost.assign(reason=lost["reason"].astype(object).where(lost["reason"].notna(), "no reason given"))
    groups = [(key, group) for key, group in known.groupby(["status", "reason"], sort=False)]
    return [
        [
            *(Cell(str(text)) for text in key),
            Cell(_listed(list(group["scenario"].unique()))),
            Cell(count(group["case"].nunique())),
            Cell(count(len(group))),
        ]
        for key, group in sorted(groups, key=lambda pair: -len(pair[1]))
    ]


def _listed(names: list[str], most: int = 4) -> str:
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def event_lines(events: pd.DataFrame) -> list[list[Cell]]:
    """One line per scenario, fault event and detector, of the flown flights."""
    return list(_events(events[np.asarray(events["status"] == "ok", dtype=bool)]))


EVENT_OUTCOMES = ("right", "late", "missed", "undecided", "declared_before")


def _events(flown: pd.DataFrame) -> Iterator[list[Cell]]:
    for (scenario, event, detector), group in flown.groupby(["scenario", "event", "detector"], sort=False):
        first = group.iloc[0]
        outcome = np.asarray(group["outcome"], dtype=object)
        counts = {name: int(np.sum(outcome == name)) for name in EVENT_OUTCOMES}
        time_s = _numbers(group, "detection_time_s")
        time_s = time_s[~np.isnan(time_s)]
        sure = decided(group)
        found = share("right", (outcome == "right")[sure], group["run"][sure])
        ends = interval(found["right_low_percent"], found["right_high_percent"])
        until = f"{first['end_s']:g} s" if present(first["end_s"]) else "end"
        yield [
            Cell(str(scenario)),
            Cell(f"{event}: {first['fault']}", f"{first['sites']}, {first['onset_s']:g} s to {until}"),
            Cell(str(detector)),
            Cell(count(len(group))),
            Cell(count(counts["right"]), f"{ends} %" if ends else ""),
            *(Cell(count(counts[name])) for name in EVENT_OUTCOMES[1:]),
            Cell(seconds(np.quantile(time_s, 0.5, method="inverted_cdf") if len(time_s) else None)),
            Cell(seconds(np.max(time_s) if len(time_s) else None)),
        ]


def _numbers(table: pd.DataFrame, column: str) -> Any:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan)
