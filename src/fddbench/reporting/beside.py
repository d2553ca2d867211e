"""Our results beside a printed table: outcomes, and detection times in samples and as shares of the limit."""

from dataclasses import dataclass
from typing import Any

import pandas as pd

from fddbench.reporting.formats import DASH, count, present, signed
from fddbench.reporting.published import Published, PublishedRow
from fddbench.reporting.tables import Cell

__all__ = ["Beside", "beside"]

_OTHERS = {
    "wrong_site": "wrong",
    "late": "late",
    "missed": "missed",
    "undecided": "undecided",
    "false_alarm": "false alarms",
}

Line = dict[Any, Any]


@dataclass(frozen=True, kw_only=True)
class Beside:
    """A printed table, the groups of its columns by their heads, and lines of cells: ours, then three cells a group."""

    table: Published
    groups: tuple[str, ...]
    lines: list[list[Cell]]


def beside(summary: pd.DataFrame, table: Published) -> Beside | None:
    """Lines of the scenarios that are in print, None without one.

    A scenario whose name says which printed row it is stands beside that row alone; others, ``jam_a``, beside all variants.
    """
    named = table.named(set(summary["scenario"]))
    printed = {row.scenario for row in table.rows if row.detection_time_samples is not None}
    loose = [line for line in summary.to_dict("records") if line["scenario"] in printed]
    if loose:
        groups = tuple(table.variants.values())
        healthy = [line for line in summary.to_dict("records") if line["scenario"] in named and line["healthy"]]
        lines = [_line(line, table, [named[line["scenario"]]] * len(groups)) for line in healthy]
        lines += [_line(line, table, [table.row(name, line["scenario"]) for name in table.variants]) for line in loose]
        return Beside(table=table, groups=groups, lines=lines)
    ours = [line for line in summary.to_dict("records") if line["scenario"] in named]
    if not ours:
        return None
    lines = [_line(line, table, [named[line["scenario"]]]) for line in ours]
    return Beside(table=table, groups=("in print",), lines=lines)


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


def _right(line: Line) -> Cell:
    """How many were right of those decided (quiet of those flown), and what became of the others."""
    good, of = ("quiet", "flown") if line["healthy"] else ("right", "decided")
    others = [f"{count(line[name])} {word}" for name, word in _OTHERS.items() if present(line[name]) and line[name]]
    lost = [f"{count(line[name])} {name}" for name in ("infeasible", "failed") if line[name]]
    wrong = bool(line[of]) and line[good] < line[of]
    return Cell(f"{count(line[good])} of {count(line[of])}", ", ".join([*others, *lost]), alarm=wrong)


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
