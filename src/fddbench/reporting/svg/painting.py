"""Marks on a figure of matplotlib: how a picture becomes PDF or PNG without another library."""

from typing import TYPE_CHECKING, Any

from fddbench.reporting.pictures import drawn
from fddbench.reporting.svg.palette import LOOKS
from fddbench.reporting.svg.scene import Box, Dot, Mark, Path, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["painted"]

_PX_PER_IN, _POINTS_PER_PX = 96.0, 0.75


def painted(scene: Scene, kind: str) -> bytes:
    """Content of a file of this kind, ``"pdf"`` or ``"png"``; a pixel is 1/96 inch."""

    def draw(figure: "Figure") -> None:
        figure.set_layout_engine("none")
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, scene.width), ylim=(scene.height, 0.0))
        axes.axis("off")
        for mark in scene.marks:
            _paint(axes, mark)

    return drawn(draw, kind=kind, width_in=scene.width / _PX_PER_IN, height_in=scene.height / _PX_PER_IN)


def _paint(axes: "Axes", mark: Mark) -> None:
    look = LOOKS[mark.look]
    if isinstance(mark, Path):
        x, y = [point[0] for point in mark.points], [point[1] for point in mark.points]
        if look.fills:
            axes.fill(x, y, color=look.light, alpha=look.opacity, linewidth=0)
        else:
            axes.plot(x, y, color=look.light, alpha=look.opacity, **_line(look.width, look.dashes))
    elif isinstance(mark, Box):
        _paint_box(axes, mark)
    elif isinstance(mark, Dot):
        from matplotlib.patches import Circle

        face = look.light if look.fills else "none"
        axes.add_patch(Circle((mark.x, mark.y), mark.radius, facecolor=face, edgecolor=look.light))
    else:
        size = (mark.size or 11.5) * _POINTS_PER_PX
        anchor = {"start": "left", "middle": "center", "end": "right"}[mark.anchor]
        axes.text(
            mark.x, mark.y, mark.text, color=look.light, size=size, ha=anchor, va="baseline", rotation_mode="anchor",
            rotation=90 if mark.turned else 0, weight="bold" if mark.bold else "normal", parse_math=False,
        )  # fmt: skip


def _paint_box(axes: "Axes", mark: Box) -> None:
    from matplotlib.patches import Rectangle

    look = LOOKS[mark.look]
    colours: dict[str, Any] = (
        {"facecolor": look.light, "linewidth": 0} if look.fills else {"facecolor": "none", "edgecolor": look.light}
    )
    axes.add_patch(Rectangle((mark.x, mark.y), mark.width, mark.height, alpha=mark.opacity * look.opacity, **colours))


def _line(width: float, dashes: str) -> dict[str, Any]:
    points = width * _POINTS_PER_PX
    if not dashes:
        return {"linewidth": points, "solid_capstyle": "butt"}
    return {"linewidth": points, "linestyle": (0, [float(d) / width for d in dashes.split()])}
