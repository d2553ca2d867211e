"""Flies the loop of the yaw-rate benchmark without a campaign around it."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.benchmarks.yaw_rate import YawRate
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode import SlidingMode
from fddbench.detection.sliding_mode.gains import SlidingModeGains
from fddbench.interfaces import FlightFaults, Flights, Options

BENCHMARK = YawRate()
DEFAULTS = {parameter.name: parameter.default for parameter in LateralLpvPlant.parameters}


def make_loop(*, faults=(), sample_s=0.01, substeps=1, **names):
    """Loop of what is chosen by name, or given itself; `faults` are those of every scenario that will fly."""
    names = {"plant": "lateral_lpv", "voter": "median", "sensors": "ideal", "wind": "none", **names}
    chosen = {
        key: BENCHMARK.choices[key].options[name] if isinstance(name, str) else name for key, name in names.items()
    }
    return BENCHMARK.loop(Options(chosen=chosen, sample_s=sample_s, substeps=substeps, faults=tuple(faults)))


def start(loop, n_cases, *, manoeuvres="cruise", faults=None, normals=None, **parameters):
    """Constants and states of `n_cases` flights; `faults` is a list of faults for each, `normals` by `loop.before`."""
    values = {name: np.full(n_cases, float(value)) for name, value in DEFAULTS.items()}
    values |= {name: np.broadcast_to(np.asarray(value, float), n_cases).copy() for name, value in parameters.items()}
    faults = [[]] * n_cases if faults is None else faults
    slots = max(map(len, faults))
    prepared = loop.prepare(
        Flights(
            parameters=values,
            manoeuvres=[manoeuvres] * n_cases if isinstance(manoeuvres, str) else manoeuvres,
            faults=FlightFaults(
                lists=faults, which=np.arange(n_cases), uniform=np.full((slots, len(loop.bus.sites), n_cases), 0.5)
            ),
            normals=loop.before.unpack(np.zeros((loop.before.size, n_cases)) if normals is None else normals),
        )
    )
    constants = loop.constants.spread(prepared.constants, n_cases)
    return constants, loop.states.spread(loop.start(constants), n_cases)


def fly(loop, n_cases, duration_s, *, draws=None, detector=None, **more):
    """Signals by name, (n_time, n_cases) or (n_time, rows, n_cases), of flights all of one length.

    `draws`, (n_time, rows, n_cases), are the normals in the order of `loop.draws`; `state` is the packed state.
    """
    constants, state = start(loop, n_cases, **more)
    nothing, found = Nothing(), {}
    inner = detector.states.spread(detector.start(nothing), n_cases) if detector else None
    n = round(duration_s / loop.sample_s) + 1
    draws = np.zeros((n, loop.draws.size, n_cases)) if draws is None else draws
    for k in range(n):
        before = loop.states.pack(state, n_cases)
        state, seen = loop.step(state, constants, loop.draws.unpack(draws[k]), float(k))
        signals = {**seen.truth, **vars(seen.measured), "departed": seen.departed, "state": before}
        if detector:
            inner, verdict = detector.step(inner, nothing, nothing, seen.measured)
            signals |= {"declared": verdict.declared, "residual": verdict.residual, **verdict.signals}
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
