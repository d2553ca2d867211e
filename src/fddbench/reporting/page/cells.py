"""One cell of the outcome matrix: everything that the page tells of a scenario with a detector, as aggregates."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.metrics.association import Association, Parts, associations, parted
from fddbench.metrics.incidence import Incidence, incidence
from fddbench.metrics.paired import PairedShares, holm
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.ranking import beside_best
from fddbench.reporting.page.sizes import SizeCurve, size_curve

__all__ = ["Cell", "cells", "with_curve"]

_MOST_DECLARED, _MOST_WORST, _MOST_PARTS = 6, 5, 4
_MOST_FITTED = 4
"""Detection curves of a page: each takes 0.1 s, of a thousand flights 0.7 s; `fddbench pod` has all."""
Line = Mapping[Any, Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Cell:
    """A scenario with a detector.

    Attributes
    ----------
    scenario, detector : int
        Their places.
    line : mapping
        Its line of the summary: the same numbers as in the terminal, in tables and in scores.
    incidence : Incidence or None
        Share found over time; None: healthy, or nothing flown.
    declared : sequence of (true sites, declared sites, flights)
        Most frequent first; "" is none.
    associations : sequence of Association
        Parameters that go with failure.
    worst : sequence of str
        Flights to look at, ``point/level/run``.
    paired : PairedShares or None
        Right shares beside the first of the ranking on the same flights.
    p_holm : float or None
        Its p, adjusted over the scenarios of the detector.
    size : SizeCurve or None
        Share found against the size of the fault, where one varies.
    """

    scenario: int
    detector: int
    line: Line
    incidence: Incidence | None = None
    declared: Sequence[tuple[str, str, int]] = ()
    associations: Sequence[Association] = ()
    worst: Sequence[str] = ()
    paired: PairedShares | None = None
    p_holm: float | None = None
    size: SizeCurve | None = None


def _parts_of(columns: Columns, scenario: int) -> dict[str, Parts]:
    """Parameters and sizes that vary in a scenario, cut into parts for all detectors alike; places are those of all rows.

    Of several that vary together, value for value, the first stands for all.
    """
    places = np.flatnonzero((columns.scenario == scenario) & columns.ok)
    found: dict[str, Parts] = {}
    alike: set[bytes] = set()
    for name in columns.varied(places):
        own = parted(columns.numbers(name)[places])
        if own is None or own.place.tobytes() in alike:
            continue
        alike.add(own.place.tobytes())
        place: npt.NDArray[Any] = np.full(len(columns), -1, dtype=np.int8)  # small: a row each, for every parameter
        place[places] = own.place
        found[name] = Parts(place=place, low=own.low, high=own.high)
    return found


def cells(columns: Columns, summary: pd.DataFrame, best: int | None) -> dict[tuple[int, int], Cell]:
    """All cells by the places of scenario and detector.

    Parameters
    ----------
    columns : Columns
        The rows.
    summary : DataFrame
        Of the same rows.
    best : int or None
        Place of the detector that others are compared with.
    """
    lines = {(str(line["scenario"]), str(line["detector"])): line for line in summary.to_dict("records")}
    paired = _paired(columns, best)
    found = {}
    for s, scenario in enumerate(columns.scenarios):
        parts = _parts_of(columns, s)
        for d, detector in enumerate(columns.detectors):
            line = lines.get((scenario, detector))
            if line is not None:
                found[s, d] = _cell(columns, s, d, line, parts, paired.get((s, d)))
    return found | _fitted(columns, found, best)


def _fitted(columns: Columns, found: Mapping[tuple[int, int], Cell], best: int | None) -> dict[tuple[int, int], Cell]:
    """Cells with a detection curve: as many as there is time for, those of the best detector first."""
    could = [at for at, cell in found.items() if cell.size is not None and cell.size.could_be_fitted]
    chosen = sorted(could, key=lambda at: (at[1] != best, at[1], at[0]))[:_MOST_FITTED]
    return {at: with_curve(columns, found[at]) for at in chosen}


def with_curve(columns: Columns, cell: Cell) -> Cell:
    """The same cell with the detection curve of its flights, where they give one."""
    return replace(cell, size=size_curve(columns, _sure(columns, cell.scenario, cell.detector), fit=True))


def _sure(columns: Columns, s: int, d: int) -> "np.ndarray[Any, Any]":
    """Places of the decided flights of a cell."""
    places = columns.cell(s, d)
    sure: np.ndarray[Any, Any] = places[columns.ok[places] & columns.decided[places]]
    return sure


def _paired(columns: Columns, best: int | None) -> dict[tuple[int, int], tuple[PairedShares, float | None]]:
    """Each faulty cell beside the best detector, with p adjusted over its scenarios."""
    found: dict[tuple[int, int], tuple[PairedShares, float | None]] = {}
    if best is None:
        return found
    for d in range(len(columns.detectors)):
        own = {s: beside_best(columns, best, d, s) for s in range(len(columns.scenarios))} if d != best else {}
        own = {s: each for s, each in own.items() if each.pairs}
        adjusted = holm([np.nan if each.p_value is None else each.p_value for each in own.values()])
        for (s, each), p in zip(own.items(), adjusted, strict=True):
            found[s, d] = each, None if np.isnan(p) else float(p)
    return found


def _cell(
    columns: Columns,
    s: int,
    d: int,
    line: Line,
    parts: Mapping[str, Parts],
    paired: tuple[PairedShares, float | None] | None,
) -> Cell:
    places = columns.cell(s, d)
    flown = places[columns.ok[places]]
    faulty = bool(len(flown)) and not line["healthy"]
    failed = columns.failed[flown]
    sure = _sure(columns, s, d)
    own = {
        name: Parts(place=each.place[sure].astype(np.int64), low=each.low, high=each.high)
        for name, each in parts.items()
    }
    return Cell(
        scenario=s, detector=d, line=line,
        incidence=_incidence(columns, flown) if faulty else None,
        declared=_declared(columns, flown) if faulty else (),
        associations=associations(own, columns.failed[sure], columns.whole("run", sure), most=_MOST_PARTS),
        worst=_worst(columns, flown, failed),
        paired=paired[0] if paired else None, p_holm=paired[1] if paired else None,
        size=size_curve(columns, sure) if faulty else None,
    )  # fmt: skip


def _incidence(columns: Columns, flown: "np.ndarray[Any, Any]") -> Incidence:
    seen = columns.numbers("flight_s")[flown] - columns.numbers("onset_s")[flown]
    return incidence(
        columns.texts("outcome")[flown], found_s=columns.numbers("detection_time_s")[flown],
        wrong_s=columns.numbers("wrong_site_time_s")[flown], seen_s=seen, run=columns.whole("run", flown),
    )  # fmt: skip


def _declared(columns: Columns, flown: "np.ndarray[Any, Any]") -> list[tuple[str, str, int]]:
    """What was declared at the end beside what was true; rare pairs together as ``…``."""
    pairs = Counter(zip(columns.texts("faulty_sites")[flown], columns.texts("declared_sites")[flown], strict=True))
    common = pairs.most_common()
    found = [(str(true), str(said), n) for (true, said), n in common[:_MOST_DECLARED]]
    rest = sum(n for _, n in common[_MOST_DECLARED:])
    return [*found, ("…", "…", rest)] if rest else found


def _worst(columns: Columns, flown: "np.ndarray[Any, Any]", failed: "np.ndarray[Any, Any]") -> list[str]:
    """Five flights that failed, or where none did the slowest: healthy sites and false alarms first, then missed, then late."""
    outcome = columns.texts("outcome")[flown]
    named = {name: np.asarray(outcome == name, dtype=bool) for name in ("false_alarm", "wrong_site", "missed", "late")}
    rank = np.select([named["false_alarm"] | named["wrong_site"], named["missed"], named["late"]], [3, 2, 1], 0)
    slow = np.nan_to_num(columns.numbers("normalized_detection_time")[flown])
    margin = np.fmax(
        np.nan_to_num(columns.numbers("margin_healthy")[flown]),
        np.where(rank == 0, 0.0, np.nan_to_num(columns.numbers("margin_faulty")[flown])),
    )
    order = np.lexsort((-margin, -slow, -rank))
    chosen = flown[order[: min(_MOST_WORST, max(int(failed.sum()), 1))]]
    address = (columns.whole(name, chosen).tolist() for name in ("point", "level", "run"))
    return ["/".join(map(str, each)) for each in zip(*address, strict=True)]
