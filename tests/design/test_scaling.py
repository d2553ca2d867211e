"""Law: γ is the same in all units of time, states, signals and Δ, and grows with the reference."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench.design.reference_search import optimize_reference
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import RepeatedReal, Structured
from fddbench.design.weights import Weights
from fddbench.systems import StateSpace

IDENTITY = StateSpace.gain(np.eye(3))


def scaled(reference: StateSpace, size: float) -> StateSpace:
    return StateSpace(reference.A, reference.B, size * reference.C, size * reference.D)


@pytest.mark.parametrize("size", [1e-6, 1e-4, 1e-2, 7.0, 1e3, 1e6])
@pytest.mark.parametrize("name", ["identity", "init"])
def test_gamma_grows_with_the_reference(engine, printed, name, size):
    design = synthesize(engine, scaled(printed(name), size))
    assert design.certificate.holds
    assert design.moderate.certificate.holds
    expected = synthesize(engine, printed(name))
    assert design.gamma == pytest.approx(size * expected.gamma, rel=1e-4)
    assert design.moderate.gamma == pytest.approx(size * expected.moderate.gamma, rel=1e-4)
    assert design.lower_bound == pytest.approx(size * expected.lower_bound, rel=1e-4)
    assert design.idle_gamma == pytest.approx(size * expected.idle_gamma, rel=1e-9)


def states(plant, seed: int):
    x = 10.0 ** np.random.default_rng(seed).uniform(-4.0, 4.0, plant.n_x)
    rows = {name: getattr(plant, name) / x[:, None] for name in ("Bf", "Bd", "B", "FA")}
    columns = {name: getattr(plant, name) * x for name in ("C", "EA")}
    return replace(plant, A=plant.A * x / x[:, None], **rows, **columns)


def outputs(plant, seed: int):
    y = 10.0 ** np.random.default_rng(seed).uniform(-4.0, 4.0, plant.n_y)
    return replace(plant, **{name: y[:, None] * getattr(plant, name) for name in ("C", "Df", "Dd", "D", "FC")})


def time(plant, seed: int):
    rate = (1e-4, 1e4)[seed % 2]
    return replace(plant, **{name: rate * getattr(plant, name) for name in ("A", "Bf", "Bd", "B", "FA")})


def channel(plant, seed: int):
    size = (1e-4, 1e4)[seed % 2]
    entered = {name: size * getattr(plant, name) for name in ("FA", "FC")}
    return replace(plant, **entered, **{name: getattr(plant, name) / size for name in ("EA", "Ef", "Ed", "EB")})


@pytest.mark.parametrize("change", [states, outputs, time, channel])
@pytest.mark.parametrize("seed", [0, 1])
def test_units_do_not_matter(engine, for_identity, change, seed):
    design = synthesize(change(engine, seed), IDENTITY)
    assert design.certificate.holds
    assert design.moderate.certificate.holds
    assert design.gamma == pytest.approx(for_identity.gamma, rel=1e-4)
    assert design.lower_bound == pytest.approx(for_identity.lower_bound, rel=1e-4)


def test_units_of_a_structured_delta_do_not_matter(engine):
    blocks = Structured((RepeatedReal(1),) * 3)
    sizes = np.array([1e-3, 1.0, 1e3])
    changed = replace(
        engine,
        FA=engine.FA * sizes, FC=engine.FC * sizes,
        **{name: getattr(engine, name) / sizes[:, None] for name in ("EA", "Ef", "Ed", "EB")},
        H=engine.H * sizes / sizes[:, None],
    )  # fmt: skip
    found, expected = (synthesize(plant, IDENTITY, blocks, relax=None) for plant in (changed, engine))
    assert found.gamma == pytest.approx(expected.gamma, rel=1e-4)


@pytest.mark.parametrize("name", ["W_f", "W_d", "W_u"])
def test_units_of_faults_disturbances_and_inputs_are_what_weights_take_back(engine, for_identity, name):
    size = 10.0 ** np.random.default_rng(3).uniform(-3.0, 3.0, 3)
    columns = {"W_f": ("Bf", "Df", "Ef"), "W_d": ("Bd", "Dd", "Ed"), "W_u": ("B", "D", "EB")}[name]
    changed = replace(engine, **{field: getattr(engine, field) / size for field in columns})
    reference = StateSpace.gain(np.diag(1.0 / size)) if name == "W_f" else IDENTITY
    design = synthesize(changed, reference, weights=Weights(**{name: np.diag(size)}), relax=None)
    assert design.gamma == pytest.approx(for_identity.gamma, rel=1e-4)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.slow
def test_algorithm_1_ends_at_the_optimum_from_random_starts(engine, seed):
    """Remark 9: other starts end at the same γ."""
    random = np.random.default_rng(seed)
    start = StateSpace.diagonal(
        -random.uniform(0.2, 5.0, 3), np.ones(3), random.uniform(0.1, 1.5, 3), random.uniform(1.0, 3.0, 3)
    )
    search = optimize_reference(engine, start, relax=None, iterations=25)
    assert search.design.gamma == pytest.approx(0.33400, abs=2e-5)
    assert search.design.certificate.holds
    assert search.lower_bound == pytest.approx(0.333998, abs=2e-6)
