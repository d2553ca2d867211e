"""How the right share goes over what is varied, where faults are found, which value is worst, where alarms are most."""

import re
from collections.abc import Sequence
from itertools import groupby
from typing import Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.metrics.paired import PairedShares, holm, paired_shares
from fddbench.reporting.formats import percent, shorts
from fddbench.reporting.labels import label
from fddbench.reporting.page.alarms_said import Loudest, Said
from fddbench.reporting.page.answer import Course
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.ranking import Rank

__all__ = ["courses", "found_at", "loudest", "worst_value"]

_MOST_VALUES, _SURE, _MOST_TOLD, _MOST_FOUND = 12, 0.05, 6, 90.0


def courses(columns: Columns, swept: Sequence[str]) -> list[Course]:
    """Of the first two swept columns that all faulty scenarios sweep, of 2 to 12 values: shares at the first and the last one.

    What is drawn anew in every run has no first value, and sizes that scenarios have each for themselves no course.
    """
    found = []
    faulty = columns.faulty & columns.decided
    for name in swept:
        values, known = columns.numbers(name), _values(columns, name)
        if not len(known):
            continue
        shares = []
        for d, detector in enumerate(columns.detectors):
            ends = [_right(columns, faulty & (columns.detector == d) & (values == value)) for value in known[[0, -1]]]
            if None not in ends:
                shares.append((detector, float(ends[0] or 0.0), float(ends[1] or 0.0)))
        first, last = shorts([float(known[0]), float(known[-1])])
        found.append(Course(name=_called(name), first=first, last=last, shares=shares))
    return found[:2]


def _values(columns: Columns, name: str, *, everywhere: bool = False) -> "np.ndarray[Any, Any]":
    """Values of a column whose ends every faulty scenario flies, or all of them `everywhere`; none where that is not so."""
    faulty = np.flatnonzero(columns.faulty & columns.decided)
    values, none = columns.numbers(name)[faulty], np.zeros(0)
    known = np.unique(values)
    if not 2 <= len(known) <= _MOST_VALUES or np.isnan(known).any() or columns.drawn(name, faulty):
        return none
    scenario = columns.scenario[faulty]
    wanted = set(np.unique(scenario).tolist())
    asked = known if everywhere else known[[0, -1]]
    there = (set(np.unique(scenario[values == value]).tolist()) for value in asked)
    return known if all(each == wanted for each in there) else none


def _first_swept(columns: Columns, swept: Sequence[str]) -> "tuple[str, np.ndarray[Any, Any]] | None":
    """The first column of which every faulty scenario flies every value, and the values; None without one."""
    found = ((name, _values(columns, name, everywhere=True)) for name in swept)
    return next(((name, known) for name, known in found if len(known)), None)


def _called(name: str) -> str:
    return label(name).replace(" [-]", "")


def worst_value(about: str, columns: Columns, swept: Sequence[str], ranks: Sequence[Rank]) -> Said:
    """At which value of what is swept the best detector is right least, where a campaign asks which is worst.

    One is called the worst where a paired test by run says so beside every other one, p adjusted by Holm.
    """
    best = ranks[0] if ranks and ranks[0].decided else None
    asked = re.match(r"Which\b[^?]*\bis worst\b", about) is not None
    first = _first_swept(columns, swept) if asked else None
    if first is None or best is None:
        return []
    name, known = first
    own = columns.faulty & columns.decided & (columns.detector == best.number)
    known = np.array([value for value in known if (own & (columns.numbers(name) == value)).any()])
    shares = [_right(columns, own & (columns.numbers(name) == value)) or 0.0 for value in known]
    if len(known) < 2:
        return []
    least, most, worst = min(shares), max(shares), float(known[int(np.argmin(shares))])
    shown, here = shorts(known.tolist()), " in these flights" if best.right.runs < 2 else ""
    if least == most:
        ends = f" of {shown[0]} to {shown[-1]}: {best.detector} is right in {percent(least)} % at each. "
        return [("None is worse than another", True), (f"{here}, {_called(name)}{ends}", False)]
    said = f": {best.detector} is right in {percent(least)} % there, in up to {percent(most)} % elsewhere. "
    if shares.count(least) == 1 and _worse_than_all(columns, own, columns.numbers(name), known.tolist(), worst):
        return [(f"{_called(name)} {shown[int(np.argmin(shares))]} is worst", True), (said, False)]
    ends = f" is right in {percent(least)} to {percent(most)} % over {_called(name)} {shown[0]} to {shown[-1]}. "
    return [("Not decided which is worst", True), (f": {best.detector}{ends}", False)]


def _worse_than_all(
    columns: Columns, own: "np.ndarray[Any, Any]", values: Floats, known: Sequence[float], worst: float
) -> bool:
    """Whether flights at one value go worse than the same flights at each other value."""
    pairs = [_beside(columns, own & (values == worst), own & (values == value)) for value in known if value != worst]
    p = holm([np.nan if each.p_value is None or each.runs < 2 else each.p_value for each in pairs])
    return bool(np.all(p < _SURE)) and all((each.difference or 0.0) > 0.0 for each in pairs)


def _beside(columns: Columns, a: "np.ndarray[Any, Any]", b: "np.ndarray[Any, Any]") -> PairedShares:
    """Right shares of flights of the same scenario and run at two values, in the order of what else is swept."""
    keys = ["scenario", "run", "number"]
    sides = []
    for chosen in (np.flatnonzero(a), np.flatnonzero(b)):
        right, run = columns.texts("outcome")[chosen] == "right", columns.whole("run", chosen)
        side = pd.DataFrame({"scenario": columns.scenario[chosen], "run": run, "right": right})
        sides.append(side.assign(number=side.groupby(keys[:2]).cumcount()))
    both = sides[0].merge(sides[1], on=keys, suffixes=("_a", "_b"))
    return paired_shares(both["right_a"].to_numpy(), both["right_b"].to_numpy(), both["run"].to_numpy())


def found_at(about: str, columns: Columns, swept: Sequence[str], ranks: Sequence[Rank]) -> Said:
    """At which values of what is swept faults of each scenario are found, where a campaign asks at which.

    ``Right in 90 % or more at fault 1 frequency [Hz] of 0.05 to 10, one_sensor: coast at all 12; sliding_mode at 0.3 to 2.``
    """
    first = _first_swept(columns, swept) if re.match(r"At which\b", about) else None
    if first is None:
        return []
    name, known = first
    values, shown = columns.numbers(name), shorts(known.tolist())
    said: Said = [(f"Right in {_MOST_FOUND:g} % or more at {_called(name)} of {shown[0]} to {shown[-1]}, ", False)]
    for s, scenario in list(enumerate(columns.scenarios))[:_MOST_TOLD]:
        here = columns.faulty & columns.decided & (columns.scenario == s)
        at: dict[str, list[str]] = {}
        for line in ranks if here.any() else ():
            own = here & (columns.detector == line.number)
            shares = [_right(columns, own & (values == value)) for value in known]
            if any(share is not None for share in shares):
                told = _stretches([share is not None and share >= _MOST_FOUND for share in shares], shown)
                at.setdefault(told, []).append(line.detector)
        words = "; ".join(f"{_listed(who)} at {told}" for told, who in at.items())
        said += [(scenario, True), (f": {words}. ", False)] if words else []
    return said if len(said) > 1 else []


def _listed(names: Sequence[str]) -> str:
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def _stretches(found: Sequence[bool], shown: Sequence[str]) -> str:
    """``0.3 to 2 and 9.5``, ``all 12``, ``none`` of values in their order."""
    if all(found) or not any(found):
        return f"all {len(found)}" if all(found) else "none"
    parts = []
    for there, group in groupby(range(len(found)), key=lambda i: found[i]):
        own = list(group)
        if there:
            parts.append(shown[own[0]] if len(own) == 1 else f"{shown[own[0]]} to {shown[own[-1]]}")
    return _listed(parts)


def _right(columns: Columns, chosen: "np.ndarray[Any, Any]") -> float | None:
    n = int(chosen.sum())
    return 100.0 * float(np.sum(columns.texts("outcome")[chosen] == "right")) / n if n else None


def loudest(columns: Columns, ranks: Sequence[Rank]) -> Loudest | None:
    """Healthy scenario and detector with the largest share of flights with a false alarm; None: there is none."""
    found: list[tuple[float, Loudest]] = []
    for s, scenario in enumerate(columns.scenarios):
        for line in ranks:
            places = columns.cell(s, line.number)
            own = places[columns.ok[places] & ~columns.faulty[places]]
            alarms = int(np.sum(columns.texts("outcome")[own] == "false_alarm"))
            if alarms:
                one = Loudest(detector=line.detector, scenario=scenario, alarms=alarms, flights=len(own))
                found.append((-alarms / len(own), one))
    return min(found, key=lambda each: each[0])[1] if found else None
