"""When the faults of a scenario begin and end on each site, in whole samples; per flight where that is drawn."""

from collections.abc import Iterator, Sequence
from typing import Any

from fddbench.clock import misfit, sample_numbers
from fddbench.faults.varied import Varied, bounds
from fddbench.interfaces import NEVER, Fault

__all__ = ["NEVER", "first_samples", "last_sample", "latest_onset_s", "misfits", "onset_bounds_s"]


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


def misfits(value: Any, sample_s: float, *, least: int = 0) -> Iterator[str]:
    """What is wrong with the times of a key that do not fit the clock, to be put behind its name.

    Parameters
    ----------
    value : float, Varied or None
        A time as it is written [s]; what varies is looked at number by number.
    least : int
        Fewest samples that it may last.
    """
    times = value.written if isinstance(value, Varied) else () if value is None else (value,)
    yield from filter(None, (misfit(time_s, sample_s, least=least) for time_s in times))
