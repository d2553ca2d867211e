"""When the faults of a scenario begin and end on each site, in whole samples; per flight where that is drawn."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from fddbench.faults.varied import Varied, bounds
from fddbench.interfaces import NEVER, Fault, Floats

__all__ = [
    "NEVER",
    "first_samples",
    "last_sample",
    "latest_onset_s",
    "misfit",
    "on_clock",
    "onset_bounds_s",
    "sample_numbers",
    "samples",
]

_CLOCK_TOLERANCE_S = 1e-9


def samples(time_s: float, sample_s: float) -> int:
    """Time in whole samples, the nearest."""
    return round(time_s / sample_s)


def sample_numbers(time_s: Any, sample_s: float) -> Floats:
    """Times in whole samples, the nearest, as `samples` counts them; of the shape of the times."""
    counted: Floats = np.rint(np.asarray(time_s, dtype=float) / sample_s)
    return counted


def first_samples(fault: Fault, sites: Sequence[str], sample_s: float) -> list[Any]:
    """First faulty sample of every one of these sites, a number or (n_cases,); `NEVER` for those the fault leaves alone."""
    onset = {site: fault.onset_s + fault.delay_s * nth for nth, site in enumerate(fault.sites)}
    return [sample_numbers(onset[site], sample_s) if site in onset else NEVER for site in sites]


def last_sample(fault: Fault, sample_s: float) -> Any:
    """Last faulty sample, a number or (n_cases,); `NEVER` for a fault that stays."""
    return NEVER if fault.end_s is None else sample_numbers(fault.end_s, sample_s) - 1.0


def onset_bounds_s(fault: Fault, nth: int) -> tuple[float, float]:
    """Earliest and latest time at which the nth of its sites turns faulty [s]."""
    (first, last), delay = bounds(fault.onset_s), bounds(fault.delay_s)
    return first + delay[0] * nth, last + delay[1] * nth


def latest_onset_s(fault: Fault) -> float:
    """Latest time at which the last site of a fault turns faulty [s]."""
    return onset_bounds_s(fault, len(fault.sites) - 1)[1]


def on_clock(time_s: float, sample_s: float) -> bool:
    """Whether a time falls on a sample, within 1e-9 s."""
    return abs(time_s - samples(time_s, sample_s) * sample_s) <= _CLOCK_TOLERANCE_S


def misfit(value: Any, sample_s: float, *, least: int = 0) -> Iterator[str]:
    """What is wrong with times that do not fit the clock, "… = 4.004 falls between …" without the name of the key.

    Parameters
    ----------
    value : float, Varied or None
        A time as it is written [s]; what varies is looked at number by number.
    least : int
        Fewest samples that it may last.
    """
    for time_s in value.written if isinstance(value, Varied) else () if value is None else (value,):
        if time_s < least * sample_s - _CLOCK_TOLERANCE_S:
            yield f"= {time_s:g} is shorter than a sample of {sample_s:g} s; the shortest is {least * sample_s:.10g} [s]"
        elif not on_clock(time_s, sample_s):
            below = int(time_s / sample_s)
            near = f"{below * sample_s:.10g} and {(below + 1) * sample_s:.10g}"
            yield f"= {time_s:.10g} falls between two samples of {sample_s:g} s; the nearest are {near} [s]"
