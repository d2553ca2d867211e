"""Flies the loop of the yaw-rate benchmark without a campaign around it."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.benchmarks.yaw_rate import YawRate
from fddbench.detection.sliding_mode import SlidingMode
from fddbench.detection.sliding_mode.gains import SlidingModeGains
from fddbench.interfaces import Flights, Options

BENCHMARK = YawRate()
DEFAULTS = {parameter.name: parameter.default for parameter in BENCHMARK.parameters}


def make_loop(**options):
    chosen = {"plant": "lateral_lpv", "voter": "median", "sensors": "ideal", "wind": "none"}
    return BENCHMARK.loop(Options(**{**chosen, "sample_s": 0.01, "substeps": 1, "fault_slots": 1, **options}))


def start(loop, n_cases, *, manoeuvres="cruise", faults=None, normals=None, **parameters):
    """Start of `n_cases` flights; `faults` is one list of faults for all, or one list per case."""
    values = {name: np.full(n_cases, float(value)) for name, value in DEFAULTS.items()}
    values |= {name: np.broadcast_to(np.asarray(value, float), n_cases).copy() for name, value in parameters.items()}
    phases = np.full((loop.faults.slots, 3, 1), 0.5)
    faults = [[]] * n_cases if faults is None else faults
    return loop.start(
        Flights(
            parameters=values,
            manoeuvres=[manoeuvres] * n_cases if isinstance(manoeuvres, str) else manoeuvres,
            faults=np.concatenate([loop.fault_rows(one, phases) for one in faults], axis=1),
            normals=np.zeros((4, n_cases)) if normals is None else normals,
        )
    )


def fly(loop, n_cases, duration_s, *, draws=None, detector=None, **more):
    """Signals by name, (n_time, n_cases) or (n_time, rows, n_cases), of flights all of one length."""
    begun = start(loop, n_cases, **more)
    state, found = begun.state, {}
    inner = detector.start(n_cases) if detector else None
    n = round(duration_s / loop.sample_s) + 1
    n_normals = 4 * (len(loop.consumers) + len(loop.fault_consumers))
    draws = np.zeros((n, n_normals, n_cases)) if draws is None else draws
    for k in range(n):
        before = state
        state, measured, truth, departed = loop.step(state, begun.constants, draws[k], float(k))
        signals = {**truth, **vars(measured), "departed": departed, "state": before}
        if detector:
            inner, verdict = detector.step(inner, measured)
            signals |= {"declared": verdict.declared, "ratio": verdict.ratio, **verdict.signals}
        for name, value in signals.items():
            found.setdefault(name, []).append(np.array(value))
    return {name: np.array(values) for name, values in found.items()}


def sliding_mode(loop):
    text = (gallery.folder("detectors") / "sliding_mode_published.yaml").read_text(encoding="utf-8")
    return SlidingMode.from_design(SlidingModeGains(**yaml.safe_load(text)["gains"]), loop.bus)


@pytest.fixture(scope="session")
def bench():
    """Namespace of the functions above; test modules are not packages and cannot import them."""
    return SimpleNamespace(loop=make_loop, start=start, fly=fly, sliding_mode=sliding_mode, benchmark=BENCHMARK)
