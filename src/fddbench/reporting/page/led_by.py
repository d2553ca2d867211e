"""Sentences that come first where a campaign asks for more: errors one at a time, quiet flights, the envelope, print."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fddbench.interfaces import Floats
from fddbench.reporting.beside import Beside
from fddbench.reporting.formats import count, percent, short
from fddbench.reporting.labels import label
from fddbench.reporting.page.answer import Loudest, Said
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.envelope import envelope_pairs, worst_and_best

__all__ = ["of_envelope", "of_points", "of_print", "of_quiet"]

_LEAST_NAMES, _LEAST_POINTS = 2, 3
_MOST_NAMED, _MOST_SCENARIOS, _PIECES = 2, 2, 5


def of_quiet(about: str, loudest: Loudest | None) -> Said:
    """``Yes with lpv_filter_approx: 72 of 200 healthy flights of descent have an alarm.``, where that is asked."""
    if "look like a fault?" not in about:
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
    return [("Over the envelope ", False), (columns.detectors[best], True), (" fails most at ", False), (found[0].where, True),
            (f": {most} faulty flights; least at {found[1].where}: {least}. ", False)]  # fmt: skip


def of_print(about: str, compared: Sequence[Beside], best: str) -> Said:
    """How many printed scenarios come out as printed, where a campaign asks for a table in print."""
    numbers = set(re.findall(r"\bTables? (\d+)", about.partition("?")[0] if "?" in about else ""))
    found = next((each for each in compared if str(each.table.table) in numbers), None)
    lines = [line for line in found.told if line.detector == best] if found is not None else []
    if found is None or not lines:
        return []
    good = sum(line.sound for line in lines)
    away = [line.away for line in lines if line.away is not None]
    near = sum(abs(each) <= 1 for each in away)
    times = f"; its median time is the printed one to a sample in {near} of {len(away)}" if away else ""
    said = f" is right or quiet in all flights of {good} of {len(lines)} scenarios in print{times}. "
    return [(f"Beside Table {found.table.table}: ", False), (best, True), (said, False)]


def of_points(about: str, columns: Columns, sequence: Sequence[str]) -> Said:
    """What the worst point of a sequence of errors costs beside its first point, of the estimate where that is asked for.

    Parameters
    ----------
    about : str
        What the campaign says of itself.
    columns : Columns
        The rows.
    sequence : sequence of str
        Columns of what the sequence varies.
    """
    if len(sequence) < _LEAST_NAMES:
        return []
    names = {name: columns.numbers(name) for name in sequence}
    point = columns.whole("point", np.arange(len(columns)))
    if len(np.unique(point)) < _LEAST_POINTS:
        return []
    of_estimate = re.search(r"\bestimates?\b", about.partition("?")[0]) is not None
    return _estimate(columns, point, names) if of_estimate else _right(columns, point, names)


def _estimate(columns: Columns, point: "np.ndarray[Any, Any]", names: Mapping[str, Floats]) -> Said:
    """Of each scenario by itself, for sites differ in their units: the largest median of the bias at a point."""
    said: Said = []
    for s, scenario in enumerate(columns.scenarios):
        medians = {(d, p): m for d in range(len(columns.detectors)) for p, m in _biases(columns, s, d, point).items()}
        if len(said) >= _MOST_SCENARIOS * _PIECES or not medians:
            continue
        d, at = max(medians, key=lambda each: abs(medians[each]))
        none = medians.get((d, int(point.min())))
        beside = "" if none is None else f", {short(none)} where none is off"
        worst = f": bias {short(medians[d, at])} of {columns.detectors[d]}{beside}"
        said += [("; " if said else "Estimates are most wrong in ", False), (scenario, True), (" with ", False),
                 (_differing(point, names, at), True), (worst, False)]  # fmt: skip
    return [*said, (" (medians of flights, in the unit of each site). ", False)] if said else []


def _biases(columns: Columns, s: int, d: int, point: "np.ndarray[Any, Any]") -> dict[int, float]:
    """Median of the bias of the estimate at each point, of a scenario and detector; without points that have none."""
    places = columns.cell(s, d)
    bias = columns.numbers("estimate_bias")[places]
    known = places[columns.ok[places] & columns.faulty[places] & ~np.isnan(bias)]
    return {
        int(p): float(np.median(columns.numbers("estimate_bias")[known[point[known] == p]]))
        for p in np.unique(point[known])
    }


def _right(columns: Columns, point: "np.ndarray[Any, Any]", names: Mapping[str, Floats]) -> Said:
    right, sure = columns.texts("outcome") == "right", columns.decided & columns.faulty
    worst: list[tuple[float, str, int, float, float]] = []
    for d, name in enumerate(columns.detectors):
        own = sure & (columns.detector == d)
        shares = {int(p): 100.0 * float(right[own & (point == p)].mean()) for p in np.unique(point[own])}
        if int(point.min()) in shares:
            at, first = min(shares, key=lambda p: (shares[p], p)), shares[int(point.min())]
            worst.append((shares[at] - first, name, at, first, shares[at]))
    if not worst or min(worst)[0] >= 0.0:
        return [("None of the errors costs any detector a fault. ", True)] if worst else []
    most, least = min(worst), max(worst)
    said: Said = [("Most is lost with ", False), (_differing(point, names, most[2]), True), (": right goes from ", False),
                  (f"{percent(most[3])} to {percent(most[4])} %", True), (f" with {most[1]}", False)]  # fmt: skip
    if least[1] != most[1]:
        cost = "nothing costs" if least[0] >= 0.0 else f"the worst point costs {percent(-least[0])} % of"
        said += [(f"; {cost} {least[1]}", False)]
    return [*said, (". ", False)]


def _differing(point: "np.ndarray[Any, Any]", names: Mapping[str, Floats], at: int) -> str:
    """What a point has otherwise than the first one, in words; of many errors their number."""
    here, first = point == at, point == point.min()
    own = [(name, float(v[here][0])) for name, v in names.items() if not np.isclose(v[here][0], v[first][0])]
    if len(own) > _MOST_NAMED:
        return f"{len(own)} errors at once (point {at})"
    return " and ".join(f"{label(name)} {short(value)}" for name, value in own) or f"point {at}"
