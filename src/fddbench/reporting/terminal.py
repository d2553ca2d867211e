"""The summary as plain text, for the end of a run in a terminal."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from fddbench.reporting.formats import count, interval, percent, present, rate, seconds
from fddbench.reporting.names import shortened

__all__ = ["to_text"]

_WIDTH = 80
_LEAST_NAME = 16
_ALL_PERCENT = 99.95  # a bound that says nothing is left to the wide table
Line = dict[Any, Any]


@dataclass(frozen=True)
class _Column:
    """A column: its head, the text of a line, and how soon it is left to --wide (0: never)."""

    head: str
    text: Callable[[Line], str]
    leaves: int = 0


def _ends(line: Line, name: str, form: Any, unit: str = "percent") -> str:
    text = interval(line[f"{name}_low_{unit}"], line[f"{name}_high_{unit}"], form).replace(" … ", ", ")
    return f" [{text}]" if text else ""


def _share(name: str) -> Callable[[Line], str]:
    return lambda line: percent(line[f"{name}_percent"]) + _ends(line, name, percent)


def _number(name: str, form: Callable[[Any], str] = count) -> Callable[[Line], str]:
    return lambda line: form(line[name])


_BOUND_LEAVES = 9
_OUTCOMES = (
    _Column("flown", lambda line: f"{line['flown']}/{line['flights']}", 3),
    _Column("wrong", _number("wrong_site")),
    _Column("right", lambda line: count(line["quiet"] if line["healthy"] else line["right"])),
    _Column("right % [95 %]", _share("right"), 2),
    _Column("bound", lambda line: percent(line.get("bound_percent")), _BOUND_LEAVES),
    _Column("late", _number("late")),
    _Column("miss", _number("missed")),
    _Column("und.", _number("undecided")),
    _Column("false", _number("false_alarm")),
    _Column("med. s", _number("detection_time_median_s", seconds), 4),
    _Column("max s", _number("detection_time_max_s", seconds), 9),
    _Column("max/limit", _number("normalized_detection_time_max", rate), 9),
    _Column("wrong % [95 %]", _share("wrong_site"), 9),
    _Column("isolated", _number("isolated"), 9),
    _Column("changes", _number("changes_max"), 9),
    _Column("bias", _number("estimate_bias_median", rate), 9),
    _Column("rms", _number("estimate_rms_median", rate), 9),
    _Column("margin", _number("margin_healthy_max", rate), 9),
)
_ALARMS = (
    _Column("flights", _number("distinct_flights")),
    _Column("alarms", _number("alarms")),
    _Column("share % [95 %]", _share("alarms"), 2),
    _Column(
        "per hour [95 %]",
        lambda line: rate(line["false_alarm_per_hour"]) + _ends(line, "false_alarm", rate, "per_hour"),
        3,
    ),
    _Column("hours", _number("exposure_h", rate), 4),
)
_NOTE = (
    "wrong: a healthy site declared; right: all faults found in time, or healthy and",
    "quiet; und.: ended before the limit, in no rate; false: alarm before the onset.",
    "Counts of flown flights, right % of the decided ones. A dash: not defined here.",
)
_BOUND_NOTE = ("bound: largest right % that any detector can have; fddbench bound says more.",)
_ALARM_NOTE = ("Each flight once, however many scenarios share it, up to its first alarm.",)


def to_text(summary: pd.DataFrame, alarms: pd.DataFrame, *, wide: bool = False) -> str:
    """Outcomes by scenario and detector, and the false alarms of distinct flights; 80 columns unless wide.

    Columns that do not fit are left to the wide table, which has all of them; names are cut before numbers are.

    Parameters
    ----------
    summary, alarms : DataFrame
        As `fddbench.metrics.summary.summarize` and `fddbench.metrics.alarms.summarize_alarms` give them.
    wide : bool
        All columns, as wide as they are.

    Returns
    -------
    str
        Lines joined by newlines, with notes on the columns.
    """
    if summary.empty:
        return "no rows: nothing was flown"
    lines, of_alarms = summary.to_dict("records"), alarms.to_dict("records")
    # flights that were not flown are seen in every table
    lost = any(line["flown"] < line["flights"] for line in lines)
    sooner = {"flown": 1} if lost else {}
    limited = any(present(line.get("bound_percent")) and line["bound_percent"] < _ALL_PERCENT for line in lines)
    sooner |= {"bound": 1} if limited else {}
    outcomes = [replace(column, leaves=sooner.get(column.head, column.leaves)) for column in _OUTCOMES]
    columns, width = _fitting(outcomes, lines, wide=wide)
    alarm_columns, alarm_width = _fitting(_ALARMS, of_alarms, wide=wide)
    # the same short name in both tables
    names = shortened((str(line["detector"]) for line in lines), min(width, alarm_width))
    shown = any(column.head == "bound" for column in columns)
    parts = [*_scenarios(columns, lines, names, wide=wide), "", *_NOTE, *(_BOUND_NOTE if shown else ()), ""]
    parts += [*_false_alarms(alarm_columns, of_alarms, names), "", *_ALARM_NOTE]
    if not wide:
        parts.append("All columns: fddbench run --wide")
    return "\n".join(line.rstrip() for line in parts)


def _scenarios(columns: Sequence[_Column], lines: Sequence[Line], names: Mapping[str, str], *, wide: bool) -> list[str]:
    room = _WIDTH - max(len(_heading(line, "")) for line in lines)
    scenarios = shortened((str(line["scenario"]) for line in lines), 10_000 if wide else room)
    body = _aligned(columns, lines, names)
    text, previous = [body[0], "-" * len(body[0])], None
    for line, row in zip(lines, body[1:], strict=True):
        if line["scenario"] != previous:
            text.append(_heading(line, scenarios[line["scenario"]]))
        previous = line["scenario"]
        text.append(row)
    return text + _marks(lines)


def _heading(line: Line, name: str) -> str:
    limit_s = line["detection_time_limit_s"]
    limit = "healthy" if line["healthy"] else f"limit {limit_s:g} s" if present(limit_s) else ""
    number = f"{line['flights']} flight{'s' if line['flights'] > 1 else ''}"
    notes = ", ".join(filter(None, (limit, number, _pooled(line))))
    return f"{name} ({notes})" if notes else name


def _pooled(line: Line) -> str:
    return f"pools {line['pools']}" if present(line["pools"]) else ""


def _marks(lines: Sequence[Line]) -> list[str]:
    return ["* in sample: tuned on flights of this campaign"] if any(line["in_sample"] for line in lines) else []


def _false_alarms(columns: Sequence[_Column], lines: Sequence[Line], names: Mapping[str, str]) -> list[str]:
    body = _aligned(columns, lines, names)
    pooled = next((_pooled(line) for line in lines if _pooled(line)), "")
    title = f"False alarms of distinct flights{f' ({pooled})' if pooled else ''}"
    return [title, body[0], "-" * len(body[0]), *body[1:]]


def _fitting(columns: Sequence[_Column], lines: Sequence[Line], *, wide: bool) -> tuple[list[_Column], int]:
    """Columns that fit beside the names, and the characters that are left for these."""
    longest = max(len(str(line["detector"])) for line in lines)
    if wide:
        return list(columns), longest
    kept = [column for column in columns if column.leaves < 9]
    while (room := _room(kept, lines)) < min(longest, _LEAST_NAME) and any(column.leaves for column in kept):
        kept.remove(max(kept, key=lambda column: column.leaves))
    return kept, min(longest, max(room, 3))


def _room(columns: Sequence[_Column], lines: Sequence[Line]) -> int:
    """Characters left for names of detectors, after an indent of two and a mark."""
    return _WIDTH - 3 - sum(1 + _width(column, lines) for column in columns)


def _width(column: _Column, lines: Sequence[Line]) -> int:
    return max(len(column.head), *(len(_plain(column.text(line))) for line in lines))


def _aligned(columns: Sequence[_Column], lines: Sequence[Line], short: Mapping[str, str]) -> list[str]:
    """Head and lines of a table whose first column holds the names, with a mark where the detector was tuned here."""
    names = [short[line["detector"]] + "*" * bool(line["in_sample"]) for line in lines]
    widths = [_width(column, lines) for column in columns]
    first = max(map(len, names))
    head = [" " * (first + 2), *(column.head.rjust(w) for column, w in zip(columns, widths, strict=True))]
    body = [
        [f"  {name:<{first}}", *(_plain(column.text(line)).rjust(w) for column, w in zip(columns, widths, strict=True))]
        for name, line in zip(names, lines, strict=True)
    ]
    return [" ".join(row) for row in (head, *body)]


def _plain(text: str) -> str:
    return text.replace("\u202f", "")
