"""Flies the jet engine without a campaign around it."""

import numpy as np
import pytest

from fddbench import kinds
from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.interfaces import FlightFaults, Flights, Options

BENCHMARK = JetEngine()
DEFAULTS = {parameter.name: parameter.default for parameter in BENCHMARK.parameters}


class Bench:
    benchmark = BENCHMARK

    def loop(self, plant="norm_bounded", sample_s=0.05, faults=(), substeps=1):
        """Loop for the faults of one scenario."""
        chosen = {"plant": BENCHMARK.choices["plant"].options[plant]}
        return BENCHMARK.loop(Options(chosen=chosen, sample_s=sample_s, substeps=substeps, faults=[tuple(faults)]))

    def fault(self, kind, **entry):
        return kinds.load("fault", kind).in_unit("")(kind=kind, **entry)

    def start(self, loop, n_cases, *, manoeuvre="idle", faults=(), normals=None, **parameters):
        """Constants and states; disturbances off unless asked for."""
        values = {name: np.full(n_cases, float(v)) for name, v in DEFAULTS.items()}
        values |= {"disturbance_scale_ratio": np.zeros(n_cases)}
        values |= {name: np.full(n_cases, float(v)) for name, v in parameters.items()}
        uniform = np.full((len(faults), 3, n_cases), 0.5)
        which = np.zeros(n_cases, dtype=int)
        prepared = loop.prepare(
            Flights(
                parameters=values,
                manoeuvres=[manoeuvre] * n_cases,
                faults=FlightFaults(lists=[tuple(faults)], which=which, uniform=uniform),
                normals=loop.before.unpack(np.zeros((24, n_cases)) if normals is None else normals),
            )
        )
        assert set(prepared.infeasible_reason) == {""}
        constants = loop.constants.spread(prepared.constants, n_cases)
        return constants, loop.states.spread(loop.start(constants), n_cases)

    def fly(self, loop, n_cases, duration_s, *, seed=0, **more):
        """Signals by name, (n_time, rows, n_cases)."""
        random = np.random.default_rng(seed)
        constants, state = self.start(loop, n_cases, normals=random.standard_normal((24, n_cases)), **more)
        found = {}
        for k in range(round(duration_s / loop.sample_s) + 1):
            drawn = loop.draws.unpack(random.standard_normal((loop.draws.size, n_cases)))
            state, seen = loop.step(state, constants, drawn, float(k))
            for name, value in {**seen.truth, **vars(seen.measured)}.items():
                found.setdefault(name, []).append(np.array(value))
        return {name: np.array(series) for name, series in found.items()}


@pytest.fixture
def bench():
    return Bench()
