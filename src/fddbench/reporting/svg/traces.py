"""Panels of signals over time: bands of many flights, thin lines of few, one drawn strong, thresholds dashed."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from fddbench.interfaces import Floats
from fddbench.reporting.svg.axes import Plot, linear
from fddbench.reporting.svg.scene import Mark, Path, Point, Scene, Text

__all__ = ["Panel", "coarse", "panel_scene"]

_WIDTH, _HEIGHT = 330.0, 100.0
_MOST = 1e100
"""Numbers beyond it are drawn at the edge: no axis holds them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Panel:
    """What one panel shows, (n_time,) each.

    Attributes
    ----------
    title, y_name : str
        Above it, and on its axis.
    time_s : (n_time,) array
        [s]
    bands : sequence of (lower, upper)
        Widest first.
    lines : sequence of (look, values)
        From back to front.
    onset_s : float or None
        Marked by a dotted line.
    look : str
        Of the bands.
    """

    title: str
    y_name: str
    time_s: Floats
    bands: Sequence[tuple[Floats, Floats]] = ()
    lines: Sequence[tuple[str, Floats]] = ()
    onset_s: float | None = None
    look: str = "b0"
    notes: Sequence[str] = field(default=())


def coarse(time_s: Floats, values: Floats, points: int) -> tuple[Floats, Floats]:
    """A line of at most so many points that keeps every extreme: smallest and largest of each block, in their order.

    >>> coarse(np.arange(6.0), np.array([0.0, 5.0, 1.0, 1.0, -3.0, 2.0]), 4)[1].tolist()
    [0.0, 5.0, -3.0, 2.0]
    """
    blocks = max(points // 2, 1)
    if len(values) <= points:
        return time_s, values
    cuts = np.linspace(0, len(values), blocks + 1).astype(np.int64)
    places: list[int] = []
    for a, b in pairwise(cuts.tolist()):
        part = values[a:b]
        if np.isnan(part).all():
            places.append(a)
            continue
        places += sorted({int(a + np.nanargmin(part)), int(a + np.nanargmax(part))})
    return time_s[places], values[places]


def panel_scene(panel: Panel, *, points: int = 120) -> Scene:
    """Picture of a panel; `points` bounds how many each line has."""
    every = [*(end for pair in panel.bands for end in pair), *(values for _, values in panel.lines)]
    known = np.concatenate([v[np.abs(v) < _MOST] for v in every]) if every else np.zeros(0)
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    room = 0.04 * (high - low)
    plot = Plot(
        50,
        18,
        _WIDTH - 66,  # the last tick has its half beyond the axis
        _HEIGHT,
        linear(float(panel.time_s[0]), float(panel.time_s[-1]), 6),
        linear(low - room, high + room, 4),
    )
    marks: list[Mark] = [Text(50, 12, panel.title, bold=True), *plot.frame("", panel.y_name)]
    for lower, upper in panel.bands:
        marks += _area(plot, panel.time_s, lower, upper, panel.look, points)
    for look, values in panel.lines:
        marks.append(Path(_points(plot, *coarse(panel.time_s, values, points)), look))
    if panel.onset_s is not None:
        marks.append(plot.upright(panel.onset_s, "on"))
    return Scene(_WIDTH, 18 + _HEIGHT + 22, f"{panel.title}: {panel.y_name} over time", marks)


def _points(plot: Plot, time_s: Floats, values: Floats) -> list[Point]:
    return [(x, float("nan") if np.isnan(v) else y) for (x, y), v in zip(plot.at(time_s, values), values, strict=True)]


def _area(plot: Plot, time_s: Floats, lower: Floats, upper: Floats, look: str, points: int) -> list[Mark]:
    """Between two lines where both are there, coarser by taking the extremes of blocks."""
    size = max(len(time_s) // max(points // 2, 1), 1)
    starts = np.arange(0, len(time_s), size)
    low, high, at = np.fmin.reduceat(lower, starts), np.fmax.reduceat(upper, starts), time_s[starts]
    there = np.isfinite(low) & np.isfinite(high)
    if there.sum() < 2:
        return []
    up, down = plot.at(at[there], high[there]), plot.at(at[there], low[there])
    return [Path([*up, *reversed(down)], look, closed=True)]
