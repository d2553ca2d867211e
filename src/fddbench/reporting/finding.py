"""What a campaign found, in at most ten lines of Markdown that are written from its rows by rules."""

from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.shares import decided, share
from fddbench.reporting.drawn import is_drawn
from fddbench.reporting.formats import count, interval, percent, present, rate, seconds, shorts
from fddbench.reporting.headlines import flown_sentence

__all__ = ["MOST_LINES", "finding_text"]

MOST_LINES = 10
_MOST = 8
"""Detectors that a line names; of more the first half and the last one."""
_VALUES = 12
"""Values of a sweep that a line names."""

Groups = Mapping[str, pd.DataFrame]


def finding_text(
    rows: pd.DataFrame,
    alarms: pd.DataFrame,
    *,
    title: str,
    question: str,
    swept: Collection[str] = (),
    in_sample: Collection[str] = (),
    apart: Collection[str] = (),
    footer: str = "",
) -> str:
    """Markdown: the question, at most ten numbered lines, and where they come from.

    Parameters
    ----------
    rows, alarms : DataFrame
        As ``fddbench.load`` and ``fddbench.alarms`` give them.
    title, question : str
        Name of the campaign, and what it asks.
    swept : collection of str
        Columns of the rows along which the right share is told: what a grid or sweep varies.
    in_sample : collection of str
        Detectors that were tuned on these flights.
    apart : collection of str
        Detectors that see the voted signal alone: they stand in a line of their own, for they see less than the others.
    footer : str
        Provenance.
    """
    flown = rows[np.asarray(rows["status"] == "ok", dtype=bool)]
    faulty = flown[np.asarray(flown["n_faulty"] > 0, dtype=bool)]
    groups = {str(name): group for name, group in faulty.groupby("detector", sort=False)}
    sees = {True: "Right in time, of those that see the voted signal alone", False: "Right in time"}
    lines = [flown_sentence(rows)]
    for alone, head in sees.items():
        own = {name: group for name, group in groups.items() if (name in apart) == alone}
        lines += _ranked(head, own, _called(in_sample), "right")
        lines += _weakest(own, "Weakest scenario") if not alone else []
    # the line of those with all sensors comes first
    lines[1:] = sorted(lines[1:], key=lambda line: line.startswith(sees[True]))
    lines += _ranked("Healthy sites declared", groups, _called(in_sample), "wrong_site", worst_first=True)
    lines += _false_alarms(alarms, _called(in_sample))
    lines += _ranked("Missed or late", groups, _called(in_sample), "missed", "late", worst_first=True)
    for name in swept:
        lines += _along(name, groups)
    lines += _slowest(groups, _called(in_sample))
    lines += _not_flown(rows)
    numbered = "".join(f"{i}. {line}\n" for i, line in enumerate(lines[:MOST_LINES], 1))
    return "\n\n".join(filter(None, [f"# {title}", question, numbered])) + (f"\n{footer}\n" if footer else "")


def _called(in_sample: Collection[str]) -> Callable[[str], str]:
    """Name of a detector in a sentence."""
    return lambda name: f"{name} (in sample)" if name in in_sample else name


def _several(head: str, phrases: list[str]) -> list[str]:
    """One line of phrases in their order; of too many those in the middle are counted."""
    if not phrases:
        return []
    if len(phrases) > _MOST:
        left = len(phrases) - _MOST
        phrases = [*phrases[: _MOST - 1], f"{count(left)} more between", phrases[-1]]
    return [f"{head}: {'; '.join(phrases)}."]


def _ranked(
    head: str, groups: Groups, called: Callable[[str], str], *outcomes: str, worst_first: bool = False
) -> list[str]:
    """Shares of the decided flights with these outcomes, largest first; what has none stands together at the end."""
    found: list[tuple[float, str]] = []
    nothing = []
    for name, group in groups.items():
        sure = group[decided(group)]
        hits = np.asarray(sure["outcome"].isin(outcomes), dtype=bool)
        if worst_first and not hits.any() and len(sure):
            nothing.append(called(name))
        elif len(sure):
            found.append((float(hits.mean()), f"{called(name)} {_share(sure, hits)}"))
    phrases = [text for _, text in sorted(found, key=lambda each: -each[0])]
    if nothing:
        phrases.append(f"never by {', '.join(nothing)}" if len(nothing) <= _MOST else f"never by {len(nothing)} others")
    return _several(head, phrases)


def _share(sure: pd.DataFrame, hits: Any) -> str:
    """``97.2 % (96.0 … 98.1; 972 of 1 000)``."""
    of = share("x", hits, sure["run"])
    inside = (interval(of["x_low_percent"], of["x_high_percent"]), f"{count(hits.sum())} of {count(len(sure))}")
    return f"{percent(of['x_percent'])} % ({'; '.join(filter(None, inside))})"


def _right(group: pd.DataFrame) -> tuple[int, int]:
    sure = group[decided(group)]
    return int(np.sum(np.asarray(sure["outcome"] == "right", dtype=bool))), len(sure)


def _weakest(groups: Groups, head: str) -> list[str]:
    """Scenario in which each detector is right least often, where it is not always right."""
    found = []
    for name, group in groups.items():
        counts = {str(each): _right(own) for each, own in group.groupby("scenario", sort=False)}
        shares = {each: hits / n for each, (hits, n) in counts.items() if n}
        if shares and min(shares.values()) < 1.0:
            least = min(shares, key=lambda each: shares[each])
            found.append((-float(np.mean(list(shares.values()))), name, least, counts[least]))
    phrases = [f"{name} in {least}, right in {count(k)} of {count(n)}" for _, name, least, (k, n) in sorted(found)]
    return _several(head, phrases)


def _false_alarms(alarms: pd.DataFrame, called: Callable[[str], str]) -> list[str]:
    """False alarms of distinct flights, and of the silent ones the rate that is not excluded."""
    lines = [line for line in alarms.to_dict("records") if line["distinct_flights"]]
    loud = sorted(
        (line for line in lines if line["alarms"]), key=lambda line: -line["alarms"] / line["distinct_flights"]
    )
    phrases = [f"{called(str(line['detector']))} in {_of(line)}{_per_hour(line)}" for line in loud]
    quiet: dict[int, list[Mapping[Any, Any]]] = {}
    for line in lines:
        if not line["alarms"]:
            quiet.setdefault(int(line["distinct_flights"]), []).append(line)
    for same in quiet.values():
        high = [line["false_alarm_high_per_hour"] for line in same if present(line["false_alarm_high_per_hour"])]
        names = (
            ", ".join(called(str(line["detector"])) for line in same)
            if len(same) <= _MOST
            else f"{len(same)} detectors"
        )
        upper = f" (up to {rate(max(high))} per hour at 95 %)" if high else ""
        phrases.append(f"none in {_of(same[0], all_=True)} by {names}{upper}")
    return _several("False alarms", phrases)


def _of(line: Mapping[Any, Any], *, all_: bool = False) -> str:
    flights = f"{count(line['distinct_flights'])} distinct flight{'' if line['distinct_flights'] == 1 else 's'}"
    return flights if all_ else f"{count(line['alarms'])} of {flights}"


def _per_hour(line: Mapping[Any, Any]) -> str:
    """``, 0.3 per hour (0.1 … 0.7)``."""
    if not present(line["false_alarm_per_hour"]):
        return ""
    ends = interval(line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"], rate)
    return f", {rate(line['false_alarm_per_hour'])} per hour{f' ({ends})' if ends else ''}"


def _along(name: str, groups: Groups) -> list[str]:
    """Right share of each detector along the values of a column, in percent."""
    phrases, shown = [], []
    for detector, group in groups.items():
        values = group[name].to_numpy(dtype=float, na_value=np.nan)
        known = np.unique(values[~np.isnan(values)])
        if 1 < len(known) <= _VALUES and not is_drawn(values, group["run"].to_numpy(dtype=float)):
            counts = [_right(group[values == value]) for value in known]
            shown = shorts(known.tolist())
            phrases.append(f"{detector} {', '.join(percent(100.0 * k / n) if n else '–' for k, n in counts)}")
    return _several(f"Right [%] at {name} = {', '.join(shown)}", phrases)


def _slowest(groups: Groups, called: Callable[[str], str]) -> list[str]:
    """Largest share of its limit that a detection took."""
    phrases = []
    for name, group in groups.items():
        ratio = group["normalized_detection_time"].to_numpy(dtype=float, na_value=np.nan)
        if not np.all(np.isnan(ratio)):
            worst = group.iloc[int(np.nanargmax(ratio))]
            time_s = seconds(worst["detection_time_s"])
            phrases.append(f"{called(name)} {time_s} s in {worst['scenario']} ({np.nanmax(ratio):.2f} of the limit)")
    return _several("Slowest", phrases)


def _not_flown(rows: pd.DataFrame) -> list[str]:
    """Rows without a score, by status."""
    status = rows["status"].value_counts()
    others = {str(name): int(n) for name, n in status.items() if name != "ok"}
    return _several("Not scored", [f"{count(n)} rows {name}" for name, n in others.items()])
