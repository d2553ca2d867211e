"""The pictures of a cell: share found over time, shares over parts of a parameter, and the stacked bar of outcomes."""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.interfaces import Floats
from fddbench.metrics.incidence import Incidence
from fddbench.reporting.formats import interval
from fddbench.reporting.names import shortened
from fddbench.reporting.svg.axes import Plot, Scale, linear, logarithmic
from fddbench.reporting.svg.palette import OUTCOME_LOOKS, band, series
from fddbench.reporting.svg.scene import Box, Dot, Mark, Path, Scene, Text

__all__ = ["Parted", "bar_marks", "incidence_scene", "legend", "parts_scene", "time_scale"]

_PERCENT = Scale(0.0, 100.0, (0.0, 25.0, 50.0, 75.0, 100.0))
Parted = Sequence[tuple[str, int, int, float, float]]
"""Parts of a parameter: what it is called, hits, flights, ends of the interval [-] (NaN: none)."""


def bar_marks(
    counts: Mapping[str, int], ends: tuple[float, float] | None, *, x: float, y: float, width: float, height: float
) -> list[Mark]:
    """Exclusive outcomes side by side, and the interval of the first below, over the decided part.

    Parameters
    ----------
    counts : mapping of str to int
        Flights by outcome.
    ends : (low, high) or None
        Interval of the share of the decided flights that are right, or of the healthy that are quiet [-].
    """
    total = sum(counts.values())
    marks: list[Mark] = []
    if not total:
        return [Box(x, y, width, height, "no")]
    order = [name for name in OUTCOME_LOOKS if name != "undecided"] + ["undecided"]
    at = x
    for name in order:
        if counts.get(name):
            part = width * counts[name] / total
            marks.append(Box(at, y, part, height, OUTCOME_LOOKS[name]))
            at += part
    sure = width * (total - counts.get("undecided", 0)) / total
    if ends is not None and sure > 0.0:
        low, high = (x + sure * end for end in ends)
        marks.append(Path([(low, y + height + 3), (max(high, low + 1.0), y + height + 3)], "ci"))
    return marks


def time_scale(times: Sequence[float], limit_s: float) -> Scale:
    """Axis of times after the onset; logarithmic where they lie far apart."""
    known = [t for t in (*times, limit_s) if np.isfinite(t) and t > 0.0]
    if not known:
        return linear(0.0, 1.0)
    low, high = min(known), max(known)
    return logarithmic(low / 1.6, high * 1.3) if high > 20.0 * low else linear(0.0, high * 1.1)


def incidence_scene(
    curves: Mapping[str, tuple[int, Incidence]], limit_s: float, *, scenario: str, wrong_of: str = ""
) -> Scene:
    """Share of all flights found by each time, a step curve with its band for every detector.

    Parameters
    ----------
    curves : mapping of str to (int, Incidence)
        By detector its number, which is its colour, and its shares.
    limit_s : float
        Detection time limit [s]; NaN: none.
    scenario : str
        Its name, for the label.
    wrong_of : str
        Detector whose healthy sites declared are drawn too: the competing outcome.
    """
    width, rows = 560.0, -(-len(curves) // 2)
    times = [t for _, own in curves.values() for t in own.time_s.tolist()]
    plot = Plot(46, 10, width - 60, 205, time_scale(times, limit_s), _PERCENT)
    marks = plot.frame(f"time after onset [s]{', log' if plot.x.log else ''}", "flights [%]")
    if np.isfinite(limit_s):
        marks.append(plot.upright(limit_s, "lim"))
    for number, own in curves.values():
        marks += _curve(plot, own, number)
    if wrong_of in curves:
        own = curves[wrong_of][1]
        if own.wrong.any():
            marks.append(Path(_steps(plot, own, own.wrong / max(own.flights, 1)), "wr"))
    names = {name: number for name, (number, _) in curves.items()}
    marks += legend(names, x=46, y=264, width=width - 60)
    return Scene(width, 262 + 17 * rows, f"Share of all flights of {scenario} found by each time", marks)


def legend(names: Mapping[str, int], *, x: float, y: float, width: float) -> list[Mark]:
    """Line and name of each detector, two in a row."""
    short = shortened(names, int(width / 2 / 6.6) - 6)
    marks: list[Mark] = []
    for i, (name, number) in enumerate(names.items()):
        left, top = x + (i % 2) * width / 2, y + 17 * (i // 2)
        marks += [Path([(left, top - 4), (left + 24, top - 4)], series(number)), Text(left + 30, top, short[name])]
    return marks


def _steps(plot: Plot, own: Incidence, share: Floats) -> list[tuple[float, float]]:
    """Corners of a step curve from the onset to where everything is seen."""
    start = plot.x.low
    points = plot.at(start, 0.0)
    before = 0.0
    for time_s, value in zip(own.time_s.tolist(), (100.0 * share).tolist(), strict=True):
        points += [*plot.at(time_s, before), *plot.at(time_s, value)]
        before = value
    return points + plot.at(max(own.end_s, start), before)


def _curve(plot: Plot, own: Incidence, number: int) -> list[Mark]:
    if not own.flights:
        return []
    marks: list[Mark] = []
    if len(own.time_s) and not np.isnan(own.low).any():
        ends = [*own.time_s[1:].tolist(), own.end_s]
        up, down = [], []
        for begin, end, low, high in zip(own.time_s.tolist(), ends, own.low.tolist(), own.high.tolist(), strict=True):
            up += [*plot.at(begin, 100.0 * high), *plot.at(end, 100.0 * high)]
            down += [*plot.at(begin, 100.0 * low), *plot.at(end, 100.0 * low)]
        marks.append(Path([*up, *reversed(down)], band(number), closed=True))
    return [*marks, Path(_steps(plot, own, own.found / own.flights), series(number))]


def parts_scene(parts: Parted, *, name: str, label: str, number: int = 0, what: str = "failed [%]") -> Scene:
    """Shares over the parts of a parameter with their intervals, and k/n below each."""
    width, n = max(300.0, 52.0 * len(parts) + 50.0), len(parts)
    plot = Plot(46, 8, width - 56, 96, linear(0.0, float(n)), Scale(0.0, 100.0, (0.0, 50.0, 100.0)))
    marks = plot.frame("", what, x_ticks=False)
    for i, (called, hits, flights, low, high) in enumerate(parts):
        if flights:
            x, y = plot.at(i + 0.5, 100.0 * hits / flights)[0]
            if np.isfinite(low):
                ends = [plot.at(i + 0.5, 100.0 * end)[0] for end in (low, high)]
                marks.append(Path(ends, f"e{number % 8}"))
            ends_text = interval(100.0 * low, 100.0 * high) if np.isfinite(low) else "no interval"
            marks.append(Dot(x, y, f"d{number % 8}", title=f"{hits} of {flights}: {ends_text}"))
        x = plot.at(i + 0.5, 0.0)[0][0]
        marks += [
            Text(x, 119, called, anchor="middle", size=10),
            Text(x, 133, f"{hits}/{flights}", "ts", "middle", size=10),
        ]
    marks.append(Text(46 + (width - 56) / 2, 149, name, anchor="middle"))
    return Scene(width, 155, label, marks)
