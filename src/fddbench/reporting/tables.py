"""The tables of the page: rows of formatted cells, ready for the template."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.bound import MOST_D
from fddbench.metrics.shares import decided, share
from fddbench.reporting.formats import DASH, count, interval, percent, present, rate, seconds

__all__ = [
    "QUALITY",
    "RESULTS",
    "Cell",
    "event_lines",
    "quality_lines",
    "reason_lines",
    "result_lines",
]

Line = dict[Any, Any]


@dataclass(frozen=True)
class Cell:
    """A table cell: its text, a small line below it, whether it must catch the eye, rows it spans."""

    text: str
    small: str = ""
    alarm: bool = False
    rows: int = 1


RESULTS = (
    *("flown", "healthy site<br>declared", "right", "bound", "late", "missed", "unde-<br>cided", "false<br>alarm"),
    *("false alarms of<br>distinct flights", "per hour"),
)
QUALITY = (
    *(
        "isolated",
        "median<br>[s]",
        "95 %<br>[s]",
        "max<br>[s]",
        "max /<br>limit",
        "changes",
        "bias of<br>estimate",
        "rms",
    ),
    "healthy<br>margin",
)
"""Heads of what `result_lines` and `quality_lines` give after scenario and detector."""


def result_lines(summary: pd.DataFrame) -> list[list[Cell]]:
    """Outcomes: one line of cells per scenario and detector; a scenario's cell spans its detectors."""
    return _grouped(summary, _result)


def quality_lines(summary: pd.DataFrame) -> list[list[Cell]]:
    """Times, flicker, estimates and margins, in the same way."""
    return _grouped(summary, _quality)


def _grouped(summary: pd.DataFrame, cells_of: Callable[[Line], list[Cell]]) -> list[list[Cell]]:
    spans = summary.groupby("scenario", sort=False).size().to_dict()
    lines, previous = [], None
    for line in summary.to_dict("records"):
        cells = [Cell(line["detector"], _notes(line)), *cells_of(line)]
        if line["scenario"] != previous:
            note = "healthy" if line["healthy"] else f"limit {_limit(line)}"
            note += f", pools {line['pools']}" if present(line["pools"]) else ""
            cells.insert(0, Cell(line["scenario"], note, rows=int(spans[line["scenario"]])))
        previous = line["scenario"]
        lines.append(cells)
    return lines


def _notes(line: Line) -> str:
    """What a reader must know who compares this detector with others."""
    voted = line.get("sees") == "voted"
    return ", ".join(filter(None, ("in sample" if line["in_sample"] else "", "sees the voted signal" if voted else "")))


def _limit(line: Line) -> str:
    limit_s = line["detection_time_limit_s"]
    return f"{limit_s:g} s" if present(limit_s) else DASH


def _result(line: Line) -> list[Cell]:
    lost = [f"{count(line[name])} {name}" for name in ("infeasible", "failed", "departed") if line[name]]
    hourly = interval(line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"], rate)
    return [
        Cell(f"{count(line['flown'])}\u00a0of\u00a0{count(line['flights'])}", ", ".join(lost)),
        _counted(line, "wrong_site"),
        _right(line),
        _bound(line),
        *(Cell(count(line[name]), alarm=name != "undecided" and _some(line[name])) for name in _REST),
        Cell(f"{count(line['alarms'])}\u00a0of\u00a0{count(line['distinct_flights'])}", _ends(line, "alarms")),
        Cell(rate(line["false_alarm_per_hour"]), hourly),
    ]


def _quality(line: Line) -> list[Cell]:
    return [
        Cell(count(line["isolated"])),
        Cell(seconds(line["detection_time_median_s"]), f"n {line['detections']}" if line["detections"] else ""),
        Cell(seconds(line["detection_time_p95_s"])),
        Cell(seconds(line["detection_time_max_s"])),
        *(Cell(rate(line[name])) for name in _NUMBERS),
    ]


_REST = ("late", "missed", "undecided", "false_alarm")
_NUMBERS = (
    *("normalized_detection_time_max", "changes_max", "estimate_bias_median", "estimate_rms_median"),
    "margin_healthy_max",
)


def _some(value: Any) -> bool:
    return present(value) and bool(value > 0)


def _ends(line: Line, name: str) -> str:
    return interval(line[f"{name}_low_percent"], line[f"{name}_high_percent"])


def _counted(line: Line, name: str) -> Cell:
    ends = _ends(line, name)
    return Cell(count(line[name]), f"{ends} %" if ends else "", alarm=_some(line[name]))


def _right(line: Line) -> Cell:
    """Share of the decided flights with its count; of a healthy scenario how many were quiet."""
    if line["healthy"]:
        return Cell(count(line["quiet"]), "quiet")
    if not present(line["right_percent"]):
        return Cell(DASH, "none decided" if line["flown"] else "")
    ends = _ends(line, "right")
    return Cell(
        f"{percent(line['right_percent'])} %",
        f"{count(line['right'])} of {count(line['decided'])}{f': {ends}' if ends else ''}",
    )


def _bound(line: Line) -> Cell:
    """Largest share of right flights that any detector can have."""
    share = line.get("bound_percent")
    if not present(share):
        return Cell(DASH)
    most = "≥ " if line["bound_d"] >= MOST_D else ""
    return Cell(f"{percent(share)} %", f"d {most}{line['bound_d']:.3g}")


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
