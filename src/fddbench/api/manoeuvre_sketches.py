"""A small sketch of each manoeuvre of a plant: its command or its motion over time, as a line of blocks."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import yaml

from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import Benchmark, Floats, Plant, Recording
from fddbench.runner.replay import replay_campaign

__all__ = ["blocks", "sketches"]

_BLOCKS = "▁▂▃▄▅▆▇█"
_WIDTH = 32


def blocks(values: Floats, low: float, high: float) -> str:
    """Values over time as blocks between two ends.

    >>> blocks(np.array([0.0, 0.5, 1.0]), 0.0, 1.0)
    '▁▅█'
    """
    span = high - low or 1.0
    places = np.clip(np.round((values - low) / span * (len(_BLOCKS) - 1)), 0, len(_BLOCKS) - 1).astype(int)
    return "".join(_BLOCKS[place] for place in places)


def sketches(bench: Benchmark, plant: Plant, name: str) -> dict[str, str]:
    """Sketch of every manoeuvre, flown once without dispersions; none of those that cannot be flown.

    Of all signals of a plant's pictures the one is drawn that moves most in that manoeuvre, against the most that it moves
    in any.
    """
    try:
        flights = _flights(bench, plant, name)
    except FddbenchError:
        return {}
    largest = {
        each: max(_span(flight.signals[each][:, 0]) for flight in flights.values())
        for each in next(iter(flights.values())).signals
    }
    moving = [each for each, span in largest.items() if span > 0.0]
    groups = _worth_drawing(bench, plant, moving)
    signals: list[str] = next((group for group in groups if group), [])
    found = {}
    for manoeuvre, flight in flights.items():
        if signals:
            best = max(signals, key=lambda each: round(_span(flight.signals[each][:, 0]) / largest[each], 3))
            found[manoeuvre] = _drawn(best, flight.signals[best][:, 0])
    return found


def _drawn(name: str, values: Floats) -> str:
    """Blocks, name and range; what moves by less than a millionth of its size stands still."""
    largest = float(np.abs(values).max())
    values = np.round(values, 6 - int(np.ceil(np.log10(largest)))) + 0.0 if largest > 0.0 else values
    low, high = float(values.min()), float(values.max())
    if low == high:
        return f"{name} {low:.3g} throughout"
    picked = values[np.linspace(0, len(values) - 1, _WIDTH).astype(int)]
    return f"{blocks(picked, low, high)}  {name} {low:.3g} … {high:.3g}"


def _span(values: Floats) -> float:
    return float(np.ptp(values)) if np.all(np.isfinite(values)) else 0.0


def _worth_drawing(bench: Benchmark, plant: Plant, moving: list[str]) -> tuple[list[str], ...]:
    """Moving signals in groups, the best first: commands, what the pictures show, what is measured or true."""
    told = {response.command for response in getattr(plant, "responses", ())} | set(getattr(bench, "commands", ()))
    return (
        [name for name in moving if name in told or "command" in name],
        [name for name in moving for shown in bench.shown if name in (shown, f"{shown}_1")],
        moving,
    )


def _flights(bench: Benchmark, plant: Plant, name: str) -> dict[str, Recording]:
    """Healthy flight of every manoeuvre."""
    content: dict[str, Any] = {"name": "sketches", "benchmark": bench.name, "seed": 0, "detectors": ["voting_monitor"]}
    content |= {"plant": name} if name else {}
    content["scenarios"] = [{"name": each, "manoeuvre": each} for each in plant.manoeuvres]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "sketches.yaml"
        path.write_text(yaml.safe_dump(content), encoding="utf-8")
        campaign = replace(read_campaign(path), designs=())  # a campaign has a detector; a sketch needs none
        return {recording.scenario: recording for recording in replay_campaign(campaign)}
