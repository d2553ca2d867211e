"""Picture of a trade-off: a line for every changed number of a recipe, a panel for each thing it buys or costs."""

import base64
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.pictures import INK, MUTED, colour, to_png

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["tradeoff_png"]


def tradeoff_png(table: pd.DataFrame, columns: Mapping[str, str], *, title: str) -> bytes:
    """PNG of a table of `fddbench.tradeoff`.

    Parameters
    ----------
    table : DataFrame
        The first row is what all others are changes of.
    columns : mapping of str to str
        Columns to show, with the titles of their panels; a title that ends in "(log)" gets a logarithmic axis.
    title : str
        Over the picture.
    """
    names, tints = _names(table), _tints(table)

    def draw(figure: "Figure") -> None:
        figure.suptitle(title, x=0.01, ha="left", fontsize=9.5, fontweight="bold")
        panels = figure.subplots(1, len(columns), sharey=True, squeeze=False)[0]
        for axes, (column, heading) in zip(panels, columns.items(), strict=True):
            _panel(axes, table[column].to_numpy(dtype=np.float64, na_value=np.nan), heading, tints)
        panels[0].set_yticks(range(len(names)), names)
        panels[0].set_ylim(len(names) - 0.5, -0.5)

    drawn = to_png(draw, width_in=3.4 + 1.55 * len(columns), height_in=0.9 + 0.2 * len(table))
    return base64.b64decode(drawn or "")


def _panel(axes: "Axes", values: Floats, heading: str, tints: Sequence[Any]) -> None:
    """One measure of every design, the first as a line through all."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    if heading.endswith("(log)"):
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0), numticks=5))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.axvline(values[0], color=MUTED, lw=0.9, ls=(0, (3, 2)))
    for row, (value, tint) in enumerate(zip(values, tints, strict=True)):
        axes.plot([values[0], value], [row, row], color=tint, lw=1.2, alpha=0.5)
        axes.plot([value], [row], "o", ms=4.2, color=tint)
    axes.set_title(heading.removesuffix("(log)").strip(), fontsize=8, color=INK, fontweight="normal")
    axes.tick_params(axis="x", labelsize=6.5, which="both")
    axes.grid(axis="y", visible=False)


def _names(table: pd.DataFrame) -> list[str]:
    return [
        f"{key.rpartition('.')[2]} = {value}" if key else design
        for design, key, value in table[["design", "key", "value"]].itertuples(index=False)
    ]


def _tints(table: pd.DataFrame) -> list[Any]:
    """A colour per key; what differs by no key is ink."""
    keys = list(dict.fromkeys(key for key in table["key"] if key))
    return [colour(keys.index(key)) if key else INK for key in table["key"]]
