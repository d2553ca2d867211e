"""Detection-time curves per fault and the envelope flown."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.pictures import INK, ORDINARY, WARNING, colour, dashes, to_png
from fddbench.units import suffix_of_name, unit_of_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["detection_curve", "detection_curves", "envelope", "label"]

_WIDTH_IN = 11.4


def label(name: str) -> str:
    """Axis label of a signal or parameter, its unit taken from the name.

    >>> label("reconstruction_deg_s"), label("p_mass_kg"), label("n_declared")
    ('reconstruction [deg/s]', 'mass [kg]', 'n declared')
    """
    name = name.removeprefix("p_")
    unit, suffix = unit_of_name(name), suffix_of_name(name)
    words = name.removesuffix(suffix).replace("_", " ")
    return f"{words} [{unit.replace('^2', '²')}]" if suffix else words


def detection_curve(time_s: Floats, follow_up_s: Floats, end_s: float) -> tuple[Floats, Floats]:
    """Share of all flown flights whose faults were found by each time, as corners of a step curve.

    Parameters
    ----------
    time_s : (n_flights,) array
        Detection times [s]; NaN: not detected.
    follow_up_s : (n_flights,) array
        How long each flight was watched after the onset [s].
    end_s : float
        Where the picture ends [s].

    Returns
    -------
    (n_corner,) arrays
        Times [s] and shares [%]. A flat end stops where the first undetected flight ended: beyond, it might have been.
    """
    detected = np.sort(time_s[~np.isnan(time_s)])
    unseen = follow_up_s[np.isnan(time_s)]
    last = min(end_s, float(np.min(unseen))) if len(unseen) else end_s
    corners = np.concatenate([[0.0], detected, [max(last, detected[-1] if len(detected) else 0.0)]])
    share = 100.0 * np.arange(len(detected) + 1) / len(time_s)
    return corners, np.append(share, share[-1])


def detection_curves(rows: pd.DataFrame) -> str | None:
    """Picture with one panel per faulty scenario and one curve per detector; None without a flown faulty flight."""
    flown = rows[np.asarray(rows["status"] == "ok", dtype=bool) & np.asarray(rows["n_faulty"] > 0, dtype=bool)]
    scenarios = list(flown["scenario"].unique())
    if not scenarios:
        return None
    order = list(rows["detector"].unique())
    columns = min(4, max(2, len(scenarios)))
    n_rows = -(-len(scenarios) // columns)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(n_rows, columns, squeeze=False).ravel()
        for axes, scenario in zip(panels, scenarios, strict=False):
            _curve_panel(axes, scenario, flown[np.asarray(flown["scenario"] == scenario, dtype=bool)], order)
        for axes in panels[len(scenarios) :]:
            axes.set_visible(False)
        _detector_legend(figure, order)

    lines = -(-(len(order) + 1) // _per_row(order))
    return to_png(draw, width_in=_WIDTH_IN, height_in=0.2 + 0.25 * lines + 2.15 * n_rows)


def _per_row(order: list[str]) -> int:
    """How many names fit into a row of a legend."""
    return max(1, min(len(order) + 1, int(_WIDTH_IN / (0.5 + 0.078 * max(map(len, order))))))


def _detector_legend(figure: "Figure", order: list[str]) -> None:
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=colour(i), ls=dashes(i), lw=2.0) for i in range(len(order))]
    limit = Line2D([], [], color=WARNING, lw=1.0, ls=(0, (4, 2)))
    figure.legend([*lines, limit], [*order, "requirement"], loc="outside upper left", ncols=_per_row(order))


def _curve_panel(axes: "Axes", scenario: str, flown: pd.DataFrame, order: list[str]) -> None:
    times, limit_s = _numbers(flown, "detection_time_s"), float(np.nanmin(_numbers(flown, "detection_time_limit_s")))
    detected = times[~np.isnan(times)]
    first, last = (float(detected.min()), float(detected.max())) if len(detected) else (limit_s, limit_s)
    log = limit_s > 20.0 * max(first, 1e-3) or last > 20.0 * max(first, 1e-3)
    end_s = (1.6 if log else 1.15) * max(limit_s, last)
    if log:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("")
        axes.set_xlim(max(first, 1e-3) / 3.0, end_s)
    else:
        axes.set_xlim(0.0, end_s)
    notes = [
        _curve(axes, flown[np.asarray(flown["detector"] == name, dtype=bool)], i, end_s) for i, name in enumerate(order)
    ]
    axes.axvline(limit_s, color=WARNING, lw=1.0, ls=(0, (4, 2)))
    axes.set(ylim=(-4, 104), yticks=(0, 50, 100), title=scenario, xlabel="time after onset [s]", ylabel="found [%]")
    for i, note in enumerate(notes):
        place = (0.97, 0.66 - min(0.14, 0.6 / len(order)) * i)
        axes.annotate(
            note, place, xycoords="axes fraction", color=colour(i), ha="right", size=7.5, backgroundcolor="#ffffffb0"
        )


def _curve(axes: "Axes", flown: pd.DataFrame, i: int, end_s: float) -> str:
    if flown.empty:
        return "none flown"
    times = _numbers(flown, "detection_time_s")
    corners, share = detection_curve(times, _numbers(flown, "flight_s") - _numbers(flown, "onset_s"), end_s)
    axes.step(corners, share, where="post", color=colour(i), ls=dashes(i), lw=2.0, clip_on=True)
    return f"{int(np.sum(~np.isnan(times)))} of n = {len(times)}"


def envelope(rows: pd.DataFrame, axes: Sequence[tuple[str, str]] = ()) -> str | None:
    """Picture of the dispersed parameters of every case, by what became of it; None when nothing varies.

    `axes` are pairs of parameters that belong together, one picture each; the others are paired as they come.
    """
    cases = rows.drop_duplicates("case")
    varying = [name for name in rows.columns if name.startswith("p_") and cases[name].nunique() > 1]
    pairs = [(f"p_{x}", f"p_{y}") for x, y in axes]
    pairs = [pair for pair in pairs if set(pair) <= set(varying)]
    rest = [name for name in varying if not any(name in pair for pair in pairs)]
    rest = [*rest, varying[0]] if len(rest) % 2 else rest
    pairs += [pair for i, pair in enumerate(pairwise(rest)) if i % 2 == 0 and pair[0] != pair[1]]
    if not pairs:
        return None
    fates = _fates(rows, cases["case"])
    columns = min(3, max(2, len(pairs)))
    n_rows = -(-len(pairs) // columns)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(n_rows, columns, squeeze=False).ravel()
        for panel, (x, y) in zip(panels, pairs, strict=False):
            _scatter(panel, _numbers(cases, x), _numbers(cases, y), fates)
            panel.set(xlabel=label(x), ylabel=label(y))
        for panel in panels[len(pairs) :]:
            panel.set_visible(False)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3)

    return to_png(draw, width_in=_WIDTH_IN, height_in=0.3 + 3.3 * n_rows)


def _fates(rows: pd.DataFrame, cases: "pd.Series[Any]") -> Any:
    """Whether each case is infeasible, flown for all detectors, or failed for one."""
    groups = rows["case"]
    infeasible = (rows["status"] == "infeasible").groupby(groups, sort=False).any()
    flown = (rows["status"] == "ok").groupby(groups, sort=False).all()
    fate = np.where(infeasible, "infeasible", np.where(flown, "flown", "failed"))
    return pd.Series(fate, index=infeasible.index).loc[cases].to_numpy(dtype=str)


def _scatter(axes: "Axes", x: Floats, y: Floats, fates: Any) -> None:
    looks: dict[str, dict[str, Any]] = {
        "flown": {"s": 11, "color": colour(0), "alpha": 0.45, "linewidths": 0},
        "infeasible": {"s": 20, "facecolors": "none", "edgecolors": INK, "linewidths": 0.8},
        "failed": {"s": 34, "marker": "x", "color": WARNING, "linewidths": 1.4},
    }
    for fate, look in looks.items():
        chosen = fates == fate
        axes.scatter(x[chosen], y[chosen], label=f"{fate} (n = {int(np.sum(chosen))})", zorder=3, **look)
    axes.tick_params(color=ORDINARY)


def _numbers(table: pd.DataFrame, column: str) -> Floats:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan)
