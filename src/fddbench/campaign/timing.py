"""How long a flight lasts and how soon its faults must be found, in seconds and in samples."""

from collections.abc import Sequence

from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Benchmark

__all__ = [
    "faulty_sites",
    "first_faulty_sample",
    "flight_limit_s",
    "flight_s",
    "last_onset_s",
    "limit_s",
    "on_clock",
    "samples",
]

AFTER_LIMIT_S = 5.0
_CLOCK_TOLERANCE_S = 1e-9


def faulty_sites(faults: Sequence[FaultSpecification], benchmark: Benchmark) -> tuple[str, ...]:
    """Distinct faulty sites in the order of the benchmark."""
    named = {site for fault in faults for site in fault.sites}
    return tuple(site for site in benchmark.sites if site in named)


def last_onset_s(fault: FaultSpecification) -> float:
    """Time at which the last site of a fault turns faulty [s]."""
    return fault.onset_s + fault.delay_s * (len(fault.sites) - 1)


def limit_s(n_faulty: int, benchmark: Benchmark, *, override_s: float | None) -> float:
    """Time within which faulty sites must be found [s]."""
    return benchmark.detection_time_limit_s(n_faulty) if override_s is None else override_s


def flight_limit_s(faults: Sequence[FaultSpecification], benchmark: Benchmark, *, override_s: float | None) -> float:
    """Time from the first onset within which all faulty sites of a flight must be found [s].

    The requirement, the scenario's or the benchmark's, runs from when the last site turns faulty: before that, nobody can
    know it.
    """
    own = limit_s(len(faulty_sites(faults, benchmark)), benchmark, override_s=override_s)
    return round(max(map(last_onset_s, faults)) - min(fault.onset_s for fault in faults), 9) + own


def flight_s(
    faults: Sequence[FaultSpecification],
    manoeuvre: str,
    benchmark: Benchmark,
    *,
    duration_s: float | None,
    override_s: float | None,
) -> float:
    """Length of a flight [s]: as given, else long enough to find the last fault, else that of the manoeuvre.

    Parameters
    ----------
    duration_s : float or None
        What the scenario or the campaign says.
    override_s : float or None
        Detection time limit of the scenario, instead of the benchmark's.
    """
    if duration_s is not None:
        return duration_s
    if not faults:
        return benchmark.manoeuvres[manoeuvre]
    limit = limit_s(len(faulty_sites(faults, benchmark)), benchmark, override_s=override_s)
    return max(map(last_onset_s, faults)) + limit + AFTER_LIMIT_S


def samples(time_s: float, sample_s: float) -> int:
    """Time in whole samples, the nearest."""
    return round(time_s / sample_s)


def on_clock(time_s: float, sample_s: float) -> bool:
    """Whether a time falls on a sample, within 1e-9 s."""
    return abs(time_s - samples(time_s, sample_s) * sample_s) <= _CLOCK_TOLERANCE_S


def first_faulty_sample(faults: Sequence[FaultSpecification], sample_s: float) -> int | None:
    """First faulty sample k0, or None in a healthy flight."""
    return min((samples(fault.onset_s, sample_s) for fault in faults), default=None)
