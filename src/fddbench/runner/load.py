"""What a detector costs on a flight computer: its step counted, and timed on this machine."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks import kernel, llvm
from fddbench.blocks.accounting import Cost, cost
from fddbench.blocks.layout import Nothing, Rows
from fddbench.blocks.program import trace
from fddbench.designs.adapted import Adapted
from fddbench.designs.tracing import detector_program
from fddbench.interfaces import Bus
from fddbench.runner.verdicts import verdicts_of

__all__ = ["DetectorLoad", "detector_load", "in_words", "seconds_in_python"]

_CASES, _SAMPLES, _REPEATS = 256, 500, 5


@dataclass(frozen=True, kw_only=True)
class DetectorLoad:
    """Load of one step of a detector.

    Attributes
    ----------
    cost : Cost or None
        Operations, state and tables of a step; None for a detector that cannot be traced.
    nanoseconds : float or None
        Time of a sample of one flight in compiled code on this machine [ns], the fastest of several; None without a compiler.
    opaque : str
        Why it cannot be traced; "" when it can.
    every : int
        It steps at every so manieth sample.
    """

    cost: Cost | None
    nanoseconds: float | None
    opaque: str = ""
    every: int = 1

    @property
    def flops_a_sample(self) -> float | None:
        """Floating-point operations a sample of the benchmark, its steps spread over the samples between them."""
        return None if self.cost is None else self.cost.flops / self.every


def detector_load(detector: Adapted, bus: Bus, *, timed: bool = True) -> DetectorLoad:
    """Count the operations of one step, and time it unless told not to."""
    if detector.opaque:
        return DetectorLoad(cost=None, nanoseconds=None, opaque=detector.opaque, every=detector.every)
    nanoseconds = _nanoseconds(detector, bus) if timed and llvm.available() else None
    program = detector_program(detector.at_every_sample, bus).keep("state", "declared", "alarm", "residual")
    return DetectorLoad(cost=cost(program), nanoseconds=nanoseconds, every=detector.every)


def _nanoseconds(detector: Adapted, bus: Bus) -> float:
    """Time of one step of one flight [ns], on signals that change with every sample and case."""
    places, size = {}, 0
    for name, rows in bus.signals.items():
        places[name], size = slice(size, size + rows) if rows else size, size + (rows or 1)

    def step(state: Rows, constants: Rows, normals: Rows, sample: Any) -> Mapping[str, Rows]:
        moving = constants + 1e-3 * sample
        measured = SimpleNamespace(**{name: moving[place] for name, place in places.items()})
        x, n = detector.states.unpack(state[: detector.states.size]), detector.draws.unpack(normals)
        after, verdict = detector.step(x, Nothing(), n, measured)
        # the verdict must be part of the state, or it would not be computed
        decided = [verdict.declared, verdict.alarm[np.newaxis], verdict.residual[np.newaxis]]
        return {"state": np.concatenate([detector.states.pack(after), *decided])}

    extra = len(bus.sites) + 2
    program = trace(step, state=detector.states.size + extra, constants=size, normals=detector.draws.size, sample=0)
    compiled = kernel.build(program, streams=detector.draws.streams, backend="llvm")
    begun = detector.states.spread(detector.start(Nothing()), _CASES)
    state = np.concatenate([detector.states.pack(begun, _CASES), np.zeros((extra, _CASES))])
    constants = 0.01 * np.arange(1.0, size + 1.0)[:, np.newaxis] + 1e-4 * np.arange(_CASES)
    samples = np.full(_CASES, _SAMPLES, dtype=np.int64)
    addresses = kernel.Addresses(key=0, run=0, flight=0, scenario=0)
    best = np.inf
    for _ in range(_REPEATS):
        clock_s = time.perf_counter()
        compiled.fly(state, constants, samples, addresses, first=0, end=_SAMPLES)
        best = min(best, time.perf_counter() - clock_s)
    return best / (_CASES * _SAMPLES) * 1e9


def in_words(load: DetectorLoad) -> str:
    """Load of a step in one line."""
    if load.cost is None:
        return f"opaque, runs in Python: {load.opaque}"
    timed = "" if load.nanoseconds is None else f"; {load.nanoseconds:.0f} ns in compiled code here"
    slow = f", a step every {load.every} samples: {load.flops_a_sample:.4g} a sample" if load.every > 1 else ""
    return (
        f"{load.cost.flops} floating-point operations a step{slow}, {load.cost.multiply_adds} of them multiply-add pairs; "
        f"state {load.cost.state_bytes} B, tables {load.cost.table_bytes} B{timed}"
    )


def seconds_in_python(detector: Adapted, samples: Sequence[SimpleNamespace]) -> float:
    """Time of one step in Python on real samples [s]: of one flight for a detector that sees one at a time, else of all.

    The mean over the samples, the fastest of several repeats; infinite if it raises on every flight.
    """
    n_cases = len(next(iter(vars(samples[0]).values())).T)
    flights = range(n_cases) if detector.one_by_one else range(1)
    with np.errstate(all="ignore"):
        return min(
            (_mean_seconds(detector, samples, n_cases, i) for i in flights for _ in range(_REPEATS)), default=np.inf
        )


def _mean_seconds(detector: Adapted, samples: Sequence[SimpleNamespace], n_cases: int, flight: int) -> float:
    """Mean time of a step [s]; infinite if it raises."""
    active, normals = np.zeros(n_cases, dtype=bool), np.zeros((detector.draws.size, n_cases))
    active[flight] = True
    verdicts, spent = verdicts_of(detector, n_cases), 0.0
    for measured in samples:
        clock_s = time.perf_counter()
        verdicts.step(normals, measured, active)
        spent += time.perf_counter() - clock_s
    return np.inf if verdicts.raised[flight] else spent / len(samples)
