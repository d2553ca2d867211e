"""The first flights of a campaign, to try things on before all the others."""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.reconfiguration import nothing_declared, told

__all__ = ["FIRST", "first_flights", "first_samples"]

FIRST = 8
"""Flights that a detector is tried on; part of the result where it fails on all of them."""

_AT_ONCE, _SAMPLES = 64, 3


def first_flights(assembly: Assembly, most: int = FIRST) -> Batch | None:
    """The first cases of the plan that can be flown, at most so many; None where none can."""
    n_cases, found, cases = assembly.plan.n_cases, None, np.empty(0, dtype=np.int64)
    for first in range(0, n_cases, _AT_ONCE):
        batch = assembly.batch(np.arange(first, min(first + _AT_ONCE, n_cases), dtype=np.int64))
        able = [case for case, reason in zip(batch.cases, batch.infeasible_reason, strict=True) if not reason]
        cases = np.concatenate([cases, np.array(able, dtype=np.int64)])[:most]
        if len(cases) == most:
            break
    if len(cases):
        found = assembly.batch(cases)
    return found


def first_samples(assembly: Assembly, count: int = _SAMPLES, most: int = FIRST) -> Sequence[SimpleNamespace]:
    """What is measured at the first samples of the first flights, nothing declared; empty where none can be flown."""
    batch, shown = first_flights(assembly, most), []
    if batch is None:
        return ()
    loop = assembly.loop
    state, constants = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    more = told(assembly, nothing_declared(assembly, len(batch.cases)))
    with np.errstate(all="ignore"):
        for sample, drawn in enumerate(assembly.normals(loop.draws, batch, 0, count)):
            state, seen = loop.step(state, constants, loop.draws.unpack(drawn), np.float64(sample), **more)
            shown.append(seen.measured)
    return shown
