"""Sentences that come first where a campaign asks for more: errors one at a time, quiet flights, the envelope, print."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.interfaces import Floats
from fddbench.reporting.beside import Beside
from fddbench.reporting.formats import count, percent, short
from fddbench.reporting.labels import label
from fddbench.reporting.page.alarms_said import Loudest, Said
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.envelope import envelope_pairs, worst_and_best

__all__ = ["of_envelope", "of_points", "of_print", "of_quiet"]

_LEAST_NAMES, _LEAST_POINTS = 2, 3
_MOST_NAMED, _MOST_SCENARIOS, _PIECES, _LEAST_RUNS = 2, 2, 5, 2


def of_quiet(about: str, loudest: Loudest | None, *, healthy: bool = True) -> Said:
    """``Yes with lpv_filter_approx: 72 of 200 healthy flights of descent have an alarm.``, where healthy ones were flown."""
    if "look like a fault?" not in about or not healthy:
        return []
    if loudest is None or not loudest.alarms:
        return [("No healthy flight was taken for a fault. ", True)]
    flights = (
        f": {count(loudest.alarms)} of {count(loudest.flights)} healthy flights of {loudest.scenario} have an alarm. "
    )
    return [("Yes", True), (" with ", False), (loudest.detector, True), (flights, False)]


def of_envelope(
    about: str, columns: Columns, axes: Sequence[tuple[str, str]], swept: Sequence[str], best: int | None
) -> Said:
    """Where in the first map of the envelope the best detector fails most and least, where a campaign asks for that.

    Parameters
    ----------
    about : str
        What the campaign says of itself.
    columns : Columns
        The rows.
    axes, swept : sequences
        As `envelope_pairs` takes them.
    best : int or None
        Number of the best detector; None: nothing is decided.
    """
    asked = re.match(r"Where\b[^?]*\benvelope\b", about) is not None and best is not None
    pairs = envelope_pairs(columns, axes, swept) if asked else []
    found = worst_and_best(columns, best, *pairs[0]) if pairs and best is not None else None
    if found is None or best is None or not found[0].failed:
        return []
    most, least = (f"{count(each.failed)} of {count(each.decided)}" for each in found)
    also, too = (
        f", as often in {each.alike - 1} more cell{'s' * (each.alike > 2)}" if each.alike > 1 else "" for each in found
    )
    return [("Over the envelope ", False), (columns.detectors[best], True), (" fails most at ", False), (found[0].where, True),
            (f": {most} faulty flights{also}; least at {found[1].where}: {least}{too}. ", False)]  # fmt: skip


def of_print(about: str, compared: Sequence[Beside], best: str) -> Said:
    """How many printed scenarios come out as printed, where a campaign asks for a table in print."""
    numbers = set(re.findall(r"\bTables? (\d+)", about.partition("?")[0] if "?" in about else ""))
    found = next((each for each in compared if str(each.table.table) in numbers), None)
    lines = (
        [line for line in found.told if line.detector == best and line.sound is not None] if found is not None else []
    )
    if found is None or not lines:
        return []
    good = sum(bool(line.sound) for line in lines)
    away = [line.away for line in lines if line.away is not None]
    near = sum(abs(each) <= 1 for each in away)
    times = f"; its median time is the printed one to a sample in {near} of {len(away)}" if away else ""
    said = f" is right or quiet in all decided flights of {good} of {len(lines)} scenarios in print{times}. "
    return [(f"Beside Table {found.table.table}: ", False), (best, True), (said, False)]


def of_points(about: str, columns: Columns, sequence: Sequence[str]) -> Said:
    """What the worst entry of a sequence of errors costs beside that without, of the estimate where that is asked for.

    Without errors is the entry in which each column is 0, or else at its commonest value; there may be none. What a grid varies
    besides is flown by all entries alike.

    Parameters
    ----------
    about : str
        What the campaign says of itself.
    columns : Columns
        The rows.
    sequence : sequence of str
        Columns of what the sequence varies.
    """
    if len(sequence) < _LEAST_NAMES or not len(columns):
        return []
    entries = _Entries.of(columns, sequence)
    if entries is None:
        return []
    of_estimate = re.search(r"\bestimates?\b", about.partition("?")[0]) is not None
    return _estimate(columns, entries) if of_estimate else _right(columns, entries)


@dataclass(frozen=True, eq=False)
class _Entries:
    """Entries of a sequence: of each row which one, their values (n_entries, n_names), and which has no error."""

    place: "np.ndarray[Any, Any]"
    values: Floats
    names: Sequence[str]
    none: int

    @classmethod
    def of(cls, columns: Columns, names: Sequence[str]) -> "_Entries | None":
        """Of all rows; None with fewer than three entries, or without one that has no error."""
        rows = np.column_stack([columns.numbers(name) for name in names])
        values, place = np.unique(rows, axis=0, return_inverse=True)
        if len(values) < _LEAST_POINTS or np.isnan(values).any():
            return None
        right = np.array([_without_error(column) for column in values.T])
        none = np.flatnonzero((values == right).all(axis=1))
        return cls(place.reshape(-1), values, names, int(none[0])) if len(none) else None

    def called(self, at: int) -> str:
        """What an entry has otherwise than that without errors, in words; of many errors their number."""
        here, none = self.values[at], self.values[self.none]
        own = [
            (name, float(v)) for name, v, right in zip(self.names, here, none, strict=True) if not np.isclose(v, right)
        ]
        if len(own) > _MOST_NAMED:
            return f"{len(own)} errors at once"
        return " and ".join(f"{label(name)} {short(value)}" for name, value in own)


def _without_error(values: Floats) -> float:
    """Value of an entry without an error: 0 where there is one, else the commonest; not-a-number where none is."""
    own, n = np.unique(values, return_counts=True)
    if (own == 0.0).any():
        return 0.0
    return float(own[np.argmax(n)]) if np.sum(n == n.max()) == 1 else float("nan")


def _estimate(columns: Columns, entries: _Entries) -> Said:
    """Of each scenario by itself, for sites differ in their units: the largest median of the bias of an entry."""
    said: Said = []
    for s, scenario in enumerate(columns.scenarios):
        medians = {
            (d, p): m for d in range(len(columns.detectors)) for p, m in _biases(columns, s, d, entries.place).items()
        }
        wrong = {at: m for at, m in medians.items() if at[1] != entries.none}
        if len(said) >= _MOST_SCENARIOS * _PIECES or not wrong:
            continue
        d, at = max(wrong, key=lambda each: abs(wrong[each]))
        none = medians.get((d, entries.none))
        beside = "" if none is None else f", {short(none)} where none is off"
        worst = f": bias {short(wrong[d, at])} of {columns.detectors[d]}{beside}"
        said += [("; " if said else "Estimates are most wrong in ", False), (scenario, True), (" with ", False),
                 (entries.called(at), True), (worst, False)]  # fmt: skip
    return [*said, (" (medians of flights, in the unit of each site). ", False)] if said else []


def _biases(columns: Columns, s: int, d: int, place: "np.ndarray[Any, Any]") -> dict[int, float]:
    """Median of the bias of the estimate with each entry, of a scenario and detector; without entries that have none."""
    places = columns.cell(s, d)
    bias = columns.numbers("estimate_bias")[places]
    known = places[columns.ok[places] & columns.faulty[places] & ~np.isnan(bias)]
    return {
        int(p): float(np.median(columns.numbers("estimate_bias")[known[place[known] == p]]))
        for p in np.unique(place[known])
    }


def _right(columns: Columns, entries: _Entries) -> Said:
    """Who loses most to errors, and who loses nothing: of several the one that is right most often."""
    right, sure = columns.texts("outcome") == "right", columns.decided & columns.faulty
    worst: list[tuple[float, str, int, float, float]] = []
    for d, name in enumerate(columns.detectors):
        own = sure & (columns.detector == d)
        shares = {
            int(p): 100.0 * float(right[own & (entries.place == p)].mean()) for p in np.unique(entries.place[own])
        }
        if entries.none in shares and len(shares) > 1:
            at = min((p for p in shares if p != entries.none), key=lambda p: (shares[p], p))
            worst.append((shares[at] - shares[entries.none], name, at, shares[entries.none], shares[at]))
    here = " in these flights" if len(np.unique(columns.numbers("run"))) < _LEAST_RUNS else ""
    if not worst or min(worst)[0] >= 0.0:
        return [(f"None of the errors costs any detector a fault{here}. ", True)] if worst else []
    most = min(worst)
    said: Said = [(f"Most is lost{here} with ", False), (entries.called(most[2]), True), (": right goes from ", False),
                  (f"{percent(most[3])} to {percent(most[4])} %", True), (f" with {most[1]}", False)]  # fmt: skip
    safe = sorted((line for line in worst if line[0] >= 0.0), key=lambda line: -line[3])
    if safe:
        nor = f" (nor do {len(safe) - 1} more)" if len(safe) > 1 else ""
        said += [(f"; {safe[0][1]} loses nothing{nor}, right in {percent(safe[0][3])} % without errors", False)]
    elif len(worst) > 1:
        least = max(worst)
        said += [(f"; the worst costs {least[1]} {percent(-least[0])} %", False)]
    return [*said, (". ", False)]
