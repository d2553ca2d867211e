"""The clock: times in whole samples, and what to say of times that are none."""

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["misfit", "on_clock", "sample_numbers", "samples"]

_TOLERANCE_S = 1e-9


def samples(time_s: float, sample_s: float) -> int:
    """Time in whole samples, the nearest.

    >>> samples(0.1, 0.01)
    10
    """
    return round(time_s / sample_s)


def sample_numbers(time_s: Any, sample_s: float) -> npt.NDArray[np.float64]:
    """Times in whole samples, the nearest, as `samples` counts them; of the shape of the times."""
    counted: npt.NDArray[np.float64] = np.rint(np.asarray(time_s, dtype=float) / sample_s)
    return counted


def on_clock(time_s: float, sample_s: float) -> bool:
    """Whether a time falls on a sample, within 1e-9 s."""
    return abs(time_s - samples(time_s, sample_s) * sample_s) <= _TOLERANCE_S


def misfit(time_s: float, sample_s: float, *, least: int = 0) -> str:
    """What is wrong with a time that does not fit the clock, to be put behind its name; "" for one that does.

    Parameters
    ----------
    least : int
        Fewest samples that it may last.

    Examples
    --------
    >>> misfit(4.004, 0.01), misfit(4.0, 0.01)
    ('= 4.004 falls between two samples of 0.01 s; the nearest are 4 and 4.01 [s]', '')
    >>> misfit(0.004, 0.01, least=1)
    '= 0.004 is shorter than a sample of 0.01 s; the shortest is 0.01 [s]'
    """
    if time_s < least * sample_s - _TOLERANCE_S:
        shortest = f"{least * sample_s:.10g}"
        return f"= {time_s:.10g} is shorter than a sample of {sample_s:g} s; the shortest is {shortest} [s]"
    if on_clock(time_s, sample_s):
        return ""
    below = int(time_s / sample_s)
    near = f"{below * sample_s:.10g} and {(below + 1) * sample_s:.10g}"
    return f"= {time_s:.10g} falls between two samples of {sample_s:g} s; the nearest are {near} [s]"
