"""The first sentence of a page: which detector, where does it fail, how sure are we; written from counts by rules.

1. Nothing flown, no fault flown, or nothing decided: it says so, and what is known of false alarms.
2. All detectors right in all decided flights, or none ever right: it says so, for a rank would be chance.
3. One detector: its share. Several: the best one, unless the second is as good on the same flights: an exact paired test by
   run with p of 0.05 or more, then "not decided between"; equal counts are called equal. Of one run, which no test can tell
   anything of, the shares of both.
4. What the campaign varies: how the right share goes from the first to the last value, for who loses most and who loses least.
5. Where the best one fails most; in how many flights a healthy site is declared; false alarms, and in which healthy scenario
   there are most of them. One flight has no interval, and it says so.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from fddbench.metrics.paired import PairedShares
from fddbench.reporting.formats import count, interval, percent, rate
from fddbench.reporting.page.ranking import Rank

__all__ = ["Course", "Loudest", "Said", "answer"]

_SURE = 0.05
"""Of the paired test, below which the best is called best."""

Said = list[tuple[str, bool]]
"""Pieces of text, and whether they are names or numbers to set in bold."""


@dataclass(frozen=True, kw_only=True)
class Course:
    """How the right share of each detector goes over the values of what a campaign varies.

    Attributes
    ----------
    name : str
        In words, with its unit: ``gust scale ratio``.
    first, last : str
        Its first and last value.
    shares : sequence of (detector, first share, last share)
        In percent of the decided flights.
    """

    name: str
    first: str
    last: str
    shares: Sequence[tuple[str, float, float]]


@dataclass(frozen=True, kw_only=True)
class Loudest:
    """Healthy scenario with most false alarms of a detector."""

    detector: str
    scenario: str
    alarms: int
    flights: int


def answer(
    ranks: Sequence[Rank],
    second: PairedShares | None = None,
    *,
    courses: Sequence[Course] = (),
    loudest: Loudest | None = None,
    along_first: bool = False,
) -> Said:
    """Pieces of the sentence.

    Parameters
    ----------
    ranks : sequence of Rank
        Best first.
    second : PairedShares or None
        The second beside the best on the same flights.
    courses : sequence of Course
        What the campaign varies.
    loudest : Loudest or None
        Healthy scenario with most false alarms.
    along_first : bool
        Whether what the campaign varies is what it asks for.
    """
    if not ranks:
        return [("Not decided: no flight was flown.", False)]
    if not any(line.faulty for line in ranks):
        return _healthy(ranks, loudest)
    if not any(line.decided for line in ranks):
        n = max(line.faulty for line in ranks)
        return [
            ("Not decided", True),
            (f": all {count(n)} faulty flights end before the limit of their fault without a declaration. ", False),
            *_healthy(ranks, loudest),
        ]
    decided = [line for line in ranks if line.decided]
    best = decided[0]
    said, along = _verdict(decided, second), [piece for course in courses for piece in _along(course)]
    said = along + said if along_first else said + along
    if len(decided) == 1 or any(line.right.hits < line.decided for line in decided):
        said += _weakness(best, "It" if len(decided) == 1 else best.detector)
    said += _false_alarms(best, loudest)
    return said


def _verdict(decided: Sequence[Rank], second: PairedShares | None) -> Said:
    best, n = decided[0], f"{count(decided[0].decided)} decided faulty flight{'' if decided[0].decided == 1 else 's'}"
    right = [line.right.hits == line.decided for line in decided]
    who = "Both detectors" if len(decided) == 2 else f"All {len(decided)} detectors"
    if len(decided) > 1 and all(right):
        flights = "the one decided faulty flight" if best.decided == 1 else f"all {n}"
        return [(f"{who} are right in time", True), (f" in {flights}{_bound(best)}. ", False)]
    if all(line.right.hits == 0 for line in decided):
        return [(f"{'The detector is' if len(decided) == 1 else who + ' are'} never right", True),
                (f" in time in {n}. ", False)]  # fmt: skip
    if len(decided) == 1:
        return [(best.detector, True), (": ", False), *_share(best)]
    return _best(decided, second)


def _best(decided: Sequence[Rank], second: PairedShares | None) -> Said:
    best, other = decided[0], decided[1]
    if second is None or not second.pairs:
        return [(f"First of {len(decided)}, on other flights than the second: ", False), (best.detector, True), (", ", False),
                *_share(best)]  # fmt: skip
    if second.only_a == second.only_b == 0:
        same = (best.right.hits, best.decided)
        also = [line.detector for line in decided[2:] if (line.right.hits, line.decided) == same]
        as_often = f"{' and '.join(filter(None, [', '.join(also[:-1]), also[-1]]))} as often, " if also else ""
        return [("Not decided: ", False), (best.detector, True), (" and ", False), (other.detector, True),
                (f" are right in the same flights, {as_often}", False), *_share(best)]  # fmt: skip
    if second.runs < 2:
        here = f" in {percent(_percent(other))} %; of other flights one run proves nothing. "
        return [("Of these flights ", False), (best.detector, True), (" is right in time in ", False),
                (f"{percent(_percent(best))} %", True), (", ", False), (other.detector, True), (here, False)]  # fmt: skip
    if second.p_value is None or second.p_value >= _SURE:
        p = "no test" if second.p_value is None else f"p = {second.p_value:.2g}"
        share = f", {percent(_percent(best))} and {percent(_percent(other))} % of faulty flights right in time ({p}). "
        return [
            ("Not decided between ", False),
            (best.detector, True),
            (" and ", False),
            (other.detector, True),
            (share, False),
        ]
    return [(f"Best of {len(decided)}: ", False), (best.detector, True), (", ", False), *_share(best)]


def _percent(line: Rank) -> float | None:
    return None if line.right.share is None else 100.0 * line.right.share


def _share(line: Rank) -> Said:
    """``63.5 % of 400 decided faulty flights (59.0 … 67.8).``."""
    of = line.right
    ends = interval(of.low and 100.0 * of.low, of.high and 100.0 * of.high) if of.low is not None else ""
    inside = f" ({ends})" if ends else " (one run: no interval)"
    flights = f"{count(line.decided)} decided faulty flight{'' if line.decided == 1 else 's'}"
    return [(f"{percent(_percent(line))} %", True), (f" of {flights} right in time{inside}. ", False)]


def _bound(line: Rank) -> str:
    return f" (at least {percent(100.0 * line.right.low)} % with 95 % confidence)" if line.right.low is not None else ""


def _along(course: Course) -> Said:
    """Who loses most and who loses least between the first and the last value; nothing where nobody's share changes."""
    losses = sorted(course.shares, key=lambda each: each[2] - each[1])
    if all(first == last for _, first, last in losses):
        return []
    most, least = losses[0], losses[-1]
    text: Said = [(f"From {course.name} {course.first} to {course.last} right goes from ", False), *_from_to(most)]
    if least[1] == least[2]:
        text += [(", and stays at ", False), (f"{percent(least[1])} %", True), (f" with {least[0]}", False)]
    elif least[0] != most[0]:
        text += [(", and from ", False), *_from_to(least)]
    return [*text, (". ", False)]


def _from_to(each: tuple[str, float, float]) -> Said:
    name, first, last = each
    return [(f"{percent(first)} to {percent(last)} %", True), (f" with {name}", False)]


def _weakness(best: Rank, who: str) -> Said:
    """Where it fails; by its name where a sentence before has named several."""
    said: Said = [(who, who == best.detector)]
    if best.weakest is None:
        said.append((" fails in no flight. ", False))
    else:
        worst = best.weakest
        said += [(" fails most in ", False), (worst.scenario, True),
                 (f": {count(worst.failed)} of {count(worst.decided)} flights. ", False)]  # fmt: skip
    wrong = best.outcomes.get("wrong_site", 0)
    flights = f"{count(wrong)} flight{'' if wrong == 1 else 's'}"
    said.append(
        (f"In {flights} it declares a healthy site. " if wrong else "It never declares a healthy site. ", False)
    )
    if best.undecided:
        said.append((f"{count(best.undecided)} more are undecided. ", False))
    return said


def _false_alarms(best: Rank, loudest: Loudest | None) -> Said:
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


def _healthy(ranks: Sequence[Rank], loudest: Loudest | None) -> Said:
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
