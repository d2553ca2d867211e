"""Scales, ticks and the frame of a plot."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.interfaces import Floats
from fddbench.reporting.svg.scene import Mark, Path, Text

__all__ = ["Plot", "Scale", "linear", "logarithmic", "ticks_text", "ticks_texts"]


_MOST_DIGITS = 9


@dataclass(frozen=True)
class Scale:
    """An axis: its ends, whether it is logarithmic, where it has ticks."""

    low: float
    high: float
    ticks: Sequence[float]
    log: bool = False

    def place(self, values: Floats | float) -> Floats:
        """Share of the axis of values [-], what lies outside at its ends."""
        x = np.clip(np.asarray(values, dtype=np.float64), self.low, self.high)
        if self.log:
            found: Floats = np.log(x / self.low) / np.log(self.high / self.low)
        else:
            found = (x - self.low) / (self.high - self.low)
        return found


def linear(low: float, high: float, most: int = 7) -> Scale:
    """Axis from low to high with at most so many round ticks.

    >>> linear(0.0, 10.0, 6).ticks
    [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    """
    if not high > low:
        room = max(abs(low), 1.0) * 0.5
        low, high = low - room, high + room
    raw = (high - low) / max(most - 1, 1)
    power = 10.0 ** np.floor(np.log10(raw))
    step = next(m * power for m in (1, 2, 2.5, 5, 10) if m * power >= raw * 0.999)
    first = np.ceil(low / step - 1e-9)
    ticks = [round(float(step * (first + i)), 12) for i in range(int(np.floor(high / step + 1e-9) - first) + 1)]
    return Scale(low, high, ticks)


def logarithmic(low: float, high: float, most: int = 8) -> Scale:
    """Axis with ticks at 1, 2 and 5 of each decade, of too many at the decades."""
    decades = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    for steps in ((1, 2, 5), (1, 3), (1,)):
        ticks = [t for e in decades for m in steps if low <= (t := float(f"{m * 10.0**e:.12g}")) <= high]
        if len(ticks) <= most:
            break
    return Scale(low, high, ticks, log=True)


def ticks_text(value: float, digits: int = 3) -> str:
    """Tick in words: three digits, thousands as k.

    >>> ticks_text(22500.0), ticks_text(0.25), ticks_text(100.0)
    ('22.5k', '0.25', '100')
    """
    if abs(value) >= 10000.0:
        return f"{value / 1000.0:.{digits + 1}g}k"
    return f"{value:.{digits + 1}g}" if abs(value) >= 1000.0 else f"{value:.{digits}g}"


def ticks_texts(values: Sequence[float]) -> list[str]:
    """Ticks in words, with as many digits as it takes that different ones never look alike.

    >>> ticks_texts([248.1, 248.4, 249.0]), ticks_texts([1.0, 2.0])
    (['248.1', '248.4', '249'], ['1', '2'])
    """
    for digits in range(3, _MOST_DIGITS):
        found = [ticks_text(value, digits) for value in values]
        if len(set(found)) == len(set(values)):
            return found
    return [ticks_text(value) for value in values]  # they differ by rounding


@dataclass(frozen=True)
class Plot:
    """The inside of a plot [px] and its scales."""

    left: float
    top: float
    width: float
    height: float
    x: Scale
    y: Scale

    def at(self, x: Floats | float, y: Floats | float) -> list[tuple[float, float]]:
        """Points [px] of values, (n,) each."""
        px = self.left + self.width * np.atleast_1d(self.x.place(x))
        py = self.top + self.height * (1.0 - np.atleast_1d(self.y.place(y)))
        px, py = np.broadcast_arrays(px, py)
        return list(zip(px.tolist(), py.tolist(), strict=True))

    def frame(self, x_title: str, y_title: str, *, x_ticks: bool = True) -> list[Mark]:
        """Grid lines, ticks and titles."""
        right, bottom = self.left + self.width, self.top + self.height
        marks: list[Mark] = []
        for tick in self.y.ticks:
            y = self.at(self.x.low, tick)[0][1]
            marks += [
                Path([(self.left, y), (right, y)], "gl"),
                Text(self.left - 5, y + 4, ticks_text(tick), "ts", "end"),
            ]
        marks.append(Path([(self.left, bottom), (right, bottom)], "ax"))
        for tick in self.x.ticks if x_ticks else ():
            x = self.at(tick, self.y.low)[0][0]
            marks += [
                Path([(x, bottom), (x, bottom + 4)], "ax"),
                Text(x, bottom + 16, ticks_text(tick), "ts", "middle"),
            ]
        if x_title:
            marks.append(Text(self.left + self.width / 2, bottom + (31 if x_ticks else 16), x_title, "ts", "middle"))
        if y_title:
            marks.append(Text(11, self.top + self.height / 2, y_title, "ts", "middle", turned=True))
        return marks

    def upright(self, x: float, look: str) -> Path:
        """A line over the whole height."""
        px = self.at(x, self.y.low)[0][0]
        return Path([(px, self.top), (px, self.top + self.height)], look)
