"""Times of a campaign: on the clock, inside the flight, and one after the other."""

from collections.abc import Iterator
from math import prod

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.model import LONGEST_FLIGHT_S, CampaignFile
from fddbench.campaign.timing import faulty_sites, flight_s
from fddbench.campaign.variation import Faults, at_levels, level_radices
from fddbench.clock import misfit, samples
from fddbench.errors import FddbenchError, Mistake
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.timing import latest_onset_s, onset_bounds_s
from fddbench.faults.varied import Varied, bounds
from fddbench.interfaces import Benchmark, Plant

__all__ = ["MOST_LEVELS", "times"]

MOST_LEVELS = 100_000
"""Largest number of levels of a scenario's sweeps."""


def times(
    document: Document, written: CampaignFile, number: int, faults: Faults, benchmark: Benchmark, plant: Plant
) -> Iterator[Mistake]:
    """What is wrong with the times of a scenario; a fault that does not fit the clock is told once, by that."""
    entry = written.scenarios[number]
    yield from _durations(document, written, number)
    yield from _recorded(document, written, number, plant)
    unfit = [list(fault.unfit(written.sample_s)) for fault in faults]
    for position, wrong in enumerate(unfit):
        for key, message in wrong:
            yield document.mistake(("scenarios", number, "faults", position, key), message)
    given = written.duration_s if entry.duration_s is None else entry.duration_s
    if any(unfit) or prod(level_radices(faults)) > MOST_LEVELS:
        return
    lengths = {}
    for level in at_levels(faults):
        try:
            length = flight_s(level, entry.manoeuvre, plant, duration_s=given, override_s=entry.detection_time_limit_s)
        except (FddbenchError, LookupError, ValueError):
            sites = ", ".join(site.name for site in faulty_sites(faults, plant.sites))
            message = f"benchmark {benchmark.name!r} states no detection time for {sites}; add detection_time_limit_s"
            yield document.mistake(("scenarios", number), message)
            return
        lengths[level] = length
    longest = max(lengths.values())
    if longest > LONGEST_FLIGHT_S:
        message = f"the flight would last {longest:g} s, at most {LONGEST_FLIGHT_S:g} s; start the faults earlier"
        yield document.mistake(("scenarios", number), message)
    found = [wrong for level, length in lengths.items() for wrong in _level_times(level, length, written.sample_s)]
    for position, key, message in dict.fromkeys(found):
        yield document.mistake(("scenarios", number, "faults", position, key), message)


def _durations(document: Document, written: CampaignFile, number: int) -> Iterator[Mistake]:
    """Lengths of flights that are no whole number of samples."""
    own = written.scenarios[number].duration_s
    places: list[tuple[Address, float | None]] = [(("scenarios", number, "duration_s"), own)]
    places += [(("duration_s",), written.duration_s)] if own is None else []
    for address, time_s in places:
        wrong = "" if time_s is None else misfit(time_s, written.sample_s, least=1)
        if wrong:
            yield document.mistake(address, f"duration_s {wrong}")


def _recorded(document: Document, written: CampaignFile, number: int, plant: Plant) -> Iterator[Mistake]:
    """A flight that shall last longer than what was recorded."""
    entry = written.scenarios[number]
    own, longest_s = entry.duration_s, plant.manoeuvres.get(entry.manoeuvre)
    given = written.duration_s if own is None else own
    if hasattr(plant, "longest_s") and given is not None and longest_s is not None and given > longest_s:
        address: Address = ("duration_s",) if own is None else ("scenarios", number, "duration_s")
        message = f"the longest log lasts {longest_s:g} s, got {given:g}; remove this key to fly logs to their ends"
        yield document.mistake(address, message)


def _level_times(faults: Faults, flight_end_s: float, sample_s: float) -> Iterator[tuple[int, str, str]]:
    """Fault, key and message of what does not fit into the flight, or together, at one level."""
    for position, fault in enumerate(faults):
        yield from ((position, *wrong) for wrong in _inside(fault, flight_end_s, sample_s))
    for position, fault in enumerate(faults):
        for other in faults[:position]:
            site = _both_replace(fault, other, sample_s)
            if site:
                message = (
                    f"two faults replace the signal of {site} from the same sample on; start one of them later, or add "
                    "one of them (mode: add)"
                )
                yield position, "onset_s", message


def _both_replace(a: FaultSpecification, b: FaultSpecification, sample_s: float) -> str:
    """Site on which both are written to replace the signal from the same sample on; "" for none."""
    if "add" in (a.mode, b.mode):
        return ""
    for site in set(a.sites) & set(b.sites):
        first = {onset_bounds_s(fault, fault.sites.index(site)) for fault in (a, b)}
        if len({samples(time_s, sample_s) for both in first for time_s in both}) == 1:
            return site
    return ""


def _inside(fault: FaultSpecification, flight_end_s: float, sample_s: float) -> Iterator[tuple[str, str]]:
    """Key and message of what lies outside of the flight."""
    onset, last = bounds(fault.onset_s)[1], latest_onset_s(fault)
    remedy = "start it earlier or give a longer duration_s"
    if onset >= flight_end_s:
        message = f"the fault starts at {onset:g} s, after the flight's end at {flight_end_s:g} s; {remedy}"
        yield "onset_s", message
    elif last >= flight_end_s:
        message = (
            f"with the delay the last site fails at {last:g} s, after the flight's end at {flight_end_s:g} s; {remedy}"
        )
        yield "delay_s", message
    if fault.end_s is None:
        return
    first_end, last_end = bounds(fault.end_s)
    if last_end > flight_end_s:
        message = f"the fault ends at {last_end:g} s, after the flight's end at {flight_end_s:g} s; "
        yield "end_s", message + "remove end_s or give a longer duration_s"
    elif samples(first_end, sample_s) <= samples(last, sample_s):
        if isinstance(fault.onset_s, Varied) or isinstance(fault.end_s, Varied):
            remedy = "draw the onset earlier or end it later"
        else:
            remedy = "shorten delay_s"
        yield "end_s", f"the fault ends at {first_end:g} s, before its last site fails at {last:g} s; {remedy}"
