"""Rates of several ways to fly, taken in turn so that a busy neighbour slows all of them alike."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.bench.peers import Fly


@dataclass(frozen=True, kw_only=True)
class Way:
    """A way to fly.

    Attributes
    ----------
    fly : callable
        Flies samples 0 ... n - 1 of all its runs.
    runs : int
        How many those are.
    """

    fly: Fly
    runs: int


def rates(ways: Mapping[str, Way], *, repeats: int, turn_s: float) -> dict[str, np.ndarray]:
    """Run-steps per CPU second, (repeats,) by name; the first turn of each, which warms up, is not counted."""
    samples = {name: _samples(way, turn_s) for name, way in ways.items()}
    found: dict[str, list[float]] = {name: [] for name in ways}
    for turn in range(repeats + 1):
        for name, way in ways.items():
            begun = time.process_time()
            way.fly(samples[name])
            if turn:
                found[name].append(way.runs * samples[name] / (time.process_time() - begun))
    return {name: np.array(values) for name, values in found.items()}


def _samples(way: Way, turn_s: float) -> int:
    """Samples that last about `turn_s`."""
    n = 2
    while True:
        way.fly(n)  # whatever is compiled or cached for this length
        begun = time.process_time()
        way.fly(n)
        spent = time.process_time() - begun
        if spent > 0.1 * turn_s or n >= 6000:
            return int(np.clip(n * turn_s / max(spent, 1e-6), 2, 6000))
        n *= 8


def spread(values: Sequence[float], digits: int = 3) -> str:
    """Least, middle and largest value, to some significant digits."""
    low, middle, high = (np.format_float_positional(v, precision=digits, fractional=False, trim="-")
                         for v in (min(values), float(np.median(values)), max(values)))  # fmt: skip
    return f"{low} / {middle} / {high}"
