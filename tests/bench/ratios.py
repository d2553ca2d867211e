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
)


def lines(*, repeats: int, turn_s: float) -> Iterator[Line]:
    """All comparisons: first the limit, then the peers."""
    yield from _limit("C++ by hand, fast-math", 0.8, repeats=repeats, turn_s=turn_s)
    yield from _limit("  exact as ours, nothing fused", None, repeats=repeats, turn_s=turn_s, exact=True)
    yield from _limit("  fast-math, noise on both sides", None, repeats=repeats, turn_s=turn_s, noise=True)
    yield from _peers(repeats=repeats, turn_s=turn_s)


def _way(make: Callable[..., peers.Fly], runs: int) -> Way:
    return Way(fly=make(*data(runs)), runs=runs)


def _limit(
    what: str, asked: float | None, *, repeats: int, turn_s: float, noise: bool = False, exact: bool = False
) -> Iterator[Line]:
    made = {f"cpp{w}": partial(peers.hand_written, noise=noise, lanes=w, exact=exact) for w in (8, 16)}
    try:
        hand = {name: _way(make, 64) for name, make in made.items()}
    except AbsentError as reason:
        yield Line(what=what, note=str(reason))
        return
    found = rates({"ours": _way(partial(peers.engine, noise=noise), 64), **hand}, repeats=repeats, turn_s=turn_s)
    best = max(hand, key=lambda name: float(np.median(found[name])))
    note = (
        f"ours {_millions(found['ours'])}, theirs {_millions(found[best])} ({best[3:]} lanes, the better of 8 and 16)"
    )
    yield Line(what=what, values=found["ours"] / found[best], asked=asked, note=note)


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
