"""When the faults of a scenario begin and end on each site, in whole samples."""

from collections.abc import Sequence

from fddbench.interfaces import NEVER, Fault

__all__ = ["NEVER", "first_samples", "last_onset_s", "last_sample", "samples"]


def samples(time_s: float, sample_s: float) -> int:
    """Time in whole samples, the nearest."""
    return round(time_s / sample_s)


def first_samples(fault: Fault, sites: Sequence[str], sample_s: float) -> list[float]:
    """First faulty sample of every one of these sites, `NEVER` for those the fault leaves alone."""
    onset = {site: fault.onset_s + fault.delay_s * nth for nth, site in enumerate(fault.sites)}
    return [float(samples(onset[site], sample_s)) if site in onset else NEVER for site in sites]


def last_sample(fault: Fault, sample_s: float) -> float:
    """Last faulty sample, `NEVER` for a fault that stays."""
    return NEVER if fault.end_s is None else samples(fault.end_s, sample_s) - 1.0


def last_onset_s(fault: Fault) -> float:
    """Time at which the last site of a fault turns faulty [s]."""
    return fault.onset_s + fault.delay_s * (len(fault.sites) - 1)
