"""How the right share goes over what a campaign varies, which value is worst, and where healthy flights are loudest."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from fddbench.reporting.formats import percent, short
from fddbench.reporting.labels import label
from fddbench.reporting.page.answer import Course, Loudest, Said
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.ranking import Rank

__all__ = ["courses", "loudest", "worst_value"]

_MOST_VALUES = 12


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
        found.append(Course(name=_called(name), first=short(known[0]), last=short(known[-1]), shares=shares))
    return found[:2]


def _values(columns: Columns, name: str) -> "np.ndarray[Any, Any]":
    """Values of a column that every faulty scenario flies at its first and its last one; none where that is not so."""
    faulty = np.flatnonzero(columns.faulty & columns.decided)
    values, none = columns.numbers(name)[faulty], np.zeros(0)
    known = np.unique(values)
    if not 2 <= len(known) <= _MOST_VALUES or np.isnan(known).any() or columns.drawn(name, faulty):
        return none
    scenario = columns.scenario[faulty]
    everywhere = set(np.unique(scenario).tolist())
    ends = (set(np.unique(scenario[values == value]).tolist()) for value in known[[0, -1]])
    return known if all(there == everywhere for there in ends) else none


def _called(name: str) -> str:
    return label(name).replace(" [-]", "")


def worst_value(about: str, columns: Columns, swept: Sequence[str], ranks: Sequence[Rank]) -> Said:
    """At which value of what is swept the best detector is right least, where a campaign asks which is worst."""
    best = ranks[0] if ranks and ranks[0].decided else None
    names = [name for name in swept if len(_values(columns, name))]
    if re.match(r"Which\b[^?]*\bis worst\b", about) is None or best is None or not names:
        return []
    values, known = columns.numbers(names[0]), _values(columns, names[0])
    own = columns.faulty & columns.decided & (columns.detector == best.number)
    shares = [_right(columns, own & (values == value)) for value in known]
    there = {float(value): share for value, share in zip(known, shares, strict=True) if share is not None}
    worst, least, most = min(there, key=lambda value: there[value]), min(there.values()), max(there.values())
    if least == most:
        ends = f" of {short(known[0])} to {short(known[-1])}: {best.detector} is right in {percent(least)} % at each. "
        return [("None is worse than another", True), (f", {_called(names[0])}{ends}", False)]
    said = f": {best.detector} is right in {percent(least)} % there, in up to {percent(most)} % elsewhere. "
    return [(f"{_called(names[0])} {short(worst)} is worst", True), (said, False)]


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
