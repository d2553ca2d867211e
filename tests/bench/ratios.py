"""This engine against other ways to fly the same step."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from tests.bench import peers
from tests.bench.absent import AbsentError
from tests.bench.measure import Way, rates
from tests.bench.report import Line
from tests.bench.step import data

WIDE, FEW = 2208, 2
"""Runs side by side (the 2200 of the paper, and eight more to fill whole vectors), and runs flown one by one."""

# name, runs, asked, in words
PEERS: tuple[tuple[str, int, float | None, str], ...] = (
    ("numpy", WIDE, 15.0, "NumPy over 2208 runs"),
    ("one_by_one", FEW, 1000.0, "NumPy, one run after the other"),
    ("solve_ivp", FEW, None, "SciPy solve_ivp from sample to sample"),
    ("python_control", FEW, 300.0, "python-control input_output_response"),
    ("heyoka", WIDE, 1.7, "heyoka cfunc over 2208 runs"),
    ("jax", 256, 3.0, "JAX jit(vmap(lax.scan)), 256 runs, float64"),
    ("jsbsim", 1, 70.0, "JSBSim stepping its 737"),
)


def lines(*, repeats: int, turn_s: float) -> Iterator[Line]:
    """All comparisons: first the limit, then the peers."""
    for noise in (False, True):
        yield from _limit(noise, repeats=repeats, turn_s=turn_s)
    yield from _peers(repeats=repeats, turn_s=turn_s)


def _way(make: Callable[..., peers.Fly], runs: int) -> Way:
    return Way(fly=make(*data(runs)), runs=runs)


def _limit(noise: bool, *, repeats: int, turn_s: float) -> Iterator[Line]:
    what = "C++ by hand, fast-math" + (", noise on both sides" if noise else "")
    try:
        hand = {f"cpp{w}": _way(partial(peers.hand_written, noise=noise, lanes=w), 64) for w in (8, 16)}
    except AbsentError as reason:
        yield Line(what=what, note=str(reason))
        return
    found = rates({"ours": _way(partial(peers.engine, noise=noise), 64), **hand}, repeats=repeats, turn_s=turn_s)
    best = max(hand, key=lambda name: float(np.median(found[name])))
    note = (
        f"ours {_millions(found['ours'])}, theirs {_millions(found[best])} ({best[3:]} lanes, the better of 8 and 16)"
    )
    yield Line(what=what, values=found["ours"] / found[best], asked=None if noise else 0.8, note=note)


def _peers(*, repeats: int, turn_s: float) -> Iterator[Line]:
    ways, absent = {"ours": _way(peers.engine, WIDE)}, {}
    for name, runs, _, _ in PEERS:
        try:
            ways[name] = _way(getattr(peers, name), runs)
        except AbsentError as reason:
            absent[name] = str(reason)
    found = rates(ways, repeats=repeats, turn_s=turn_s)
    for name, _, asked, what in PEERS:
        if name in absent:
            yield Line(what=what, note=absent[name])
        else:
            yield Line(
                what=what, values=found["ours"] / found[name], asked=asked, note=f"theirs {_millions(found[name])}"
            )


def _millions(values: np.ndarray) -> str:
    return f"{float(np.median(values)) / 1e6:.3g} M/s"
