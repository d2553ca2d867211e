"""The sentences at the top of the page: what was flown and what it says, the dangerous event first."""

from collections.abc import Collection
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.shares import decided, pools, share
from fddbench.reporting.formats import count, interval, percent, present, rate, seconds

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


def findings(rows: pd.DataFrame, alarms: pd.DataFrame, in_sample: Collection[str] = ()) -> list[Sentence]:
    """Sentences with one phrase per detector; healthy sensors declared, the dangerous event, first.

    Parameters
    ----------
    rows, alarms : DataFrame
        As ``fddbench.load`` and `fddbench.metrics.alarms.summarize_alarms` give them.
    in_sample : collection of str
        Detectors that were tuned on these flights.
    """
    flown = rows[np.asarray(rows["status"] == "ok", dtype=bool)]
    faulty = flown[np.asarray(flown["n_faulty"] > 0, dtype=bool)]
    groups = {str(name): group for name, group in faulty.groupby("detector", sort=False)}
    called = {
        str(name): f"{name} (in sample)" if name in in_sample else str(name) for name in rows["detector"].unique()
    }
    found: list[Sentence] = []
    if groups:
        found.append(
            ("Healthy sites declared", [_share(called[name], own, "wrong_site") for name, own in groups.items()])
        )
    lines = [line for line in alarms.to_dict("records") if line["distinct_flights"]]
    if lines:
        found.append(("False alarms", [_alarms(called[str(line["detector"])], line) for line in lines]))
    if groups:
        found.append(("Missed or late", [_share(called[name], own, "missed", "late") for name, own in groups.items()]))
        found.append(("Right: found in time", [_right(called[name], own) for name, own in groups.items()]))
        found.append(("Slowest against its limit", [_slowest(called[name], own) for name, own in groups.items()]))
    return found


def _share(detector: str, flown: pd.DataFrame, *names: str) -> str:
    """Share of the decided flights with one of these outcomes, with what it pools."""
    sure = flown[decided(flown)]
    if sure.empty:
        return f"{detector} none of {count(len(flown))} faulty flights decided"
    hits = np.asarray(sure["outcome"].isin(names), dtype=bool)
    of = share("x", hits, sure["run"])
    ends = interval(of["x_low_percent"], of["x_high_percent"])
    pooled = pools(sure, "scenario", "point", "level")
    inside = "; ".join(filter(None, (f"{percent(of['x_percent'])} %", ends, f"pools {pooled}" if pooled else "")))
    return f"{detector} {count(hits.sum())} of {count(len(sure))} decided faulty flights ({inside})"


def _right(detector: str, flown: pd.DataFrame) -> str:
    undecided = len(flown) - int(decided(flown).sum())
    return _share(detector, flown, "right") + (f", {count(undecided)} more undecided" if undecided else "")


def _alarms(detector: str, line: dict[Any, Any]) -> str:
    ends = interval(line["alarms_low_percent"], line["alarms_high_percent"])
    hourly = interval(line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"], rate)
    inside = "; ".join(filter(None, (f"{percent(line['alarms_percent'])} %", ends, _pooled(line))))
    per_hour = line["false_alarm_per_hour"]
    often = f", {rate(per_hour)} per hour{f' ({hourly})' if hourly else ''}" if present(per_hour) else ""
    return (
        f"{detector} in {count(line['alarms'])} of {count(line['distinct_flights'])} distinct flights ({inside}), "
        f"{line['exposure_h']:.3g} healthy hours up to the first alarm{often}"
    )


def _pooled(line: dict[Any, Any]) -> str:
    return f"pools {line['pools']}" if present(line["pools"]) else ""


def _slowest(detector: str, flown: pd.DataFrame) -> str:
    ratio = flown["normalized_detection_time"].to_numpy(dtype=np.float64, na_value=np.nan)
    if np.all(np.isnan(ratio)):
        return f"{detector} found nothing"
    worst = flown.iloc[int(np.nanargmax(ratio))]
    limit_s, time_s = worst["detection_time_limit_s"], seconds(worst["detection_time_s"])
    return f"{detector} {time_s} s in {worst['scenario']}, {np.nanmax(ratio):.2f} of the limit of {limit_s:g} s"
