"""Numbers of a campaign that must fit together: times on the clock and inside the flight, counts."""

from collections.abc import Iterator, Mapping
from math import prod

from fddbench.campaign.reading.document import Document
from fddbench.campaign.rules.model import CampaignFile
from fddbench.campaign.rules.ranges import ranges
from fddbench.campaign.rules.required import requirement_mistakes
from fddbench.campaign.rules.swept import names_of
from fddbench.campaign.rules.times import MOST_LEVELS, times
from fddbench.campaign.sampling import point_radices
from fddbench.campaign.streams import scenario_stream
from fddbench.campaign.variation import level_radices
from fddbench.errors import Mistake, did_you_mean
from fddbench.faults.specification import FaultSpecification
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
    yield from _reconfigured(document, written)
    yield from _shown(document, written)
    yield from requirement_mistakes(document, written, [bool(faults[n]) for n in range(len(written.scenarios))])
    yield from _detectors_twice(document, written)
    yield from _repeated(document, [entry.name for entry in written.scenarios])
    yield from _too_many(document, written, faults)
    yield from ranges(document, written, plant)
    for number, entry in enumerate(written.scenarios):
        yield from times(document, written, number, faults[number], benchmark, plant)
        if entry.detection_time_limit_s is not None and not faults[number] and not hasattr(plant, "labelled"):
            message = "a healthy flight has no detection time; remove this key or add faults"
            yield document.mistake(("scenarios", number, "detection_time_limit_s"), message, key=True)


def _reconfigured(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    """What is wrong with the detector on which the aircraft acts."""
    name, known = written.reconfigure, written.detector_names
    if name is None:
        return
    if name not in known:
        hint = " ".join(filter(None, [did_you_mean(name, known), f"Its detectors: {', '.join(known)}"]))
        yield document.mistake(("reconfigure",), f"no detector of this campaign is called {name!r}. {hint}")
    if written.purpose == "tuning":
        message = (
            "thresholds are tuned on flights that do not depend on them; an aircraft that acts on a detector flies otherwise "
            "after every false alarm. Remove this key here and keep it in the campaign that evaluates"
        )
        yield document.mistake(("reconfigure",), message, key=True)


def _shown(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    """Scenarios that the report shall show and that the campaign does not have."""
    known = [entry.name for entry in written.scenarios]
    for number, name in enumerate(written.report.scenarios):
        if name not in known:
            message = f"no scenario of this campaign is called {name!r}. {did_you_mean(name, known)}".strip()
            yield document.mistake(("report", "scenarios", number), message)


def _repeated(document: Document, scenarios: list[str]) -> Iterator[Mistake]:
    words: dict[int, str] = {}
    for number, name in enumerate(scenarios):
        other = words.setdefault(scenario_stream("evaluation", name), name)
        if name in scenarios[:number]:
            message = f"a second scenario called {name!r}; give each its own name"
            yield document.mistake(("scenarios", number, "name"), message)
        elif other != name:
            message = f"the names {other!r} and {name!r} give the same random numbers by chance; change one"
            yield document.mistake(("scenarios", number, "name"), message)


def _detectors_twice(document: Document, written: CampaignFile) -> Iterator[Mistake]:
    """Detectors of one name: a design that is listed twice, a gain that is swept twice, or a design called as a variant."""
    known: set[str] = set()
    for number, entry in enumerate(written.detectors):
        names = names_of((entry,))
        for name in [name for name in names if name in known][:1]:
            message = f"a second detector called {name!r}; sweep each gain once, and rename a design of that name"
            if isinstance(entry, str) and entry in written.detectors[:number]:
                message = f"design {name!r} is listed twice; list it once"
            yield document.mistake(("detectors", number), message)
        known |= set(names)


def _too_many(document: Document, written: CampaignFile, faults: Faults) -> Iterator[Mistake]:
    points = prod(point_radices(written.dispersions))
    drawn = written.dispersions.monte_carlo.runs if written.dispersions.monte_carlo else 1
    levels = [prod(level_radices(faults[number])) for number in range(len(written.scenarios))]
    cases = [points * n * (entry.runs or drawn) for n, entry in zip(levels, written.scenarios, strict=True)]
    for number, n in enumerate(levels):
        if n > MOST_LEVELS:
            message = f"the sweeps of this scenario have {n:,} levels, at most {MOST_LEVELS:,}; use fewer values"
            yield document.mistake(("scenarios", number, "faults"), message, key=True)
    if max(levels) > MOST_LEVELS or sum(cases) <= MOST_CASES:
        return
    large = max(range(len(cases)), key=cases.__getitem__)
    message = (
        f"{sum(cases):,} cases, up to {max(cases):,} flights in a scenario; at most {MOST_CASES:,} cases. "
        "Use fewer grid values or fewer runs"
    )
    own = written.scenarios[large].runs is not None
    yield document.mistake(("scenarios", large, "runs") if own else ("dispersions",), message, key=True)
