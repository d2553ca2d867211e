"""Judges requirements on a detector by its rows, one bounded number an aircraft (`fddbench.metrics.requirements`)."""

from collections.abc import Iterator, Mapping

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.metrics.distinct import distinct_flights
from fddbench.metrics.evidence import Evidence, Rate, Share, aircraft_needed, ends, known_at
from fddbench.metrics.requirements import OF_FAULTS, Judgement, PlannedFlights, Requirement

__all__ = ["judged"]

_FLIGHT = ["run", "point", "manoeuvre"]
"""Columns that rows of one detector share which are one flight until their onsets."""


def judged(
    required: Requirement,
    rows: pd.DataFrame,
    planned: Mapping[str, PlannedFlights],
    *,
    detector: str,
    by: str = "",
    in_sample: bool = False,
) -> Iterator[Judgement]:
    """Judgements on one detector: one, or one for each value of a column.

    Only the first runs without a gap count of which all flights of these scenarios are there, in the order of the runs, so
    that no order in which flights come has a part in it. Where scenarios have numbers of runs of their own, the least counts.

    Parameters
    ----------
    rows : DataFrame
        Columns `fddbench.metrics.requirements.NEEDS` and `by` of the detector.
    planned : mapping of str to PlannedFlights
        By name of the scenario.
    by : str
        Column whose values are judged one by one: ``scenario``, or that of a parameter of the grid.
    """
    own = {name: planned[name] for name in required.scenarios}
    used, mine = _complete(rows, own)
    parts = mine.groupby(by, sort=False) if by and used else [("", mine)]
    for value, part in parts:
        group = _group(by, value) if by and used else ""
        at = (str(value),) if by == "scenario" and value else required.scenarios
        evidence = _evidence(required, part, {name: own[name] for name in at}, used)
        yield _judgement(
            required,
            evidence,
            who=(detector, group, at, in_sample),
            runs=(used, min(each.runs for each in own.values())),
            flights=(len(part) // max(used, 1), int(_failed(part).sum())),
        )


def _group(by: str, value: object) -> str:
    """A part of the flights by its name, ``gust_scale 2``."""
    return f"{by.removeprefix('p_')} {value:.6g}" if isinstance(value, float) else f"{by} {value!s}"


def _judgement(
    required: Requirement,
    evidence: Evidence,
    *,
    who: tuple[str, str, tuple[str, ...], bool],
    runs: tuple[int, int],
    flights: tuple[int, int],
) -> Judgement:
    """Judgement by evidence; `flights` of an aircraft, and how many failed."""
    limit, confidence, used = required.limit, required.confidence, runs[0]
    met = known_at(evidence, limit, confidence, more=required.at_least)
    broken = known_at(evidence, limit, confidence, more=not required.at_least)
    # whichever came first: it stays what it is when more is flown
    first = min((at for at in (met, broken) if at is not None), default=None)
    needed = used if first else aircraft_needed(evidence, limit, confidence)
    besides = None if needed is None else max(needed - used, 0 if first else 1)
    low, high = ends(evidence, limit, confidence)
    return Judgement(
        name=required.name,
        detector=who[0],
        of=required.of,
        group=who[1],
        scenarios=who[2],
        verdict="undecided" if first is None else "pass" if first == met else "fail",
        value=evidence.value,
        low=low,
        high=high,
        at_least=required.at_least,
        limit=limit,
        within=required.within,
        confidence=confidence,
        runs_used=used,
        runs_planned=runs[1],
        decided_at=first,
        runs_needed=besides,
        flights_needed=None if besides is None else besides * flights[0],
        failed=flights[1],
        in_sample=who[3],
    )


def _complete(rows: pd.DataFrame, own: Mapping[str, PlannedFlights]) -> tuple[int, pd.DataFrame]:
    """How many of the first runs have all their flights, and these."""
    run = rows["run"].to_numpy(dtype=np.int64)
    n_runs = min(each.runs for each in own.values())
    chosen = np.asarray(rows["scenario"].isin(list(own)), dtype=bool) & (run < n_runs)
    there = np.bincount(run[chosen], minlength=n_runs)
    short = np.flatnonzero(there < sum(each.points * each.levels for each in own.values()))
    used = int(short[0]) if len(short) else n_runs
    return used, rows[chosen & (run < used)]


def _evidence(required: Requirement, rows: pd.DataFrame, own: Mapping[str, PlannedFlights], used: int) -> Evidence:
    """What the first `used` runs tell."""
    if required.of not in OF_FAULTS:
        return _alarms(required, rows, own, used)
    outcome = np.asarray(rows["outcome"].fillna("undecided"), dtype=str)
    hit = {
        "right_share": outcome == "right",
        "wrong_site_share": outcome == "wrong_site",
        "normalized_detection_time": np.isin(outcome, ["right", "late"]) & _within(rows, required.within),
    }[required.of]
    run = rows["run"].to_numpy(dtype=np.int64)
    counts = [_sums(run, of, used) for of in (hit, outcome != "undecided", _failed(rows))]
    return Share(hits=counts[0], decided=counts[1], failed=counts[2], rows=max(len(rows) // max(used, 1), 1))


def _alarms(required: Requirement, rows: pd.DataFrame, own: Mapping[str, PlannedFlights], used: int) -> Evidence:
    """Alarms of distinct flights: each aircraft flies every point and manoeuvre once until the onsets."""
    flights = distinct_flights(rows)
    healthy_h, lost = _healthy_h(rows[np.asarray(rows["run"] == 0, dtype=bool)], own), _lost(rows)
    run, gone = flights.run.astype(np.int64), lost["run"].to_numpy(dtype=np.int64)
    alarms, failed = _sums(run, flights.alarm, used), _sums(gone, np.ones(len(gone)), used)
    each = max(len(healthy_h), 1)
    if required.of == "false_alarm_share":
        return Share(hits=alarms, decided=_sums(run, np.ones(len(run)), used), failed=failed, rows=each)
    unknown_h = healthy_h.reindex(pd.MultiIndex.from_frame(lost[_FLIGHT[1:]])).to_numpy(dtype=np.float64)
    return Rate(
        alarms=alarms,
        hours=_sums(run, flights.time_s / 3600.0, used),
        failed=failed,
        failed_hours=_sums(gone, unknown_h, used),
        flights=each,
        most_hours=max(float(healthy_h.sum()), 1e-9),
    )


def _healthy_h(aircraft: pd.DataFrame, own: Mapping[str, PlannedFlights]) -> "pd.Series[float]":
    """Longest planned healthy flight of each distinct flight of an aircraft [h]; that of all is the same."""
    keys = _flight(aircraft)
    planned = keys.assign(hours=[own[str(name)].healthy_h for name in aircraft["scenario"]])
    return planned.groupby(_FLIGHT[1:], sort=False)["hours"].max()


def _lost(rows: pd.DataFrame) -> pd.DataFrame:
    """Distinct flights that nobody knows: one of their rows failed and none gave a score."""
    failed = _failed(rows)
    if not failed.any():
        return _flight(rows.iloc[:0])
    known = _flight(rows[np.asarray(rows["status"] == "ok", dtype=bool)]).drop_duplicates()
    both = _flight(rows[failed]).drop_duplicates().merge(known, how="left", indicator=True)
    return both[both["_merge"] == "left_only"]


def _flight(rows: pd.DataFrame) -> pd.DataFrame:
    return rows[_FLIGHT].astype({"run": np.int64, "point": np.int64, "manoeuvre": object})


def _failed(rows: pd.DataFrame) -> npt.NDArray[np.bool_]:
    return ~np.asarray(rows["status"].isin(["ok", "infeasible"]), dtype=bool)


def _within(rows: pd.DataFrame, most: float | None) -> npt.NDArray[np.bool_]:
    times = rows["normalized_detection_time"].to_numpy(dtype=np.float64, na_value=np.nan)
    return np.asarray(times <= (np.inf if most is None else most), dtype=bool)


def _sums(runs: npt.NDArray[np.int64], of: npt.NDArray[np.generic], used: int) -> Floats:
    """Sum over the entries of each run, (used,)."""
    return np.bincount(runs, weights=np.asarray(of, dtype=np.float64), minlength=used).astype(np.float64)
