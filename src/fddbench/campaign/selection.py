"""A part of a campaign in words: ``scenario=jam_a,detector=voting_monitor,run=0-99``."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.campaign.plan import Plan
from fddbench.errors import FddbenchError, did_you_mean

__all__ = ["selected"]

_NAMES, _NUMBERS = ("scenario", "detector"), ("point", "level", "run")
Chosen = npt.NDArray[np.bool_]


def selected(plan: Plan, words: Sequence[str]) -> Chosen:
    """Whether a row belongs to a part of a campaign, (n_detectors, n_cases).

    Parameters
    ----------
    plan : Plan
        Case table.
    words : sequence of str
        ``key=value,key=value``; keys are scenario, detector, point, level and run. Values of a key that is named several times
        are joined, different keys narrow each other. Numbers may be ranges, ``run=0-99``, the last included. Several texts
        are several parts, all of which are chosen.

    Raises
    ------
    FddbenchError
        A key or value that there is not, or nothing is chosen; all mistakes at once.
    """
    detectors = [design.name for design in plan.campaign.designs]
    known = {"scenario": [each.name for each in plan.scenarios], "detector": detectors}
    at = plan.locate(np.arange(plan.n_cases))
    mistakes: list[str] = []
    chosen = np.zeros((len(detectors), plan.n_cases), dtype=bool)
    for text in words:
        entries = _entries(text, known, mistakes)
        cases = np.ones(plan.n_cases, dtype=bool)
        for key in _NUMBERS:
            cases &= _within(getattr(at, key), entries.get(key))
        if "scenario" in entries:
            cases &= np.isin(at.scenario, [known["scenario"].index(name) for name in entries["scenario"]])
        rows = [name in entries.get("detector", detectors) for name in detectors]
        if not mistakes and not cases.any():
            mistakes.append(f"{text!r} chooses no flight: the campaign has {_shape(plan)}")
        chosen |= np.array(rows)[:, None] & cases
    if mistakes:
        raise FddbenchError("--only: " + "\n        ".join(mistakes))
    return chosen


def _entries(text: str, known: Mapping[str, Sequence[str]], mistakes: list[str]) -> dict[str, list[Any]]:
    """Values by key of one part."""
    found: dict[str, list[Any]] = {}
    for entry in text.split(","):
        key, is_there, value = (part.strip() for part in entry.partition("="))
        if not is_there or key not in (*_NAMES, *_NUMBERS):
            hint = did_you_mean(key, (*_NAMES, *_NUMBERS))
            mistakes.append(
                f"need KEY=VALUE,... with the keys {', '.join((*_NAMES, *_NUMBERS))}, got {entry!r}. {hint}".rstrip()
            )
        elif key in _NAMES:
            if value not in known[key]:
                hint = did_you_mean(value, known[key])
                mistakes.append(f"no {key} {value!r}. {hint} Known: {', '.join(known[key])}".replace("  ", " "))
                continue
            found.setdefault(key, []).append(value)
        else:
            first, is_range, last = value.partition("-")
            last = last if is_range else first
            if not all(part.isascii() and part.isdigit() for part in (first, last)) or int(first) > int(last):
                mistakes.append(f"{key} needs a number or a range such as 0-99, got {value!r}")
                continue
            found.setdefault(key, []).append((int(first), int(last)))
    return found


def _within(numbers: npt.NDArray[np.int64], ranges: Sequence[tuple[int, int]] | None) -> Chosen:
    if ranges is None:
        return np.ones(len(numbers), dtype=bool)
    within: Chosen = np.any([(numbers >= first) & (numbers <= last) for first, last in ranges], axis=0)
    return within


def _shape(plan: Plan) -> str:
    """Points, levels and runs that there are."""
    shapes = [(each.n_points, each.n_levels, each.n_runs) for each in plan.scenarios]
    return ", ".join(f"{key}s 0 to {max(n) - 1}" for key, n in zip(_NUMBERS, zip(*shapes, strict=True), strict=True))
