"""The smallest thresholds that keep a target with an equal number of flights beyond each residual."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Tuned", "held_peaks", "tuned"]

Kept = Callable[[npt.NDArray[np.bool_]], bool]
"""Whether flights that alarm, (n_flights,), are few enough."""


@dataclass(frozen=True)
class Tuned:
    """Thresholds, and how many of the flights they were chosen on alarm with them."""

    thresholds: tuple[float, ...]
    alarms: int
    flights: int


def held_peaks(signal: Floats, confirm_samples: int) -> Floats:
    """Largest threshold, (n_cases,), at which |signal|, (n_time, n_cases), would still alarm.

    That is the maximum over time of the minimum over ``confirm_samples + 1`` samples: a level that is exceeded for the
    whole confirmation time. Zero for a signal too short to alarm.
    """
    if len(signal) <= confirm_samples:
        return np.zeros(signal.shape[1])
    held = np.lib.stride_tricks.sliding_window_view(np.abs(signal), confirm_samples + 1, axis=0).min(axis=-1)
    peaks: Floats = np.fmax.reduce(held, axis=0)  # a flight that has ended shows no number
    return peaks


def tuned(peaks: Floats, kept: Kept) -> Tuned:
    """Thresholds with which few enough flights alarm in any residual.

    Every residual gets the same number of flights beyond its threshold, so that no residual pays for another; of these
    numbers the largest is taken that is few enough, from none on. Each threshold is the peak of a flight, which itself does
    not alarm.

    Parameters
    ----------
    peaks : (n_flights, n_residuals) array
        As `held_peaks` gives them.
    kept : callable
        Says of flights that alarm, (n_flights,), whether they are few enough; no alarm is.

    Examples
    --------
    >>> tuned(np.array([[1.0], [4.0], [3.0], [2.0]]), lambda alarm: alarm.sum() <= 1)
    Tuned(thresholds=(3.0,), alarms=1, flights=4)
    """
    n = len(peaks)
    descending = -np.sort(-peaks, axis=0)
    best = Tuned(tuple(descending[0].tolist()), 0, n)
    for beyond in range(1, n):
        thresholds = descending[beyond]
        alarm = np.any(peaks > thresholds, axis=1)
        if not kept(alarm):
            break
        best = Tuned(tuple(thresholds.tolist()), int(alarm.sum()), n)
    if min(best.thresholds) <= 0.0:
        raise DesignError("a residual stays at zero in every flight: there is nothing to choose a threshold from")
    return best
