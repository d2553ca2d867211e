"""Heat maps: cells over two axes with their number, hatched where few flights stand behind it, grey where none can fly."""

from collections.abc import Sequence
from dataclasses import dataclass

from fddbench.reporting.svg.axes import Plot, linear
from fddbench.reporting.svg.scene import Box, Mark, Path, Point, Scene, Text

__all__ = ["HeatCell", "Side", "heat_scene"]

_SIZE = 232.0


@dataclass(frozen=True, kw_only=True)
class Side:
    """An axis of a map: its name, its ends, and where which tick stands."""

    name: str
    low: float
    high: float
    ticks: Sequence[tuple[float, str]]


@dataclass(frozen=True, kw_only=True)
class HeatCell:
    """A cell: its ends, how dark it is (0 to 1; None: grey, nothing can fly there), two lines of text, whether to hatch it."""

    x: tuple[float, float]
    y: tuple[float, float]
    dark: float | None
    text: str
    below: str = ""
    hatched: bool = False


def heat_scene(
    cells: Sequence[HeatCell], *, x: Side, y: Side, title: str, label: str, look: str = "o4", note: str = ""
) -> Scene:
    """Map of cells.

    Parameters
    ----------
    cells : sequence of HeatCell
        Those that there are; what is missing stays empty.
    x, y : Side
        The axes.
    look : str
        Colour of the darkest.
    note : str
        Below the title.
    """
    top = 40.0 if note else 26.0
    plot = Plot(66, top, _SIZE + 40, _SIZE, linear(x.low, x.high), linear(y.low, y.high))
    marks: list[Mark] = [Text(2, 12, title, bold=True)] if title else []
    marks += [Text(2, 27, note, "ts", size=10)] if note else []
    for cell in cells:
        marks += _cell(plot, cell, look)
    every = max(1, -(-len(x.ticks) * 44 // int(plot.width)))
    bottom = plot.top + plot.height
    marks += [Text(plot.at(at, y.low)[0][0], bottom + 15, text, "ts", "middle") for at, text in x.ticks[::every]]
    marks += [Text(plot.left - 5, plot.at(x.low, at)[0][1] + 4, text, "ts", "end") for at, text in y.ticks]
    marks += [
        Text(plot.left + plot.width / 2, bottom + 33, x.name, "ts", "middle"),
        Text(10, plot.top + plot.height / 2, y.name, "ts", "middle", turned=True),
    ]
    return Scene(plot.left + plot.width + 22, bottom + 40, label, marks)


def _cell(plot: Plot, cell: HeatCell, look: str) -> list[Mark]:
    (left, bottom), (right, top) = plot.at(cell.x[0], cell.y[0])[0], plot.at(cell.x[1], cell.y[1])[0]
    # whole pixels with a gap of one: half as many characters
    left, right, top, bottom = round(left) + 1.0, round(right), round(top) + 1.0, round(bottom)
    size = right - left, bottom - top
    # pale enough for dark words on it, in light and in dark
    fill = (
        Box(left, top, *size, "no")
        if cell.dark is None
        else Box(left, top, *size, look, opacity=0.04 + 0.46 * cell.dark)
    )
    marks: list[Mark] = [fill]
    if cell.hatched:
        marks.append(Path(_hatch(left, top, right, bottom), "ht"))
    x, y = round(0.5 * (left + right)), round(0.5 * (top + bottom))
    wide = size[0] >= 25.0
    if wide and size[1] >= 13.0:
        two = bool(cell.below) and size[1] >= 26.0
        marks.append(Text(x, y + (0 if two else 4), cell.text, anchor="middle", size=10))
        if two:
            marks.append(Text(x, y + 11, cell.below, "ts", "middle", size=9))
    return marks


def _hatch(left: float, top: float, right: float, bottom: float, step: float = 9.0) -> list[Point]:
    """Lines from lower left to upper right inside a box, one path with breaks."""
    points: list[Point] = []
    at = left + top + step
    while at < right + bottom:
        # x + y = at inside the box
        x0, x1 = max(left, at - bottom), min(right, at - top)
        if x1 > x0:
            points += [(x0, at - x0), (x1, at - x1), (float("nan"), float("nan"))]
        at += step
    return points
