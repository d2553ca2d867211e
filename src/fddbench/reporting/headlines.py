"""The sentences at the top of the page: what was flown and what it says, the dangerous event first."""

from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.summary import rate_with_interval
from fddbench.reporting.formats import count, interval, percent, rate, seconds

__all__ = ["Sentence", "findings", "flown_sentence"]

Sentence = tuple[str, list[str]]


def flown_sentence(rows: pd.DataFrame) -> str:
    """How many flights, hours, detectors and failures."""
    if rows.empty:
        return "No flight: the table of results is empty."
    # plain truth values first: pandas 2 casts what a function makes of text back to text
    fates = {fate: np.asarray(rows["status"] == fate, dtype=bool) for fate in ("ok", "infeasible")}
    flights = (
        rows[["case", "flight_s"]]
        .assign(**fates)
        .groupby("case", sort=False)
        .agg(ok=("ok", "all"), infeasible=("infeasible", "any"), flight_s=("flight_s", "max"))
    )
    hours = float(flights["flight_s"].sum()) / 3600.0
    flown, infeasible = int(flights["ok"].sum()), int(flights["infeasible"].sum())
    number = {"flight": len(flights), "scenario": rows["scenario"].nunique(), "detector": rows["detector"].nunique()}
    many = {name: f"{count(n)} {name}{'' if n == 1 else 's'}" for name, n in number.items()}
    return (
        f"{many['flight']} in {many['scenario']}, {rate(hours)} flight hours scored by {many['detector']}: "
        f"{count(flown)} flown, {count(infeasible)} infeasible, "
        f"{count(len(flights) - flown - infeasible)} failed in at least one detector."
    )


def findings(summary: pd.DataFrame) -> list[Sentence]:
    """Return sentences with one phrase per detector; over-declaration, the dangerous event, first."""
    by_detector = {name: group for name, group in summary.groupby("detector", sort=False) if group["flown"].sum()}
    faulty = {name: group[~np.asarray(group["healthy"], dtype=bool)] for name, group in by_detector.items()}
    faulty = {name: group for name, group in faulty.items() if group["flown"].sum()}
    found: list[Sentence] = []
    if faulty:
        found.append(("More sites declared than faulty (drops good ones)", _each(faulty, "over_declared", "faulty")))
    if by_detector:
        found.append(("False alarms", [_alarms(str(name), group) for name, group in by_detector.items()]))
    if faulty:
        found.append(("Detected late or never", _each(faulty, "missed", "uncensored faulty")))
        found.append(("True detection", _each(faulty, "true_detection", "faulty")))
        found.append(("Slowest against its limit", [_slowest(str(name), group) for name, group in faulty.items()]))
    return found


def _each(groups: dict[Any, pd.DataFrame], name: str, of: str) -> list[str]:
    return [f"{detector} {_share(group, name)} {of} flights" for detector, group in groups.items()]


def _share(group: pd.DataFrame, name: str) -> str:
    hits, trials = int(group[name].sum()), int(group[f"{name}_trials"].sum())
    share = rate_with_interval("x", hits, trials)
    ends = interval(share["x_low_percent"], share["x_high_percent"])
    return f"{count(hits)} ({percent(share['x_percent'])} %; {ends}) of {count(trials)}"


def _alarms(detector: str, group: pd.DataFrame) -> str:
    return (
        f"{detector} in {_share(group, 'false_alarm')} flights, {float(group['exposure_h'].sum()):.3g} fault-free hours"
    )


def _slowest(detector: str, group: pd.DataFrame) -> str:
    ratio = group["normalized_detection_time_max"].to_numpy(dtype=np.float64, na_value=np.nan)
    if np.all(np.isnan(ratio)):
        return f"{detector} detected nothing"
    worst = group.iloc[int(np.nanargmax(ratio))]
    limit_s, time_s = worst["detection_time_limit_s"], seconds(worst["detection_time_max_s"])
    return f"{detector} {time_s} s in {worst['scenario']}, {np.nanmax(ratio):.2f} of the limit of {limit_s:g} s"
