"""The summary as plain text, for the end of a run in a terminal."""

from typing import Any

import pandas as pd

from fddbench.reporting.formats import count, interval, percent, rate, seconds

__all__ = ["to_text"]

_WIDTH = 120
_HEAD = (
    *("scenario", "detector", "flown", "over", "true % [95 %]", "false", "per hour [95 %]"),
    *("missed", "isol.", "median s", "max s", "max/limit"),
)
_NOTE = (
    "flown of all; over: flights with more sites declared than faulty; true: classified in time and no false alarm;\n"
    "false: flights with a false alarm, then their rate per fault-free hour; intervals are exact; counts unless marked"
)


def to_text(summary: pd.DataFrame) -> str:
    """Aligned table of a summary, at most 120 columns wide; names are cut before numbers are.

    Parameters
    ----------
    summary : DataFrame
        As `fddbench.metrics.summary.summarize` gives it.

    Returns
    -------
    str
        Lines joined by newlines, with a note on the columns.
    """
    if summary.empty:
        return "no rows: nothing was flown"
    table = [_HEAD, *(_cells(line) for line in summary.to_dict("records"))]
    widths = [max(len(row[i]) for row in table) for i in range(len(_HEAD))]
    spare = _WIDTH - sum(widths[2:]) - len(_HEAD) + 1
    widths[0] = min(widths[0], max(spare - widths[1], spare // 2))
    widths[1] = min(widths[1], spare - widths[0])
    lines = [_aligned(row, widths) for row in table]
    previous = ""
    for i, row in enumerate(table[1:], start=1):
        if row[0] == previous:
            lines[i] = " " * widths[0] + lines[i][widths[0] :]
        previous = row[0]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:], "", _NOTE])


def _aligned(row: tuple[str, ...], widths: list[int]) -> str:
    names = [_cut(cell, width).ljust(width) for cell, width in zip(row[:2], widths, strict=False)]
    numbers = [cell.rjust(width) for cell, width in zip(row[2:], widths[2:], strict=True)]
    return " ".join([*names, *numbers]).rstrip()


def _cut(text: str, width: int) -> str:
    return text if len(text) <= width else text[: width - 1] + "…"


def _bracket(low: Any, high: Any, form: Any) -> str:
    text = interval(low, high, form).replace(" … ", ", ")
    return f" [{text}]" if text else ""


def _cells(line: dict[Any, Any]) -> tuple[str, ...]:
    true = percent(line["true_detection_percent"])
    hourly = rate(line["false_alarm_per_hour"])
    ends = (line["true_detection_low_percent"], line["true_detection_high_percent"])
    hourly_ends = (line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"])
    cells = (
        line["scenario"],
        line["detector"],
        f"{line['flown']}/{line['flights']}",
        count(line["over_declared"]),
        true + _bracket(*ends, percent),
        count(line["false_alarm"]),
        hourly + _bracket(*hourly_ends, rate),
        count(line["missed"]),
        count(line["isolated"]),
        seconds(line["detection_time_median_s"]),
        seconds(line["detection_time_max_s"]),
        rate(line["normalized_detection_time_max"]),
    )
    return tuple(cell.replace("\u202f", "") for cell in cells)
