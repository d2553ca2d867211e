"""The outcome matrix: a line a scenario, a column a detector, in each cell a stacked bar and its words."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fddbench.reporting.formats import count, percent, present
from fddbench.reporting.names import shortened
from fddbench.reporting.page.cells import Cell
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.payload import counts_of
from fddbench.reporting.svg.charts import bar_marks
from fddbench.reporting.svg.scene import Box, Mark, Path, Scene, Text, number, path_data

__all__ = ["MatrixCell", "MatrixLine", "matrix_lines", "matrix_scene", "words"]

_WIDTH, _HEIGHT = 150.0, 16.0
_SHORT = {
    "quiet": "quiet",
    "late": "late",
    "undecided": "undecided",
    "missed": "missed",
    "wrong_site": "wrong site",
    "false_alarm": "false alarm",
}


@dataclass(frozen=True)
class MatrixCell:
    """Bar as SVG without its frame, words, and the place of the detector."""

    detector: int
    bar: str
    words: str
    failed: bool


@dataclass(frozen=True)
class MatrixLine:
    """A scenario: its name, what stands below it, its cells, and how badly it goes at worst (to sort by)."""

    scenario: int
    name: str
    note: str
    cells: list[MatrixCell | None]
    badness: int


def matrix_lines(columns: Columns, cells: Mapping[tuple[int, int], Cell]) -> list[MatrixLine]:
    """Lines of the matrix in the order of the campaign."""
    lines = []
    for s, name in enumerate(columns.scenarios):
        own = [cells.get((s, d)) for d in range(len(columns.detectors))]
        known = [cell for cell in own if cell is not None]
        lines.append(
            MatrixLine(
                scenario=s, name=name, note=_note(known[0].line) if known else "",
                cells=[None if cell is None else _cell(cell) for cell in own],
                badness=max((_badness(cell.line) for cell in known), default=0),
            )
        )  # fmt: skip
    return lines


def _note(line: Mapping[Any, Any]) -> str:
    limit = line["detection_time_limit_s"]
    said = "healthy" if line["healthy"] else f"limit {limit:g} s" if present(limit) else "faulty"
    return said + (f", pools {line['pools']}" if present(line["pools"]) else "")


def _badness(line: Mapping[Any, Any]) -> int:
    """Failed flights in a thousand."""
    counts = counts_of(line)
    failed = sum(n for name, n in counts.items() if name not in ("right", "quiet", "undecided"))
    return round(1000 * failed / max(sum(counts.values()), 1))


def ends_of(line: Mapping[Any, Any]) -> tuple[float, float] | None:
    """Interval of the share that is right, of healthy flights that are quiet [-]; None: one run."""
    if line["healthy"]:
        low, high = line["alarms_low_percent"], line["alarms_high_percent"]
        return (1.0 - high / 100.0, 1.0 - low / 100.0) if present(low) and present(high) else None
    low, high = line["right_low_percent"], line["right_high_percent"]
    return (low / 100.0, high / 100.0) if present(low) and present(high) else None


def words(line: Mapping[Any, Any]) -> str:
    """What the bar says: ``all 100 right, ≥ 96.4 %``, ``75 wrong site, 2 missed of 100``."""
    counts, flown = counts_of(line), int(line["flown"])
    if not flown:
        lost = [
            f"{count(line[name])} {word}"
            for name, word in (("failed", "without a score"), ("infeasible", "infeasible"))
            if line[name]
        ]
        return ", ".join(lost) or "none flown"
    good = "quiet" if line["healthy"] else "right"
    if counts.get(good) == flown:
        ends = ends_of(line)
        least = f", ≥ {percent(100.0 * ends[0])} %" if ends is not None else ""
        return f"all {count(flown)} {good}{least}"
    if counts.get("right", 0) + counts.get("quiet", 0) == flown:
        return f"{count(counts['right'])} right, {count(counts['quiet'])} quiet of {count(flown)}"
    rest = sorted(((n, _SHORT[name]) for name, n in counts.items() if name not in (good, "quiet") and n), reverse=True)
    more = ", …" if len(rest) > 2 else ""
    return f"{', '.join(f'{count(n)} {word}' for n, word in rest[:2])}{more} of {count(flown)}"


def _cell(cell: Cell) -> MatrixCell:
    marks = bar_marks(counts_of(cell.line), ends_of(cell.line), x=0, y=0, width=_WIDTH, height=_HEIGHT)
    return MatrixCell(
        detector=cell.detector,
        bar="".join(map(_short_mark, marks)),
        words=words(cell.line),
        failed=_badness(cell.line) > 0,
    )


def _short_mark(mark: Mark) -> str:
    """Boxes of the bar as short as they can be, for a large page has thousands; their height is in the style sheet."""
    if isinstance(mark, Box):
        left = f' x="{number(mark.x)}"' if mark.x else ""
        return f'<rect class="{mark.look}"{left} width="{number(mark.width)}"/>'
    assert isinstance(mark, Path)
    return f'<path class="ci" d="{path_data(mark.points)}"/>'


def matrix_scene(columns: Columns, cells: Mapping[tuple[int, int], Cell]) -> Scene:
    """The whole matrix as one picture."""
    lines = matrix_lines(columns, cells)
    left, step = 12.0 + 7.0 * min(max(map(len, columns.scenarios), default=8), 34), _WIDTH + 22.0
    heads, names = shortened(columns.detectors, 20), shortened(columns.scenarios, 34)
    marks: list[Mark] = [Text(left + step * d, 16, heads[name], bold=True) for d, name in enumerate(columns.detectors)]
    y = 30.0
    for line in lines:
        marks += [Text(4, y + 12, names[line.name], bold=True), Text(4, y + 26, line.note, "ts", size=10)]
        for d in range(len(columns.detectors)):
            own = cells.get((line.scenario, d))
            if own is not None:
                marks += bar_marks(
                    counts_of(own.line), ends_of(own.line), x=left + step * d, y=y, width=_WIDTH, height=_HEIGHT
                )
                marks.append(Text(left + step * d, y + 32, words(own.line), "ts", size=10))
        y += 44.0
    size = left + step * len(columns.detectors) + 20.0
    return Scene(size, y + 6.0, "Outcomes of every scenario with every detector", marks)
