"""How long a flight lasts and how soon its faults must be found, in seconds and in samples."""

from collections.abc import Sequence

from fddbench.faults.timing import last_onset_s, samples
from fddbench.interfaces import Fault, Plant, Site
from fddbench.interfaces.site import limit_s

__all__ = ["faulty_sites", "first_faulty_sample", "flight_limit_s", "flight_s", "on_clock", "requirement_s"]

AFTER_LIMIT_S = 5.0
_CLOCK_TOLERANCE_S = 1e-9


def faulty_sites(faults: Sequence[Fault], sites: Sequence[Site]) -> tuple[Site, ...]:
    """Distinct faulty sites in the order of the benchmark."""
    named = {site for fault in faults for site in fault.sites}
    return tuple(site for site in sites if site.name in named)


def requirement_s(faults: Sequence[Fault], sites: Sequence[Site], *, override_s: float | None) -> float:
    """Time within which the sites of these faults must be found [s]: of the scenario, else of the sites.

    Raises
    ------
    FddbenchError
        Neither states one.
    """
    return limit_s(faulty_sites(faults, sites)) if override_s is None else override_s


def flight_limit_s(faults: Sequence[Fault], sites: Sequence[Site], *, override_s: float | None) -> float:
    """Time from the first onset within which all faulty sites of a flight must be found [s].

    The requirement, the scenario's or the benchmark's, runs from when the last site turns faulty: before that, nobody can
    know it.
    """
    own = requirement_s(faults, sites, override_s=override_s)
    return round(max(map(last_onset_s, faults)) - min(fault.onset_s for fault in faults), 9) + own


def flight_s(
    faults: Sequence[Fault], manoeuvre: str, plant: Plant, *, duration_s: float | None, override_s: float | None
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
        return plant.manoeuvres[manoeuvre]
    limit = requirement_s(faults, plant.sites, override_s=override_s)
    return max(map(last_onset_s, faults)) + limit + AFTER_LIMIT_S


def on_clock(time_s: float, sample_s: float) -> bool:
    """Whether a time falls on a sample, within 1e-9 s."""
    return abs(time_s - samples(time_s, sample_s) * sample_s) <= _CLOCK_TOLERANCE_S


def first_faulty_sample(faults: Sequence[Fault], sample_s: float) -> int | None:
    """First faulty sample k0, or None in a healthy flight."""
    return min((samples(fault.onset_s, sample_s) for fault in faults), default=None)
