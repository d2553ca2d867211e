"""Flights that cannot be flown: where they lie and why."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.figures import label
from fddbench.reporting.formats import count, short
from fddbench.reporting.pictures import ORDINARY, colour, to_png
from fddbench.reporting.tables import Cell

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["INFEASIBLE", "infeasible_lines", "infeasible_map", "kind_of"]

INFEASIBLE = ("because of", "manoeuvre", "flights", "of", "where")
"""Heads of what `infeasible_lines` gives."""

_MARKERS = "osD^vP*X"
_MOST_LINES = 40


def kind_of(reason: str) -> str:
    """Kind of a reason: what stands before its last colon, else its words without their numbers.

    >>> kind_of("turn: buffet: lift coefficient 1.2 > 1.1"), kind_of("drawn mass_kg 3e5 lies outside 1 to 2")
    ('turn: buffet', 'drawn mass_kg … lies outside … to …')
    """
    before, colon, _ = reason.rpartition(":")
    return before if colon else re.sub(r"(?<![\w])[-+]?[\d.]+(e[-+]?\d+)?\b", "…", reason)


def _flights(rows: pd.DataFrame) -> pd.DataFrame:
    """Flights that differ in where or what is flown, once each, with the kind of what forbids them ("": nothing)."""
    flights = rows.drop_duplicates("case").drop_duplicates(["manoeuvre", "point", "run"])
    lost = np.asarray(flights["status"] == "infeasible", dtype=bool)
    reasons = flights["reason"].astype(object).where(lost, "").fillna("")
    # a manoeuvre's name in front says nothing that its column does not
    short = [
        kind_of(reason).removeprefix(f"{name}: ") if reason else ""
        for reason, name in zip(reasons, flights["manoeuvre"], strict=True)
    ]
    return flights.assign(kind=short, infeasible=lost)


def infeasible_lines(rows: pd.DataFrame, axes: Sequence[tuple[str, str]]) -> list[list[Cell]]:
    """One line per kind of reason and manoeuvre: how many flights, and between which parameters; most frequent first."""
    flights = _flights(rows)
    flown = flights.groupby("manoeuvre", sort=False).size().to_dict()
    names = [f"p_{name}" for pair in axes for name in pair if f"p_{name}" in flights]
    lost = flights[np.asarray(flights["infeasible"], dtype=bool)]
    groups = sorted(lost.groupby(["kind", "manoeuvre"], sort=False), key=lambda pair: -len(pair[1]))
    return [
        [
            Cell(str(kind)),
            Cell(str(manoeuvre)),
            Cell(count(len(group))),
            Cell(count(flown[manoeuvre])),
            Cell(", ".join(_range(name, _numbers(group, name)) for name in names)),
        ]
        for (kind, manoeuvre), group in groups[:_MOST_LINES]
    ]


def _range(name: str, values: Floats) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{label(name)} {short(low)}" + (f" to {short(high)}" if high > low else "")


def infeasible_map(rows: pd.DataFrame, axes: Sequence[tuple[str, str]]) -> str | None:
    """Picture of where flights are infeasible by kind of reason, the larger the more; None where there is none or no axis."""
    flights = _flights(rows)
    pairs = [(f"p_{x}", f"p_{y}") for x, y in axes if {f"p_{x}", f"p_{y}"} <= set(flights.columns)]
    pairs = [(x, y) for x, y in pairs if flights[x].nunique() > 1 and flights[y].nunique() > 1]
    kinds = list(flights[np.asarray(flights["infeasible"], dtype=bool)]["kind"].value_counts().index)
    if not kinds or not pairs:
        return None

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, max(len(pairs), 2), squeeze=False).ravel()
        for panel, (x, y) in zip(panels, pairs, strict=False):
            _draw_map(panel, flights, kinds, x, y)
        for panel in panels[len(pairs) :]:
            panel.set_visible(False)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=4)

    return to_png(draw, width_in=11.4, height_in=4.1)


def _draw_map(axes: "Axes", flights: pd.DataFrame, kinds: Sequence[str], x: str, y: str) -> None:
    """Kinds of reasons side by side at the same place, so that none hides another."""
    everywhere = flights.groupby([x, y]).size().reset_index()
    axes.scatter(
        _numbers(everywhere, x),
        _numbers(everywhere, y),
        s=14,
        color=ORDINARY,
        alpha=0.5,
        linewidths=0,
        label="asked for",
    )
    span = float(np.ptp(_numbers(flights, x)))
    on_grid = flights[x].nunique() <= 12
    for i, kind in enumerate(kinds):
        here = flights[np.asarray(flights["kind"] == kind, dtype=bool)]
        places = here.groupby([x, y]).size().reset_index(name="n")
        aside = 0.022 * span * (i - 0.5 * (len(kinds) - 1)) if on_grid else 0.0
        axes.scatter(
            _numbers(places, x) + aside, _numbers(places, y), s=16.0 * np.sqrt(_numbers(places, "n")), zorder=3 + i,
            facecolors=colour(i) if i < 4 else "none", edgecolors=colour(i), alpha=0.75, marker=_MARKERS[i % len(_MARKERS)],
            linewidths=0.8, label=f"{kind} (n = {len(here)})",
        )  # fmt: skip
    axes.set(xlabel=label(x), ylabel=label(y))


def _numbers(table: pd.DataFrame, column: str) -> Any:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan)
