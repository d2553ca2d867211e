"""Share found against the size of a fault: parts with their intervals, the fitted curve, and the size found in 90 %."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.reporting.svg.axes import Plot, Scale
from fddbench.reporting.svg.charts import Parted, time_scale
from fddbench.reporting.svg.scene import Dot, Mark, Path, Scene, Text

__all__ = ["Fitted", "size_scene"]

_PERCENT = Scale(0.0, 100.0, (0.0, 50.0, 90.0))


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fitted curve as a picture takes it.

    Attributes
    ----------
    middles : sequence of float
        Where the parts lie on the axis.
    sizes, shares : sequences of float
        Points of the curve over the sizes flown [-].
    size_90, size_90_95 : float or None
        Size found in 90 %, and its upper end; None: there is none, or it lies far beyond the sizes flown.
    """

    middles: Sequence[float]
    sizes: Sequence[float]
    shares: Sequence[float]
    size_90: float | None
    size_90_95: float | None


def size_scene(parts: Parted, fitted: Fitted, *, name: str, label: str, number: int = 0) -> Scene:
    """Shares over the size itself."""
    ends = [x for x in (fitted.size_90, fitted.size_90_95) if x is not None]
    scale = time_scale([*fitted.sizes, *fitted.middles, *ends], np.nan)
    plot = Plot(46, 8, 310, 120, scale, _PERCENT)
    marks = plot.frame(f"{name}{', log' if scale.log else ''}", "right [%]")
    curve = plot.at(np.array(fitted.sizes), 100.0 * np.array(fitted.shares))
    marks.append(Path(curve, "ik"))
    if fitted.size_90 is not None:
        marks.append(plot.upright(fitted.size_90, "on"))
    if fitted.size_90_95 is not None:
        marks.append(plot.upright(fitted.size_90_95, "lim"))
    for x, (_, hits, flights, low, high) in zip(fitted.middles, parts, strict=True):
        if flights and np.isfinite(x):
            marks += _point(plot, x, hits, flights, (low, high), number)
    return Scene(366, 162, label, marks)


def _point(plot: Plot, x: float, hits: int, flights: int, ends: tuple[float, float], number: int) -> list[Mark]:
    px, py = plot.at(x, 100.0 * hits / flights)[0]
    marks: list[Mark] = []
    if np.isfinite(ends[0]):
        marks.append(Path([plot.at(x, 100.0 * end)[0] for end in ends], f"e{number % 8}"))
    marks.append(Dot(px, py, f"d{number % 8}", title=f"{hits} of {flights}"))
    if py > plot.top + 0.8 * plot.height:  # above the curve where there is no room below
        return [*marks, Text(px - 6, py - 6, f"{hits}/{flights}", "ts", "end", size=9)]
    return [*marks, Text(px + 6, py + 14, f"{hits}/{flights}", "ts", size=9)]
