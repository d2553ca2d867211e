"""False alarms in the first sentence of a page: those of the best detector, and those of all where no fault was flown."""

from collections.abc import Sequence
from dataclasses import dataclass

from fddbench.reporting.formats import count, percent, rate
from fddbench.reporting.page.ranking import Rank

__all__ = ["Loudest", "Said", "false_alarms", "of_healthy"]

Said = list[tuple[str, bool]]
"""Pieces of text, and whether they are names or numbers to set in bold."""


@dataclass(frozen=True, kw_only=True)
class Loudest:
    """Healthy scenario with most false alarms of a detector."""

    detector: str
    scenario: str
    alarms: int
    flights: int


def false_alarms(best: Rank, loudest: Loudest | None) -> Said:
    """In how many distinct flights of the best detector, and where there are most of all; nothing where none was watched."""
    if not best.distinct_flights:
        return []
    high = f" (up to {percent(best.alarms_high_percent)} %)" if best.alarms_high_percent is not None else ""
    number = count(best.alarms) if best.alarms else "none"
    said: Said = [(f"False alarms: {number} in {_distinct(best)}{high}", False)]
    if loudest is not None and loudest.alarms:
        said += [("; most of all detectors in ", False), (loudest.scenario, True),
                 (f": {count(loudest.alarms)} of {count(loudest.flights)} with {loudest.detector}", False)]  # fmt: skip
    return [*said, (".", False)]


def _distinct(line: Rank) -> str:
    """``540 distinct flights of 25 runs``; of as many runs where it says nothing of them."""
    runs = f" of {count(line.runs)} run{'' if line.runs == 1 else 's'}" if line.runs != line.distinct_flights else ""
    return f"{count(line.distinct_flights)} distinct flight{'' if line.distinct_flights == 1 else 's'}{runs}"


def of_healthy(ranks: Sequence[Rank], loudest: Loudest | None) -> Said:
    """Nothing but healthy flights tells anything."""
    watched = [line for line in ranks if line.distinct_flights]
    if not watched:
        return [("No healthy stretch was flown either.", False)]
    most_flights = max(watched, key=lambda line: line.distinct_flights)
    if not any(line.alarms for line in watched):
        high = max((line.alarms_high_percent or 0.0) for line in watched)
        upper = f" (up to {percent(high)} % of flights at 95 %)" if high else ""
        return [("No false alarm", True), (f" of any detector in {_distinct(most_flights)}{upper}.", False)]
    ordered = sorted(watched, key=lambda line: line.alarms / line.distinct_flights)
    least, most = ordered[0], ordered[-1]
    said: Said = [("False alarms: ", False), *_count_of(most)]
    if len(ordered) > 1:
        said += [(", fewest ", False), *_count_of(least)]
    if loudest is not None and loudest.alarms:
        said += [
            ("; most in ", False),
            (loudest.scenario, True),
            (f": {count(loudest.alarms)} of {count(loudest.flights)}", False),
        ]
    return [*said, (".", False)]


def _count_of(line: Rank) -> Said:
    share = 100.0 * line.alarms / line.distinct_flights
    return [
        (line.detector, True),
        (f" in {count(line.alarms)} of {count(line.distinct_flights)} ({rate(share)} %)", False),
    ]
