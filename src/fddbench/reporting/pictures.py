"""How pictures of matplotlib look, and how they become files: the same bytes for the same input."""

import base64
import io
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["INK", "MUTED", "WARNING", "colour", "dashes", "drawn", "to_png"]

INK, MUTED, WARNING = "#1f2933", "#7b8794", "#b3261e"
# Okabe and Ito (2008): told apart by the colour blind and in grey.
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_STYLE: Any = {
    "text.parse_math": False,
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.5,
    "text.color": INK,
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.labelsize": 8,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#e4e7eb",
    "grid.linewidth": 0.6,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "figure.facecolor": "white",
}


def colour(i: int) -> str:
    """Colour of detector `i` in every picture."""
    return _COLOURS[i % len(_COLOURS)]


def dashes(i: int) -> Any:
    """Line style of detector `i`, so that equal curves both show."""
    return ("-", (0, (3, 1.5)), (0, (1, 1)), (0, (5, 1, 1, 1)))[i % 4]


def to_png(draw: Callable[["Figure"], None], *, width_in: float, height_in: float) -> str | None:
    """Picture drawn by `draw` on a fresh figure, as base64 text of a PNG; None for numbers that no axis can hold."""
    try:
        content = drawn(draw, kind="png", width_in=width_in, height_in=height_in)
    except (ValueError, OverflowError):  # sizes of 1e308 overflow the limits of an axis: one picture less
        return None
    return base64.b64encode(content).decode("ascii")


def drawn(draw: Callable[["Figure"], None], *, kind: str, width_in: float, height_in: float) -> bytes:
    """Picture drawn by `draw` on a fresh figure as the content of a file, ``"png"``, ``"svg"`` or ``"pdf"``, without a date.

    Drawn by Agg without pyplot: nothing global is touched and nothing has to be closed.
    """
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with mpl.rc_context({**_STYLE, "svg.hashsalt": "fddbench"}):
        figure = Figure(figsize=(width_in, height_in), dpi=130, layout="constrained")
        FigureCanvasAgg(figure)
        stream = io.BytesIO()
        with np.errstate(all="ignore"):
            draw(figure)
            figure.savefig(stream, format=kind, **_PLAIN[kind])
    return stream.getvalue()


_PLAIN: Mapping[str, dict[str, Any]] = {
    "png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 9}},
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": {"CreationDate": None}},
}
"""How each kind of file is written with the same bytes for the same picture."""
