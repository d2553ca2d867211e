"""Operating curves as pictures: false alarms per hour against what is missed and against delay, fault by fault."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.formats import rate
from fddbench.reporting.svg.axes import Plot, Scale, linear, logarithmic
from fddbench.reporting.svg.scene import Dot, Mark, Path, Scene, Text

__all__ = ["MEASURES", "operating_scene", "operating_scenes"]

_MOST_SCENARIOS = 12
MEASURES = {"missed": "missed or late [%]", "delay": "median delay [s]"}
"""What stands over false alarms per hour, in words."""


def operating_scenes(curves: pd.DataFrame) -> list[dict[str, Any]]:
    """By swept gain its title, and two pictures a scenario: missed or late, and median delay, over false alarms per hour.

    Parameters
    ----------
    curves : DataFrame
        Lines of `fddbench.metrics.operating.OPERATING`.
    """
    found = []
    for (design, gain, factor), own in curves.groupby(["design", "gain", "factor"], sort=False):
        scenarios = list(own["scenario"].unique())[:_MOST_SCENARIOS]
        scenes = [operating_scene(own, str(name), measure) for name in scenarios for measure in MEASURES]
        title = f"{design}, {'factor on ' if factor else ''}{gain}"
        found.append({"title": title, "scenes": [scene for scene in scenes if scene is not None]})
    return found


def operating_scene(curve: pd.DataFrame, scenario: str, measure: str) -> Scene | None:
    """One curve of one scenario; None where no point can be placed."""
    own = curve[np.asarray(curve["scenario"] == scenario, dtype=bool)]
    x, x_low, x_high = (_column(own, f"false_alarm_{end}per_hour") for end in ("", "low_", "high_"))
    if measure == "missed":
        y, y_low, y_high = (_column(own, f"missed{end}_percent") for end in ("", "_low", "_high"))
    else:
        y = _column(own, "detection_time_median_s")
        y_low = y_high = np.full(len(y), np.nan)
    known = np.isfinite(x) & np.isfinite(y)
    if not known.any():
        return None
    plot = Plot(50, 26, 290, 130, _rates(x[known]), _heights(y[known], measure))
    marks: list[Mark] = [
        Text(50, 14, scenario, bold=True),
        *plot.frame(f"false alarms per hour{_scale(plot.x)}", MEASURES[measure]),
    ]
    marks.append(Path(plot.at(x[known], y[known]), "s0"))
    for i in np.flatnonzero(known).tolist():
        marks += _cross(plot, (x[i], x_low[i], x_high[i]), (y[i], y_low[i], y_high[i]))
    designed = own["as_designed"].to_numpy(dtype=bool)
    values = _column(own, "value")
    for i in np.flatnonzero(known).tolist():
        ((px, py),) = plot.at(x[i], y[i])
        said = f"{rate(values[i])}: {rate(x[i])} per hour, {rate(y[i])}"
        marks.append(Dot(px, py, "d0", 3.0, title=said))
        if designed[i]:
            marks.append(Dot(px, py, "ci", 6.5, title=f"as designed, {said}"))
    return Scene(352, 196, f"{MEASURES[measure]} against false alarms per hour in {scenario}", marks)


def _scale(x: Scale) -> str:
    return ", log (left end: none)" if x.log else ""


def _rates(x: Floats) -> Scale:
    """Rates over decades, those of 0 at the left end."""
    some = x[x > 0.0]
    if not len(some):
        return linear(0.0, 1.0)
    low, high = float(some.min()), float(some.max())
    return (
        logarithmic(low / 3.0, high * 2.0, 6) if high > 5.0 * low or len(some) < len(x) else linear(0.0, high * 1.15, 5)
    )


def _heights(y: Floats, measure: str) -> Scale:
    if measure == "missed":
        return Scale(0.0, 100.0, (0.0, 25.0, 50.0, 75.0, 100.0))
    return linear(0.0, float(y.max()) * 1.15 or 1.0, 5)


def _cross(plot: Plot, x: Sequence[float], y: Sequence[float]) -> list[Mark]:
    """95 % intervals of both, thin."""
    marks: list[Mark] = []
    if np.isfinite(x[1]) and np.isfinite(x[2]):
        marks.append(Path(plot.at(np.array([x[1], x[2]]), np.array([y[0], y[0]])), "n0"))
    if np.isfinite(y[1]) and np.isfinite(y[2]):
        marks.append(Path(plot.at(np.array([x[0], x[0]]), np.array([y[1], y[2]])), "n0"))
    return marks


def _column(table: pd.DataFrame, name: str) -> Floats:
    values: Floats = table[name].to_numpy(dtype=np.float64, na_value=np.nan)
    return values
