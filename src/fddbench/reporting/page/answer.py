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
from fddbench.reporting.formats import count, interval, percent
from fddbench.reporting.page.alarms_said import Loudest, Said, false_alarms, of_healthy
from fddbench.reporting.page.ranking import Rank

__all__ = ["Course", "answer"]

_MOST_NAMED, _SURE = 2, 0.05
"""How many detectors are named; of the paired test, below which the best is called best."""


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
    if not any(line.faulty or line.distinct_flights for line in ranks):
        return (
            [("Not decided: no flight has a score. ", False), *_unscored(ranks)]
            if any(line.lost for line in ranks)
            else [("Not decided: no flight was flown.", False)]
        )
    if not any(line.faulty for line in ranks):
        return of_healthy(ranks, loudest)
    if not any(line.decided for line in ranks):
        n = max(line.faulty for line in ranks)
        return [
            ("Not decided", True),
            (f": all {count(n)} faulty flights end before the limit of their fault without a declaration. ", False),
            *of_healthy(ranks, loudest),
        ]
    decided = [line for line in ranks if line.decided]
    best = decided[0]
    said, along = (
        _verdict(decided, second) + _in_sample(decided) + _unscored(ranks),
        [piece for course in courses for piece in _along(course)],
    )
    said = along + said if along_first else said + along
    if len(decided) == 1 or any(line.right.hits < line.decided for line in decided):
        said += _weakness(best, "It" if len(decided) == 1 else best.detector)
    said += false_alarms(best, loudest)
    return said


def _verdict(decided: Sequence[Rank], second: PairedShares | None) -> Said:
    best, n = decided[0], f"{count(decided[0].decided)} decided faulty flight{'' if decided[0].decided == 1 else 's'}"
    right = [line.right.hits == line.decided for line in decided]
    who = "Both detectors" if len(decided) == 2 else f"All {len(decided)} detectors"
    if len(decided) > 1 and all(right):
        flights = "the one decided faulty flight" if best.decided == 1 else f"all {n}"
        return [(f"{who} are right in time", True), (f" in {flights}{_bound(best)}. ", False)]
    if all(line.right.hits == 0 for line in decided):
        none = {1: "The detector is never", 2: "Neither detector is ever"}
        return [(f"{none.get(len(decided), f'None of {len(decided)} detectors is ever')} right", True),
                (f" in time in {n}. ", False)]  # fmt: skip
    if len(decided) == 1:
        return [(best.detector, True), (": ", False), *_share(best)]
    return _best(decided, second)


def _in_sample(decided: Sequence[Rank]) -> Said:
    """Whose numbers flatter."""
    names = [line.detector for line in decided if line.in_sample]
    who = ", ".join(names) if len(names) <= _MOST_NAMED else f"{len(names)} detectors"
    return [(f"In sample, tuned on these very flights: {who}. ", False)] if names else []


def _unscored(ranks: Sequence[Rank]) -> Said:
    """Who did not come to the end of some flights."""
    lost = sorted((line for line in ranks if line.lost), key=lambda line: -line.lost)
    said: Said = []
    for line in lost[:_MOST_NAMED]:
        flights = f"{count(line.lost)} flight{'' if line.lost == 1 else 's'}"
        said += [(line.detector, True), (f" has no score in {flights}: it did not come to their end. ", False)]
    more = len(lost) - _MOST_NAMED
    return [*said, (f"Nor do {more} more in some. ", False)] if more > 0 else said


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
    text: Said = [(f"From {course.name} {course.first} to {course.last} right ", False), *_from_to(most)]
    if least[0] != most[0]:
        text += [(", and ", False), *_from_to(least)]
    return [*text, (". ", False)]


def _from_to(each: tuple[str, float, float]) -> Said:
    """``goes from 100 to 40 % with x``, ``stays at 100 % with x``."""
    name, first, last = each
    goes, shares = (
        ("stays at", percent(last)) if first == last else ("goes from", f"{percent(first)} to {percent(last)}")
    )
    return [(f"{goes} ", False), (f"{shares} %", True), (f" with {name}", False)]


def _weakness(best: Rank, who: str) -> Said:
    """Where it fails; by its name where a sentence before has named several."""
    said: Said = [(who, who == best.detector)]
    if best.weakest is None:
        said.append((" fails in no flight. ", False))
    else:
        worst = best.weakest
        also = f", as often in {worst.also} more scenario{'' if worst.also == 1 else 's'}" if worst.also else ""
        said += [(" fails most in ", False), (worst.scenario, True),
                 (f": {count(worst.failed)} of {count(worst.decided)} flights{also}. ", False)]  # fmt: skip
    if best.names_sites:
        wrong = best.outcomes.get("wrong_site", 0)
        flights = f"In {count(wrong)} flight{'' if wrong == 1 else 's'} it declares"
        said.append((f"{flights if wrong else 'It never declares'} a healthy site. ", False))
    if best.undecided:
        said.append((f"{count(best.undecided)} more are undecided. ", False))
    return said
