"""A channel on the clock of a flight, the largest gap in it, and how far off the samples between its rows may be."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fddbench.benchmarks.recorded.reading import Series
from fddbench.interfaces import Floats

__all__ = ["OnClock", "largest_gap", "on_clock"]

Between = Literal["previous", "linear"]
_CLOSE = 1e-6
"""Of a sample: a row that lies so close to one is read at it."""


@dataclass(frozen=True, eq=False)
class OnClock:
    """Samples of a channel.

    Attributes
    ----------
    values : (n_samples,) array
        In the unit of the series.
    between : int
        Samples that fall between two rows.
    rms, largest : float
        Estimated error of those [unit of the series]; 0 where every sample has a row of its own. Of what is held: the straight
        line between the rows less the row before. Of what is straight: a quarter of how far each row lies off the line between
        its neighbours, the error of a parabola. Noise of the log is in both.
    unused : int
        Rows that no sample shows.
    """

    values: Floats
    between: int
    rms: float
    largest: float
    unused: int


def on_clock(series: Series, begin_s: float, n_samples: int, sample_s: float, between: Between) -> OnClock:
    """Samples 0, 1, … of a flight that begins at a time of the log, which covers all of them."""
    time_s, values = series.time_s, series.values
    at_s = begin_s + np.arange(n_samples) * sample_s
    close_s = _CLOSE * sample_s
    row = np.maximum(np.searchsorted(time_s, at_s + close_s, side="right") - 1, 0)
    after = np.minimum(row + 1, len(time_s) - 1)
    off = (at_s - time_s[row] > close_s) & (after > row)
    width_s = np.where(after > row, time_s[after] - time_s[row], 1.0)
    step = np.where(off, (at_s - time_s[row]) / width_s, 0.0) * (values[after] - values[row])
    straight = np.where(off, values[row] + step, values[row])
    error = step if between == "previous" else np.where(off, _curved(time_s, values, row, after), 0.0)
    wrong = np.abs(error[off])
    return OnClock(
        values=straight if between == "linear" else values[row],
        between=int(off.sum()),
        rms=float(np.sqrt(np.mean(wrong**2))) if len(wrong) else 0.0,
        largest=float(wrong.max(initial=0.0)),
        unused=int(row[-1] - row[0] + 1 - len(np.unique(row))),
    )


def _curved(time_s: Floats, values: Floats, row: np.ndarray, after: np.ndarray) -> Floats:
    """A quarter of the larger of what the rows at both ends lie off the lines between their neighbours."""
    inner = np.zeros(len(values))
    if len(values) > 2:
        share = (time_s[1:-1] - time_s[:-2]) / (time_s[2:] - time_s[:-2])
        inner[1:-1] = values[1:-1] - (values[:-2] + share * (values[2:] - values[:-2]))
    error: Floats = 0.25 * np.maximum(np.abs(inner[row]), np.abs(inner[after]))
    return error


def largest_gap(series: Series, begin_s: float, end_s: float) -> tuple[float, int]:
    """Longest time between two rows that a stretch of the log needs [s], and the row after it."""
    first = max(int(np.searchsorted(series.time_s, begin_s, side="right")) - 1, 0)
    last = max(min(int(np.searchsorted(series.time_s, end_s)), len(series.time_s) - 1), first + 1)
    gaps = np.diff(series.time_s[first : last + 1])
    at = int(np.argmax(gaps))
    return float(gaps[at]), first + 1 + at
