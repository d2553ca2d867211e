"""How long a flight lasts and how soon its faults must be found, in seconds and in samples."""

from collections.abc import Sequence

from fddbench.faults.timing import latest_onset_s
from fddbench.interfaces import Fault, Plant, Site
from fddbench.interfaces.site import limit_s

__all__ = ["faulty_sites", "flight_s", "requirement_s"]

AFTER_LIMIT_S = 5.0


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


def flight_s(
    faults: Sequence[Fault], manoeuvre: str, plant: Plant, *, duration_s: float | None, override_s: float | None
) -> float:
    """Length of a flight [s]: as given, else long enough to find the last fault, else that of the manoeuvre.

    What was recorded is no longer than that, and a flight of a shorter log ends with it.

    Where an onset is drawn, the latest that can be drawn counts, so all runs are equally long.

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
    enough = max(map(latest_onset_s, faults)) + limit + AFTER_LIMIT_S
    # what was recorded is over at its end
    return min(enough, plant.manoeuvres[manoeuvre]) if hasattr(plant, "longest_s") else enough
