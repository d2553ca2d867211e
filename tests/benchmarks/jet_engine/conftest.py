"""Flies the jet engine without a campaign around it."""

import numpy as np
import pytest

from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.interfaces import Flights, Options

BENCHMARK = JetEngine()
DEFAULTS = {parameter.name: parameter.default for parameter in BENCHMARK.parameters}


class Bench:
    def loop(self, plant="norm_bounded", sample_s=0.05, fault_slots=3):
        chosen = {"voter": "", "sensors": "", "wind": "", "substeps": 1}
        return BENCHMARK.loop(Options(plant=plant, sample_s=sample_s, fault_slots=fault_slots, **chosen))

    def fault(self, kind, **entry):
        from fddbench import registry

        return registry.load("fault", kind).in_unit("")(kind=kind, **entry)

    def fly(self, loop, n_cases, duration_s, *, manoeuvre="idle", faults=(), seed=0, detector=None, **parameters):
        """Signals by name, (n_time, rows, n_cases); disturbances off unless asked for."""
        values = {name: np.full(n_cases, float(v)) for name, v in DEFAULTS.items()}
        values |= {"disturbance_scale_ratio": np.zeros(n_cases)}
        values |= {name: np.full(n_cases, float(v)) for name, v in parameters.items()}
        random = np.random.default_rng(seed)
        begun = loop.start(
            Flights(
                parameters=values,
                manoeuvres=[manoeuvre] * n_cases,
                faults=np.repeat(
                    loop.fault_rows(list(faults), np.full((loop.faults.slots, 3, 1), 0.5)), n_cases, axis=1
                ),
                normals=random.standard_normal((24, n_cases)),
            )
        )
        state, found = begun.state, {}
        inner = detector.start(n_cases) if detector else None
        for k in range(round(duration_s / loop.sample_s) + 1):
            draws = random.standard_normal((4 * (1 + loop.faults.slots), n_cases))
            state, measured, truth, _ = loop.step(state, begun.constants, draws, float(k))
            signals = {**truth, **vars(measured)}
            if detector:
                inner, verdict = detector.step(inner, measured)
                signals |= {"declared": verdict.declared, "ratio": verdict.ratio, **verdict.signals}
            for name, value in signals.items():
                found.setdefault(name, []).append(np.array(value))
        return {name: np.array(series) for name, series in found.items()}


@pytest.fixture
def bench():
    return Bench()
