"""What is counted of all rows, on the page of a campaign that does not keep them all."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from fddbench.reporting.formats import count, interval, percent, rate, seconds
from fddbench.reporting.tables import Cell

__all__ = ["COUNTED_HEADS", "counted_lines"]

COUNTED_HEADS = (
    *("scenario", "detector", "flights", "right", "wrong site", "late", "missed", "undecided", "false alarms [1/h]"),
    *("median [s]", "95 % [s]", "max [s]"),
)


def counted_lines(counted: pd.DataFrame | None) -> list[list[Cell]]:
    """One line of cells per scenario and detector; nothing where all rows are on the page."""
    return [] if counted is None else [_line(line) for line in counted.to_dict("records")]


def _line(line: Mapping[Any, Any]) -> list[Cell]:
    return [
        Cell(str(line["scenario"])),
        Cell(str(line["detector"])),
        Cell(count(line["flown"])),
        Cell(
            percent(line["right_percent"]),
            interval(line["right_low_percent"], line["right_high_percent"]),
        ),
        *[Cell(count(line[name])) for name in ("wrong_site", "late", "missed", "undecided")],
        Cell(
            rate(line["false_alarm_per_hour"]),
            interval(line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"], rate),
        ),
        *[Cell(seconds(line[f"detection_time_{name}_s"])) for name in ("median", "p95", "max")],
    ]
