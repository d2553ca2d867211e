"""Pictures of all flights of a scenario: quantile bands over time, what the aircraft was asked for, what was declared."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fddbench.interfaces import Bands, Floats, Response
from fddbench.reporting.labels import label
from fddbench.reporting.names import TITLE, shortened
from fddbench.reporting.signals import signal_panels
from fddbench.reporting.svg.axes import Plot, linear
from fddbench.reporting.svg.palette import SERIES, band
from fddbench.reporting.svg.scene import Mark, Path, Scene, Text
from fddbench.reporting.svg.traces import Panel, panel_scene

__all__ = ["asked_of", "band_scenes", "band_sections", "names_in"]

_NUMBER = re.compile(r"_[0-9]+$")
_ENDS = ((0, 6), (1, 5), (2, 4))
"""Least to largest, 5 to 95 % and the middle half, by their places in `QUANTILES`."""
_MOST_POINTS = 60


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


def band_sections(bands: Sequence[Bands], responses: Sequence[Response], shown: Sequence[str]) -> list[dict[str, Any]]:
    """Pictures of each scenario, with what its caption says."""
    found = []
    for each in bands:
        scenes = band_scenes(each, asked_of(responses, each, shown))
        if scenes:
            found.append(
                {
                    "scenario": each.scenario,
                    "manoeuvre": each.manoeuvre.replace("_", " "),
                    "flights": each.flights,
                    "of": each.of,
                    "case": each.case,
                    "onset_s": each.onset_s,
                    "scenes": scenes,
                }
            )
    return found


def band_scenes(bands: Bands, panels: Sequence[Response]) -> list[Scene]:
    """A picture a signal, then for every detector what it shows with its threshold, and how many sites it declares."""
    found = [_response(bands, panel) for panel in panels]
    for number, (name, signals) in enumerate(bands.detectors.items()):
        first = next((panel for panel in signal_panels(signals) if panel != ["n_declared"]), [])
        found += [_shown(bands, name, first, number)] if first else []
        if bands.onset_s is not None or np.any(bands.declared[name][1:] > 0.0):
            found.append(_declared(bands, name))
    return found


def _label(name: str) -> str:
    """Label of an axis; the number of a row stands before the unit.

    >>> _label("r_deg_s_2"), _label("p_true_deg_s")
    ('r 2 [deg/s]', 'p true [deg/s]')
    """
    number = _NUMBER.search(name)
    words, unit, rest = label(f"p_{_NUMBER.sub('', name)}").partition(" [")
    return words + (number.group().replace("_", " ") if number else "") + unit + rest


def _bands(quantiles: Floats) -> list[tuple[Floats, Floats]]:
    return [(quantiles[low], quantiles[high]) for low, high in _ENDS]


def _response(bands: Bands, panel: Response) -> Scene:
    lines = [("ik", bands.one[panel.signal])]
    beside = [name for name in (panel.command, *panel.limits) if name in bands.one]
    own = [bands.signals[panel.signal], bands.one[panel.signal]]
    low, high = (
        float(f([f(each, initial=np.inf if f is np.nanmin else -np.inf) for each in own]))
        for f in (np.nanmin, np.nanmax)
    )
    for name in beside:
        room = 0.6 * (high - low)
        # a stick at its stop would flatten all: what is far away is cut
        near = np.where((bands.one[name] >= low - room) & (bands.one[name] <= high + room), bands.one[name], np.nan)
        if np.isfinite(near).any():
            lines.append(("prm" if name == panel.command else "wr", near))
    return panel_scene(
        Panel(
            title=_label(panel.signal), y_name="", time_s=bands.time_s, bands=_bands(bands.signals[panel.signal]), lines=lines,
            onset_s=bands.onset_s, look="b5",
        ),
        points=_MOST_POINTS,
    )  # fmt: skip


def _shown(bands: Bands, detector: str, names: Sequence[str], number: int) -> Scene:
    signals, title = bands.detectors[detector], shortened(bands.detectors, TITLE)[detector]
    lines = [("ik", signals[names[0]][3])]
    for name in names[1:]:
        lines += [
            ("thr", sign * signals[name][3]) for sign in ((1.0, -1.0) if np.nanmin(signals[names[0]]) < 0.0 else (1.0,))
        ]
    if names[0] == "residual":
        lines.append(("thr", np.ones_like(bands.time_s)))
    return panel_scene(
        Panel(
            title=title, y_name=_label(names[0]), time_s=bands.time_s, bands=_bands(signals[names[0]]), lines=lines,
            onset_s=bands.onset_s, look=band(number % SERIES),
        ),
        points=_MOST_POINTS,
    )  # fmt: skip


def _declared(bands: Bands, detector: str) -> Scene:
    """Shares of flights that declare none, one, two, … sites, stacked."""
    shares: Mapping[int, Floats] = dict(enumerate(bands.declared[detector]))
    plot = Plot(50, 18, 264, 100, linear(float(bands.time_s[0]), float(bands.time_s[-1]), 6), linear(0.0, 100.0, 3))
    marks: list[Mark] = []
    bottom = np.zeros_like(bands.time_s)
    for count, share in shares.items():
        top = np.minimum(bottom + 100.0 * share, 100.0)
        corners = [*_stepped(plot, bands.time_s, top), *reversed(_stepped(plot, bands.time_s, bottom))]
        marks.append(Path(corners, _COUNTS[min(count, len(_COUNTS) - 1)], closed=True))
        bottom = top
    names = ", ".join(f"{count}" for count in shares)
    title = f"{shortened(bands.detectors, TITLE // 2)[detector]} declares {names} sites"
    marks += [Text(50, 12, title, bold=True), *plot.frame("", "flights [%]")]
    if bands.onset_s is not None:
        marks.append(plot.upright(bands.onset_s, "on"))
    return Scene(330, 140, f"Share of flights in which {detector} declares {names} sites, over time", marks)


_COUNTS = ("o2", "o3", "o0", "o4", "o5")
"""Looks of 0, 1, 2, 3 and more declared sites."""


def _stepped(plot: Plot, time_s: Floats, values: Floats) -> list[tuple[float, float]]:
    """Corners of a step curve where it changes."""
    kept = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    points = []
    before = float(values[0])
    for i in kept.tolist():
        points += [*plot.at(float(time_s[i]), before), *plot.at(float(time_s[i]), float(values[i]))]
        before = float(values[i])
    return points + plot.at(float(time_s[-1]), before)
