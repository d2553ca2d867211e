"""A sheet with marks, and its text as SVG: short, and whatever a user named stays text."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from markupsafe import escape

from fddbench.reporting.svg.palette import LOOKS

__all__ = ["Box", "Dot", "Mark", "Path", "Scene", "Text", "number", "path_data"]

Point = tuple[float, float]


@dataclass(frozen=True)
class Path:
    """A line through points [px], or a closed area; a point that is not a number interrupts it."""

    points: Sequence[Point]
    look: str
    closed: bool = False
    group: str = ""


@dataclass(frozen=True)
class Box:
    """A rectangle [px]; `title` is what a pointer over it reads."""

    x: float
    y: float
    width: float
    height: float
    look: str
    opacity: float = 1.0
    title: str = ""


@dataclass(frozen=True)
class Dot:
    """A disc, or a ring where it is hollow."""

    x: float
    y: float
    look: str
    radius: float = 3.5
    title: str = ""


@dataclass(frozen=True)
class Text:
    """A word: anchor is start, middle or end; turned reads upwards."""

    x: float
    y: float
    text: str
    look: str = "t"
    anchor: str = "start"
    turned: bool = False
    bold: bool = False
    size: float = 0.0


Mark = Path | Box | Dot | Text


@dataclass(frozen=True)
class Scene:
    """A picture: its size [px], what it is in words, its marks from back to front."""

    width: float
    height: float
    label: str
    marks: Sequence[Mark] = field(default=())

    def svg(self, *, standalone: bool = False) -> str:
        """Text of the picture; standalone it needs no style sheet, else that of the page."""
        body = "".join(_mark(mark, standalone=standalone) for mark in self.marks)
        size = f'viewBox="0 0 {number(self.width)} {number(self.height)}"'
        head = f'<svg {size} role="img" aria-label="{escape(self.label)}"'
        if standalone:
            font = 'font-family="system-ui,DejaVu Sans,sans-serif" font-size="11.5"'
            head += f' xmlns="http://www.w3.org/2000/svg" width="{number(self.width)}" height="{number(self.height)}" {font}'
            body = f'<rect width="100%" height="100%" fill="#fff"/>{body}'
        return f"{head}>{body}</svg>"


def number(value: float) -> str:
    """To a tenth of a pixel, without needless characters.

    >>> number(12.04), number(-0.52), number(0.0)
    ('12', '-.5', '0')
    """
    text = f"{round(value, 1):g}"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def path_data(points: Iterable[Point], *, closed: bool = False) -> str:
    """Relative path, h and v where it runs along an axis.

    >>> path_data([(0, 0), (10, 0), (10, 5), (12, 7)])
    'M0 0h10v5l2 2'
    """
    text, at = [], None
    for x, y in (np.round(np.asarray(list(points), dtype=np.float64).reshape(-1, 2), 1)).tolist():
        if np.isnan(x) or np.isnan(y):
            at = None
            continue
        if at is None:
            text.append(f"M{number(x)} {number(y)}")
        else:
            dx, dy = round(x - at[0], 1), round(y - at[1], 1)
            if dx or dy:
                text.append(_step(dx, dy))
        at = (x, y)
    return "".join(text) + ("z" if closed else "")


def _step(dx: float, dy: float) -> str:
    if not dy:
        return f"h{number(dx)}"
    if not dx:
        return f"v{number(dy)}"
    second = number(dy)
    return f"l{number(dx)}{'' if second.startswith('-') else ' '}{second}"


def _style(name: str, *, standalone: bool, opacity: float = 1.0) -> str:
    """Class of the page, or the same as attributes."""
    more = f' opacity="{number3(opacity)}"' if opacity < 1.0 else ""
    if not standalone:
        return f'class="{name}"{more}'
    look = LOOKS[name]
    dim = look.opacity * opacity
    more = f' opacity="{number3(dim)}"' if dim < 1.0 else ""
    if look.fills:
        return f'fill="{look.light}"{more}'
    dashes = f' stroke-dasharray="{look.dashes}"' if look.dashes else ""
    return f'fill="none" stroke="{look.light}" stroke-width="{look.width:g}"{dashes}{more}'


def number3(value: float) -> str:
    """Opacity to three digits."""
    return f"{value:.3g}".replace("0.", ".", 1)


def _titled(tag: str, title: str) -> str:
    name = tag.split(" ", 1)[0]
    return f"<{tag}><title>{escape(title)}</title></{name}>" if title else f"<{tag}/>"


def _mark(mark: Mark, *, standalone: bool) -> str:
    if isinstance(mark, Path):
        group = f' data-d="{mark.group}"' if mark.group and not standalone else ""
        return f'<path {_style(mark.look, standalone=standalone)}{group} d="{path_data(mark.points, closed=mark.closed)}"/>'
    if isinstance(mark, Box):
        size = f'x="{number(mark.x)}" y="{number(mark.y)}" width="{number(mark.width)}" height="{number(mark.height)}"'
        return _titled(f"rect {_style(mark.look, standalone=standalone, opacity=mark.opacity)} {size}", mark.title)
    if isinstance(mark, Dot):
        place = f'cx="{number(mark.x)}" cy="{number(mark.y)}" r="{number(mark.radius)}"'
        return _titled(f"circle {_style(mark.look, standalone=standalone)} {place}", mark.title)
    return _text(mark, standalone=standalone)


def _text(mark: Text, *, standalone: bool) -> str:
    """Words: on a page their look, anchor and size are classes of one or two letters."""
    turned = f' transform="rotate(-90 {number(mark.x)} {number(mark.y)})"' if mark.turned else ""
    if standalone:
        how = _style(mark.look, standalone=True)
        how += f' text-anchor="{mark.anchor}"' if mark.anchor != "start" else ""
        how += ' font-weight="700"' if mark.bold else ""
        how += f' font-size="{number(mark.size)}"' if mark.size else ""
    else:
        names = [mark.look] if mark.look != "t" else []
        names += [mark.anchor[0]] if mark.anchor != "start" else []
        names += [f"z{round(mark.size)}"] if mark.size else []
        names += ["w"] if mark.bold else []
        how = f'class="{" ".join(names)}"' if names else ""
    return f'<text {how} x="{number(mark.x)}" y="{number(mark.y)}"{turned}>{escape(mark.text)}</text>'
