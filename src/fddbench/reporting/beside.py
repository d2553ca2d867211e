"""Our results beside a printed table: outcomes, and detection times in samples and as shares of the limit."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from fddbench.reporting.conditions import differences
from fddbench.reporting.formats import DASH, count, present, signed
from fddbench.reporting.published import Published, PublishedRow
from fddbench.reporting.tables import Cell

__all__ = ["Beside", "Told", "beside"]

_OTHERS = {
    "wrong_site": "wrong",
    "late": "late",
    "missed": "missed",
    "undecided": "undecided",
    "false_alarm": "false alarms",
}

Line = dict[Any, Any]


@dataclass(frozen=True, kw_only=True)
class Told:
    """What a line of the table says in numbers.

    Attributes
    ----------
    detector : str
        Whose line it is.
    sound : bool or None
        Whether all decided flights are right, of a healthy scenario all flown ones quiet; None: there is none.
    away : int or None
        Median detection time less that in print, of the first group [samples]; None: one of them is none.
    """

    detector: str
    sound: bool | None
    away: int | None


@dataclass(frozen=True, kw_only=True)
class Beside:
    """A printed table, the groups of its columns by their heads, lines of cells (ours, then three a group), and what is apart.

    `told` are the lines in numbers, `apart` scenarios in print that were flown under other conditions, with what differs.
    """

    table: Published
    groups: tuple[str, ...]
    lines: list[list[Cell]]
    told: Sequence[Told]
    apart: tuple[tuple[str, str], ...] = ()


def beside(summary: pd.DataFrame, table: Published, campaign: Mapping[str, Any] | None = None) -> Beside | None:
    """Lines of the scenarios that are in print and were flown under the same conditions, None where none is in print.

    A scenario whose name says which printed row it is stands beside that row alone; others, ``jam_a``, beside all variants.
    """
    named = table.named(set(summary["scenario"]))
    printed = {row.scenario for row in table.rows if row.detection_time_samples is not None}
    every = summary.to_dict("records")
    loose = [line for line in every if line["scenario"] in printed]
    if loose:
        groups, ours = (
            tuple(table.variants),
            [line for line in every if line["scenario"] in named and line["healthy"]] + loose,
        )
    else:
        groups, ours = ("in print",), [line for line in every if line["scenario"] in named]
    if not ours:
        return None
    lines, told, apart = [], [], {}
    for line in ours:
        rows: list[PublishedRow | None] = (
            [named[line["scenario"]]] if not loose else _rows_of(line, table, named, groups)
        )
        differ = next((d for row in rows if row and (d := differences(campaign or {}, line, row))), [])
        if differ:
            apart[str(line["scenario"])] = ", ".join(differ)
        else:
            lines.append(_line(line, table, rows))
            told.append(_told(line, table, rows[0]))
    heads = tuple(table.variants[name] for name in groups) if loose else groups
    return Beside(table=table, groups=heads, lines=lines, told=told, apart=tuple(apart.items()))


def _rows_of(
    line: Line, table: Published, named: Mapping[str, PublishedRow], groups: Sequence[str]
) -> list[PublishedRow | None]:
    """Printed row of each variant."""
    if line["healthy"] and line["scenario"] in named:
        return [named[line["scenario"]]] * len(groups)
    return [table.row(name, line["scenario"]) for name in groups]


def _line(line: Line, table: Published, rows: list[PublishedRow | None]) -> list[Cell]:
    median, largest = (_samples(line[f"detection_time_{name}_s"], table.sample_s) for name in ("median", "max"))
    ratio = line["normalized_detection_time_max"]
    return [
        Cell(line["scenario"]),
        Cell(line["detector"]),
        _right(line),
        *(Cell(DASH if n is None else count(n)) for n in (median, largest)),
        Cell(f"{ratio:.4f}" if present(ratio) else DASH),
        *(cell for row in rows for cell in _printed(median, largest, row)),
    ]


def _told(line: Line, table: Published, printed: PublishedRow | None) -> Told:
    ours = _samples(line["detection_time_median_s"], table.sample_s)
    theirs = None if printed is None else printed.detection_time_samples
    away = None if ours is None or theirs is None else ours - theirs
    return Told(detector=str(line["detector"]), sound=None if not line[_good(line)[1]] else not _fails(line), away=away)


def _good(line: Line) -> tuple[str, str]:
    """Column of what went well, and of what it is a share of."""
    return ("quiet", "flown") if line["healthy"] else ("right", "decided")


def _fails(line: Line) -> bool:
    good, of = _good(line)
    return bool(line[of]) and line[good] < line[of]


def _right(line: Line) -> Cell:
    """How many were right of those decided (quiet of those flown), and what became of the others."""
    good, of = _good(line)
    others = [f"{count(line[name])} {word}" for name, word in _OTHERS.items() if present(line[name]) and line[name]]
    lost = [f"{count(line[name])} {name}" for name in ("infeasible", "failed") if line[name]]
    return Cell(f"{count(line[good])} of {count(line[of])}", ", ".join([*others, *lost]), alarm=_fails(line))


def _printed(median: int | None, largest: int | None, row: PublishedRow | None) -> list[Cell]:
    if row is None:
        return [Cell(DASH)] * 3
    share = f"{row.true_detection_percent:g} % true"
    if row.detection_time_samples is None:
        return [Cell(DASH, share), Cell(DASH), Cell(DASH)]
    text = f"{count(row.detection_time_samples)} ({row.normalized_detection_time:.4f})"
    differences = [DASH if n is None else signed(n - row.detection_time_samples) for n in (median, largest)]
    return [Cell(text, share), *map(Cell, differences)]


def _samples(time_s: Any, sample_s: float) -> int | None:
    return round(time_s / sample_s) if present(time_s) else None
