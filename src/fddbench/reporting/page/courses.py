"""How the right share goes over what a campaign varies, and where healthy flights are loudest."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fddbench.reporting.formats import short
from fddbench.reporting.labels import label
from fddbench.reporting.page.answer import Course, Loudest
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.ranking import Rank

__all__ = ["courses", "loudest"]

_MOST_VALUES = 12


def courses(columns: Columns, swept: Sequence[str]) -> list[Course]:
    """Of the first two swept columns that all faulty flights have, of 2 to 12 values: shares at the first and the last one."""
    found = []
    faulty = columns.faulty & columns.decided
    for name in swept:
        values = columns.numbers(name)
        known = np.unique(values[faulty & ~np.isnan(values)])
        if not 2 <= len(known) <= _MOST_VALUES:
            continue
        shares = []
        for d, detector in enumerate(columns.detectors):
            ends = [_right(columns, faulty & (columns.detector == d) & (values == value)) for value in known[[0, -1]]]
            if None not in ends:
                shares.append((detector, float(ends[0] or 0.0), float(ends[1] or 0.0)))
        found.append(
            Course(name=label(name).replace(" [-]", ""), first=short(known[0]), last=short(known[-1]), shares=shares)
        )
    return found[:2]


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
