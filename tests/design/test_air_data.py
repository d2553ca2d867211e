"""Literature: a badly scaled plant, outputs from 0.002 to 400 a unit, a phugoid with a decay of 0.002 rad/s.

Frequency bounds are computed here by themselves, with no solver: what the wanted residual asks of the directions that the
outputs do not show at one frequency, over a dense grid.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench.design.norms import hinf_norm
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import Polytope
from fddbench.systems import StateSpace, UncertainPlant

MODELS = yaml.safe_load((Path(__file__).parent / "air_data.yaml").read_text(encoding="utf-8"))["models"]
IDENTITY = StateSpace.gain(np.eye(2))


@cache
def air_data(mass: int, noise: float) -> UncertainPlant:
    """Faults on outputs 2 and 4, wind and noise on all outputs as disturbances."""
    A, B, C, D = (np.array(MODELS[mass][name]) for name in "ABCD")
    white = noise * np.eye(8) if noise else np.zeros((8, 0))
    return UncertainPlant(
        A=A, Bf=np.zeros((4, 2)), Bd=np.hstack([B[:, 3:], np.zeros((4, white.shape[1]))]), B=B[:, :3],
        C=C, Df=np.eye(8)[:, [1, 3]], Dd=np.hstack([D[:, 3:], white]), D=D[:, :3],
    )  # fmt: skip


def frequency_bound(plant: UncertainPlant) -> float:
    n_f, n_d, n_u = plant.inputs
    wanted = np.eye(2, n_f + n_d + n_u)
    system = StateSpace(
        plant.A, np.hstack([plant.Bf, plant.Bd, plant.B]), plant.C, np.hstack([plant.Df, plant.Dd, plant.D])
    )
    bound = 0.0
    for w in (0.0, *np.geomspace(1e-3, 1e3, 400), np.inf):
        seen = np.vstack([system.at(w), np.eye(n_u, n_f + n_d + n_u, n_f + n_d)])
        bound = max(bound, float(np.linalg.norm(wanted - wanted @ np.linalg.pinv(seen, rcond=1e-12) @ seen, 2)))
    return bound


@pytest.mark.parametrize(("noise", "gamma"), [(1.0, 0.8323), (0.1, 0.59374), (0.01, 0.58883)])
def test_the_optimum_is_found_and_proved_on_both_sides(noise, gamma):
    plant = air_data(0, noise)
    design = synthesize(plant, IDENTITY)
    assert design.gamma == pytest.approx(gamma, abs=5e-5)
    assert design.certificate.holds
    bound = frequency_bound(plant)
    assert design.lower_bound == pytest.approx(bound, rel=1e-4)
    assert bound * (1.0 - 1e-6) <= design.gamma <= 1.002 * bound
    for proven in (design, design.moderate):
        assert hinf_norm(proven.loops[0].at(np.zeros((0, 0)))).value < proven.gamma
        assert proven.filter.as_system().stable()
    assert np.abs(np.linalg.eigvals(design.moderate.filter.Ak)).max() < 10.0


def test_without_noise_a_static_filter_follows_exactly():
    design = synthesize(air_data(0, 0.0), IDENTITY)
    assert design.exact
    assert design.gamma <= 1e-9
    assert design.lower_bound == 0.0
    assert design.certificate.holds
    assert design.filter.Ak.shape == (0, 0)
    assert hinf_norm(design.loops[0].at(np.zeros((0, 0)))).value < design.gamma
    assert design.moderate.gamma == design.gamma


@pytest.mark.parametrize("noise", [1.0, 0.1])
def test_two_masses_have_a_common_lyapunov_matrix(noise):
    plants = (air_data(0, noise), air_data(1, noise))
    design = synthesize(plants[0], IDENTITY, Polytope(plants), relax=None)
    assert design.certificate.holds
    assert max(frequency_bound(plant) for plant in plants) <= design.gamma < 0.9
    assert max(hinf_norm(loop.at(np.zeros((0, 0)))).value for loop in design.loops) < design.gamma


@pytest.mark.parametrize("noise", [1.0, 0.1])
def test_units_of_states_and_outputs_do_not_matter(noise):
    plant, random = air_data(0, noise), np.random.default_rng(5)
    x, y = 10.0 ** random.uniform(-3.0, 3.0, 4), 10.0 ** random.uniform(-3.0, 3.0, 8)
    changed = UncertainPlant(
        A=plant.A * x / x[:, None], Bf=plant.Bf / x[:, None], Bd=plant.Bd / x[:, None], B=plant.B / x[:, None],
        C=y[:, None] * plant.C * x, Df=y[:, None] * plant.Df, Dd=y[:, None] * plant.Dd, D=y[:, None] * plant.D,
    )  # fmt: skip
    found, expected = (synthesize(p, IDENTITY, relax=None) for p in (changed, plant))
    assert found.certificate.holds
    assert found.gamma == pytest.approx(expected.gamma, rel=1e-4)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 30.0, 1e6])
def test_the_problem_is_homogeneous_in_the_reference(size):
    plant = air_data(0, 0.1)
    design = synthesize(plant, StateSpace.gain(size * np.eye(2)))
    assert design.certificate.holds
    assert design.moderate.certificate.holds
    expected = synthesize(plant, IDENTITY)
    assert design.gamma == pytest.approx(size * expected.gamma, rel=1e-4)
    assert design.moderate.gamma == pytest.approx(size * expected.moderate.gamma, rel=1e-4)
    assert design.lower_bound == pytest.approx(size * expected.lower_bound, rel=1e-4)
