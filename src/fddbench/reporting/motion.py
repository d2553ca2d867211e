"""Pictures of manoeuvres: how the flights of a healthy scenario move, as bands over all that were flown again."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fddbench.interfaces import Floats, Recording
from fddbench.reporting.pictures import colour, thinned, to_png
from fddbench.units import suffix_of_name, unit_of_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["bands", "motion_picture"]

_COLUMNS = 4
_SHARES = (0.0, 0.05, 0.5, 0.95, 1.0)


def bands(values: Floats) -> Floats:
    """Smallest, 5 %, middle, 95 % and largest value at every time, (5, n_time), of those flights that still fly.

    Parameters
    ----------
    values : (n_time, n_cases) array
        A signal; not-a-number after the end of a flight.
    """
    found = np.full((len(_SHARES), len(values)), np.nan)
    flying = ~np.isnan(values).all(axis=1)
    found[:, flying] = np.nanquantile(values[flying], _SHARES, axis=1)
    return found


def motion_picture(recording: Recording, names: Sequence[str]) -> str | None:
    """Picture of the signals `names` of a recording, a panel each; None where it has none of them."""
    shown = [name for name in names if name in recording.signals]
    if not shown or not recording.cases:
        return None
    n_rows = -(-len(shown) // _COLUMNS)

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(n_rows, _COLUMNS, squeeze=False).ravel()
        for axes, name in zip(panels, shown, strict=False):
            _panel(axes, recording, name)
        for axes in panels[len(shown) :]:
            axes.set_visible(False)

    return to_png(draw, width_in=11.4, height_in=1.75 * n_rows)


def _panel(axes: "Axes", recording: Recording, name: str) -> None:
    values = recording.signals[name]
    if name.endswith("_deg"):
        values = np.unwrap(values, period=360.0, axis=0)  # a heading goes on beyond half a turn
    time_s, lines = thinned(recording.time_s, bands(values).T)
    lowest, low, middle, high, highest = lines.T
    axes.fill_between(time_s, lowest, highest, color=colour(0), alpha=0.15, lw=0)
    axes.fill_between(time_s, low, high, color=colour(0), alpha=0.30, lw=0)
    axes.plot(time_s, middle, color=colour(0), lw=1.2)
    axes.set(title=_title(name), xlabel="time [s]", xlim=(time_s[0], time_s[-1]))


def _title(name: str) -> str:
    """Signal and unit; a ``p`` is a roll rate here, not the beginning of a parameter's column.

    >>> _title("p_true_deg_s"), _title("mach")
    ('p [deg/s]', 'mach')
    """
    unit, suffix = unit_of_name(name), suffix_of_name(name)
    words = name.removesuffix(suffix).replace("_true", "").replace("_", " ")
    return f"{words} [{unit}]" if suffix else words
