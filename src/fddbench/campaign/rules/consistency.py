"""Numbers of a campaign that must fit together: times on the clock and inside the flight, counts."""

from collections.abc import Iterator, Mapping
from math import prod

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.model import LONGEST_FLIGHT_S, CampaignFile
from fddbench.campaign.rules.ranges import ranges
from fddbench.campaign.sampling import count
from fddbench.campaign.streams import name_word
from fddbench.campaign.timing import faulty_sites, flight_s, on_clock
from fddbench.errors import FddbenchError, Mistake
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.timing import last_onset_s, samples
from fddbench.interfaces import Benchmark, Plant

__all__ = ["MOST_CASES", "Faults", "inconsistencies"]

Faults = Mapping[int, tuple[FaultSpecification, ...]]
"""Faults by the position of their scenario in the file."""

MOST_CASES = 10_000_000
"""Largest campaign [cases]."""


def inconsistencies(
    document: Document, written: CampaignFile, faults: Faults, benchmark: Benchmark, plant: Plant
) -> Iterator[Mistake]:
    """Every contradiction in a campaign whose keys and names are right."""
    yield from _repeated(document, [entry.name for entry in written.scenarios])
    yield from _too_many(document, written)
    yield from ranges(document, written, plant)
    for number, entry in enumerate(written.scenarios):
        yield from _times(document, written, number, faults[number], benchmark, plant)
        if entry.detection_time_limit_s is not None and not faults[number]:
            message = "a healthy flight has no detection time; remove this key or add faults"
            yield document.mistake(("scenarios", number, "detection_time_limit_s"), message, key=True)


def _repeated(document: Document, scenarios: list[str]) -> Iterator[Mistake]:
    words: dict[int, str] = {}
    for number, name in enumerate(scenarios):
        other = words.setdefault(name_word(name) & 0x7FFFFFFF, name)
        if name in scenarios[:number]:
            message = f"a second scenario called {name!r}; give each its own name"
            yield document.mistake(("scenarios", number, "name"), message)
        elif other != name:
            message = f"the names {other!r} and {name!r} give the same random numbers by chance; change one"
            yield document.mistake(("scenarios", number, "name"), message)
    designs = document.items("detectors")
    for number, name in enumerate(designs):
        if name in designs[:number]:
            yield document.mistake(("detectors", number), f"design {name!r} is listed twice; list it once")


def _too_many(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    runs = [prod(count(written.dispersions, monte_carlo_runs=entry.runs)) for entry in written.scenarios]
    if sum(runs) > MOST_CASES:
        message = (
            f"{sum(runs):,} cases, up to {max(runs):,} flights in a scenario; at most {MOST_CASES:,} cases. "
            "Use fewer grid values or fewer runs"
        )
        large = max(range(len(runs)), key=runs.__getitem__)
        own = written.scenarios[large].runs is not None
        yield document.mistake(("scenarios", large, "runs") if own else ("dispersions",), message, key=True)


def _times(
    document: Document,
    written: CampaignFile,
    number: int,
    faults: tuple[FaultSpecification, ...],
    benchmark: Benchmark,
    plant: Plant,
) -> Iterator[Mistake]:
    entry = written.scenarios[number]
    given = written.duration_s if entry.duration_s is None else entry.duration_s
    limit = entry.detection_time_limit_s
    try:
        end_s = flight_s(faults, entry.manoeuvre, plant, duration_s=given, override_s=limit)
    except (FddbenchError, LookupError, ValueError):
        sites = ", ".join(site.name for site in faulty_sites(faults, plant.sites))
        message = f"benchmark {benchmark.name!r} states no detection time for {sites}; add detection_time_limit_s"
        yield document.mistake(("scenarios", number), message)
        return
    if end_s > LONGEST_FLIGHT_S:
        message = f"the flight would last {end_s:g} s, at most {LONGEST_FLIGHT_S:g} s; start the faults earlier"
        yield document.mistake(("scenarios", number), message)
    for position, fault in enumerate(faults):
        address = ("scenarios", number, "faults", position)
        yield from _fault_times(document, address, fault, written.sample_s, end_s)


def _fault_times(
    document: Document, address: Address, fault: FaultSpecification, sample_s: float, flight_end_s: float
) -> Iterator[Mistake]:
    for key in ("onset_s", "end_s", "delay_s"):
        time_s = getattr(fault, key)
        if time_s is not None and not on_clock(time_s, sample_s):
            below = int(time_s / sample_s)
            near = f"{below * sample_s:.10g} and {(below + 1) * sample_s:.10g}"
            message = f"{key} = {time_s:g} falls between two samples of {sample_s:g} s; the nearest are {near} [s]"
            yield document.mistake((*address, key), message)
    last = last_onset_s(fault)
    remedy = "start it earlier or give a longer duration_s"
    if fault.onset_s >= flight_end_s:
        message = f"the fault starts at {fault.onset_s:g} s, after the flight's end at {flight_end_s:g} s; {remedy}"
        yield document.mistake((*address, "onset_s"), message)
    elif last >= flight_end_s:
        message = (
            f"with the delay the last site fails at {last:g} s, after the flight's end at {flight_end_s:g} s; {remedy}"
        )
        yield document.mistake((*address, "delay_s"), message)
    if fault.end_s is not None and fault.end_s > flight_end_s:
        message = f"the fault ends at {fault.end_s:g} s, after the flight's end at {flight_end_s:g} s; "
        message += "remove end_s or give a longer duration_s"
        yield document.mistake((*address, "end_s"), message)
    elif fault.end_s is not None and samples(fault.end_s, sample_s) <= samples(last, sample_s):
        message = f"the fault ends at {fault.end_s:g} s, before its last site fails at {last:g} s; shorten delay_s"
        yield document.mistake((*address, "end_s"), message)
