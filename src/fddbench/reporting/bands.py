"""Pictures of all flights of a scenario: quantile bands over time, what the aircraft was asked for, what was declared."""

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fddbench.interfaces import Bands, Floats, Response
from fddbench.reporting.figures import label
from fddbench.reporting.pictures import INK, MUTED, WARNING, colour, to_png
from fddbench.reporting.signals import signal_panels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["asked_of", "band_picture", "band_pictures", "names_in"]

_COLUMNS = 4
_COUNTS = ("#cfd8e3", "#e69f00", "#0072b2", "#b3261e", "#7b5ea7")
"""Colours of 0, 1, 2, 3 and more declared sites."""
_NUMBER = re.compile(r"_[0-9]+$")


def names_in(responses: Sequence[Response], shown: Sequence[str]) -> frozenset[str]:
    """Signals that the panels need, with and without the number of a row."""
    asked = {name for panel in responses for name in (panel.signal, panel.command, *panel.limits) if name}
    return frozenset({*asked, *shown, *(_NUMBER.sub("", name) for name in (*asked, *shown))})


def asked_of(responses: Sequence[Response], bands: Bands, shown: Sequence[str]) -> list[Response]:
    """Panels of a scenario: of healthy flights what the plant says, else what the benchmark shows; those that were recorded."""
    rows = [name for full in shown for name in bands.signals if name == full or _NUMBER.sub("", name) == full]
    plain = [Response(signal=name) for name in dict.fromkeys(rows)]
    panels = list(responses) if bands.onset_s is None and responses else plain
    return [panel for panel in panels if panel.signal in bands.signals]


def band_pictures(bands: Sequence[Bands], responses: Sequence[Response], shown: Sequence[str]) -> list[dict[str, Any]]:
    """One picture a scenario, with what its caption says."""
    found = []
    for each in bands:
        png = band_picture(each, asked_of(responses, each, shown))
        if png is not None:
            found.append(
                {
                    "scenario": each.scenario,
                    "manoeuvre": each.manoeuvre.replace("_", " "),
                    "flights": each.flights,
                    "of": each.of,
                    "case": each.case,
                    "onset_s": each.onset_s,
                    "png": png,
                }
            )
    return found


def band_picture(bands: Bands, panels: Sequence[Response]) -> str | None:
    """Panels of signals, then for every detector what it shows, with its threshold, and how many sites it declares.

    Of healthy flights detectors take a line each; of faulty ones the declarations matter most.
    """
    lines = _detector_panels(bands)
    columns = _COLUMNS if panels or len(lines) > 1 else max(len(lines), 1)
    n_rows = -(-len(panels) // columns) + -(-len(lines) // columns)
    if not n_rows:
        return None

    def draw(figure: "Figure") -> None:
        grid = figure.add_gridspec(n_rows, columns)
        for i, panel in enumerate(panels):
            _draw_response(figure.add_subplot(grid[i // columns, i % columns]), bands, panel)
        begin = columns * -(-len(panels) // columns)
        for i, (number, detector, names) in enumerate(lines, start=begin):
            axes = figure.add_subplot(grid[i // columns, i % columns])
            if names:
                _draw_shown(axes, bands, detector, names, number)
            else:
                _draw_declared(axes, bands, detector, number)

    return to_png(draw, width_in=11.4, height_in=0.1 + 1.75 * n_rows)


def _detector_panels(bands: Bands) -> list[tuple[int, str, list[str]]]:
    """Number and name of the detector of each panel, and its signals; none: what it declares."""
    found = []
    for number, (name, signals) in enumerate(bands.detectors.items()):
        first = next((panel for panel in signal_panels(signals) if panel != ["n_declared"]), [])
        found += [(number, name, first)] if first else []
        found += [(number, name, [])] if bands.onset_s is not None or np.any(bands.declared[name][1:] > 0.0) else []
    return found


def _label(name: str) -> str:
    """Label of an axis; the number of a row stands before the unit.

    >>> _label("r_deg_s_2"), _label("p_true_deg_s")
    ('r 2 [deg/s]', 'p true [deg/s]')
    """
    number = _NUMBER.search(name)
    words, unit, rest = label(f"p_{_NUMBER.sub('', name)}").partition(" [")
    return words + (number.group().replace("_", " ") if number else "") + unit + rest


def _fill(axes: "Axes", time_s: Floats, quantiles: Floats, tone: str) -> None:
    """Least to largest pale, 5 to 95 % and the middle half darker, the median as a line."""
    for low, high, alpha in ((0, 6, 0.13), (1, 5, 0.2), (2, 4, 0.3)):
        axes.fill_between(time_s, quantiles[low], quantiles[high], color=tone, alpha=alpha, linewidth=0)
    axes.plot(time_s, quantiles[3], color=tone, lw=0.9)


def _draw_response(axes: "Axes", bands: Bands, panel: Response) -> None:
    _fill(axes, bands.time_s, bands.signals[panel.signal], "#56789a")
    axes.plot(bands.time_s, bands.one[panel.signal], color=INK, lw=1.2)
    low, high = axes.get_ylim()
    beside = [name for name in (panel.command, *panel.limits) if name in bands.one]
    for name in beside:
        look: dict[str, Any] = {"color": WARNING, "lw": 1.0, "ls": (0, (1, 1))}
        if name == panel.command:
            look = {"color": "#d55e00", "lw": 1.1, "ls": (0, (4, 2))}
        axes.plot(bands.time_s, bands.one[name], **look)
    axes.set_ylim(*_within(low, high, [bands.one[name] for name in beside]))
    axes.set(ylabel=_label(panel.signal), xlabel="time [s]")
    _frame(axes, bands)


def _within(low: float, high: float, others: Sequence[Floats]) -> tuple[float, float]:
    """Ends of an axis with commands and limits where they are near: a stick at its stop would flatten all."""
    room = 0.6 * (high - low)
    near = [
        value for other in others for value in (np.nanmin(other), np.nanmax(other)) if low - room < value < high + room
    ]
    return float(min([low, *near])), float(max([high, *near]))


def _draw_shown(axes: "Axes", bands: Bands, detector: str, names: Sequence[str], number: int) -> None:
    signals = bands.detectors[detector]
    _fill(axes, bands.time_s, signals[names[0]], colour(number))
    for name in names[1:]:
        for sign in (1.0, -1.0) if np.nanmin(signals[names[0]]) < 0.0 else (1.0,):
            axes.plot(bands.time_s, sign * signals[name][3], color=INK, lw=1.0, ls=(0, (4, 2)))
    if names[0] == "residual":
        axes.axhline(1.0, color=INK, ls=(0, (4, 2)), lw=1.0)
    axes.set(ylabel=_label(names[0]), xlabel="time [s]")
    axes.set_title(detector, color=colour(number))
    _frame(axes, bands)


def _draw_declared(axes: "Axes", bands: Bands, detector: str, number: int) -> None:
    """Shares of flights that declare none, one, two, … sites, stacked."""
    shares: Mapping[int, Floats] = dict(enumerate(bands.declared[detector]))
    bottom = np.zeros_like(bands.time_s)
    for count, share in shares.items():
        top = bottom + 100.0 * share
        axes.fill_between(
            bands.time_s, bottom, top, color=_COUNTS[min(count, 4)], linewidth=0, step="post", label=str(count)
        )
        bottom = top
    axes.set(ylim=(0, 100), yticks=(0, 50, 100), ylabel="flights [%]", xlabel="time [s]")
    axes.set_title("declares", color=colour(number))
    axes.grid(visible=False)
    axes.legend(
        loc="lower right", ncols=len(shares), handlelength=0.8, columnspacing=0.7, frameon=True, framealpha=0.75
    )
    _frame(axes, bands)


def _frame(axes: "Axes", bands: Bands) -> None:
    axes.set_xlim(float(bands.time_s[0]), float(bands.time_s[-1]))
    if bands.onset_s is not None:
        axes.axvline(bands.onset_s, color=MUTED, lw=0.9, ls=":")
