"""Flies the loop with six degrees of freedom compiled, without a campaign around it."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.benchmarks.yaw_rate import YawRate
from fddbench.benchmarks.yaw_rate.plants.transport_6dof import Transport6Dof
from fddbench.blocks.block import program
from fddbench.blocks.flown import Addresses
from fddbench.blocks.kernel import build
from fddbench.interfaces import FlightFaults, Flights, Options

BENCHMARK = YawRate()
SIGNALS = (
    *("phi_true_deg", "theta_true_deg", "psi_deg", "beta_true_deg", "alpha_true_deg", "p_true_deg_s", "n_z_true_g"),
    *("altitude_true_ft", "v_cas_true_kt", "mach", "r_true_deg_s", "y_m"),
)
TABLE_5 = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T


def make_loop(*, plant=Transport6Dof, faults=(), sample_s=0.01, substeps=1, **names):
    """Loop of what is chosen by name."""
    names = {"voter": "median", "sensors": "white", "wind": "none", **names}
    chosen = {key: BENCHMARK.choices[key].options[name] for key, name in names.items()}
    return BENCHMARK.loop(
        Options(chosen={"plant": plant, **chosen}, sample_s=sample_s, substeps=substeps, faults=tuple(faults))
    )


def prepared(loop, condition, manoeuvres, *, faults=None, seed=0, **parameters):
    """Why flights cannot fly, their constants and states."""
    n = condition.shape[1]
    values = {p.name: np.full(n, p.default) for p in loop.plant.parameters}
    values |= dict(zip(("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt"), np.array(condition), strict=True))
    values |= {name: np.broadcast_to(np.asarray(v, float), n).copy() for name, v in parameters.items()}
    faults = [[]] * n if faults is None else faults
    uniform = np.full((max(map(len, faults)), len(loop.bus.sites), n), 0.5)
    flights = Flights(
        parameters=values,
        manoeuvres=[manoeuvres] * n if isinstance(manoeuvres, str) else list(manoeuvres),
        faults=FlightFaults(lists=faults, which=np.arange(n), uniform=uniform),
        normals=loop.before.unpack(np.random.default_rng(seed).standard_normal((loop.before.size, n))),
    )
    ready = loop.prepare(flights)
    constants = loop.constants.spread(ready.constants, n)
    return ready.infeasible_reason, constants, loop.states.spread(loop.start(constants), n)


def kernel_of(loop, signals=SIGNALS, **how):
    """Kernel that records some true signals and departures."""

    def shown(seen):
        rows = {name: np.stack([seen.truth[name]]) for name in signals}
        return {**rows, "departed": np.stack([seen.departed])}

    made = program(loop, shown=shown)
    return build(made, streams=loop.draws.streams, recorded=(*signals, "departed"), **how)


def fly(loop, condition, manoeuvres, *, seconds=60.0, kernel=None, seed=1, **more):
    """Why flights cannot fly, and signals by name, (n_time, n_cases)."""
    reasons, constants, state = prepared(loop, condition, manoeuvres, **more)
    n, end = condition.shape[1], round(seconds / loop.sample_s) + 1
    flown = (kernel or kernel_of(loop)).fly(
        loop.states.pack(state, n),
        loop.constants.pack(constants, n),
        np.full(n, end),
        Addresses(key=seed, run=np.arange(n), flight=np.zeros(n), scenario=np.zeros(n)),
        first=0,
        end=end,
    )
    return np.array(reasons), {name: rows[:, 0] for name, rows in flown.recorded.items()}


@pytest.fixture(scope="session")
def six():
    """Namespace of the above; test modules are not packages and cannot import them."""
    return SimpleNamespace(
        loop=make_loop,
        prepared=prepared,
        kernel=kernel_of,
        fly=fly,
        table_5=TABLE_5,
        plant=Transport6Dof,
        signals=SIGNALS,
    )
