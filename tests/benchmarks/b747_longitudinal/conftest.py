"""Flies the loop of the longitudinal benchmark without a campaign around it."""

from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.benchmarks.b747_longitudinal import B747Longitudinal
from fddbench.benchmarks.b747_longitudinal.parameters import PARAMETERS
from fddbench.blocks import kernel, llvm
from fddbench.blocks.block import program
from fddbench.interfaces import FlightFaults, Flights, Options

BENCHMARK = B747Longitudinal()
DEFAULTS = {parameter.name: parameter.default for parameter in PARAMETERS}


def make_loop(*, faults=(), sample_s=0.04, substeps=1, **names):
    """Loop of what is chosen by name, or given itself; `faults` are those of every scenario that will fly."""
    names = {"plant": "nonlinear", "law": "open_loop", "sensors": "ideal", "wind": "none", **names}
    chosen = {
        key: BENCHMARK.choices[key].options[name] if isinstance(name, str) else name for key, name in names.items()
    }
    return BENCHMARK.loop(Options(chosen=chosen, sample_s=sample_s, substeps=substeps, faults=tuple(faults)))


def parameters(n_cases, **given):
    """Every parameter of `n_cases` flights."""
    return {
        name: np.broadcast_to(np.asarray(given.get(name, value), dtype=float), n_cases).copy()
        for name, value in DEFAULTS.items()
    }


def prepare(loop, n_cases, *, manoeuvre="level", faults=None, normals=None, **given):
    """Flights made ready; `faults` is a list of faults for each."""
    faults = [[]] * n_cases if faults is None else faults
    slots = max(map(len, faults))
    return loop.prepare(
        Flights(
            parameters=parameters(n_cases, **given),
            manoeuvres=[manoeuvre] * n_cases,
            faults=FlightFaults(
                lists=faults, which=np.arange(n_cases), uniform=np.full((slots, len(loop.bus.sites), n_cases), 0.5)
            ),
            normals=loop.before.unpack(np.zeros((loop.before.size, n_cases)) if normals is None else normals),
        )
    )


def _shown(seen):
    return {**vars(seen.measured), **seen.truth, "departed": np.where(seen.departed, 1.0, 0.0), "added": seen.added}


def fly(loop, n_cases, duration_s, *, declared_from_s=None, backend=None, **more):
    """Signals by name, (n_time, n_cases); `added` is (n_time, n_sites, n_cases)."""
    prepared = prepare(loop, n_cases, **more)
    assert set(prepared.infeasible_reason) == {""}
    flown = loop if declared_from_s is None else Declared(loop, declared_from_s)
    constants = loop.constants.pack(prepared.constants, n_cases)
    state = loop.states.pack(loop.start(loop.constants.unpack(constants)), n_cases)
    built = kernel.build(
        program(flown, shown=_shown),
        streams=loop.draws.streams,
        recorded=(*loop.bus.signals, *loop.truth, "departed", "added"),
        backend=backend or ("llvm" if llvm.available() else "numpy"),
    )
    samples = np.full(n_cases, round(duration_s / loop.sample_s) + 1, dtype=np.int64)
    number = np.arange(n_cases, dtype=np.uint64)
    addresses = kernel.Addresses(key=1, run=number, flight=0, scenario=number)
    tape = built.fly(state, constants, samples, addresses, first=0, end=int(samples[0])).recorded
    return {name: rows if name == "added" else rows[:, 0] for name, rows in tape.items()}


class Declared:
    """The loop, told from a time on that its elevator is declared."""

    def __init__(self, loop, from_s):
        self.loop, self.first = loop, from_s / loop.sample_s
        self.states, self.constants, self.draws = loop.states, loop.constants, loop.draws

    def step(self, x, c, n, sample):
        told = np.where(sample >= self.first, 1.0, 0.0)
        return self.loop.step(x, c, n, sample, declared=np.stack([told, 0.0 * told]))


@pytest.fixture(scope="session")
def bench():
    return SimpleNamespace(loop=make_loop, fly=fly, prepare=prepare, parameters=parameters, benchmark=BENCHMARK)
