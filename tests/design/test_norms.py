"""Law: the Hamiltonian's norm is never below a dense grid and is attained; slycot, where installed, agrees."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.design.norms import hinf_norm, hminus_index
from fddbench.errors import DesignError
from fddbench.systems import StateSpace

GRID = np.concatenate([[0.0], np.logspace(-3, 3, 600), [np.inf]])


def random_system(seed: int, order: int, inputs: int, outputs: int) -> StateSpace:
    random = np.random.default_rng(seed)
    A = random.standard_normal((order, order))
    A -= (np.linalg.eigvals(A).real.max() + random.uniform(0.01, 1.0)) * np.eye(order)
    B, C, D = (random.standard_normal(shape) for shape in ((order, inputs), (outputs, order), (outputs, inputs)))
    return StateSpace(A, B, C, D)


systems = st.builds(random_system, st.integers(0, 10**6), st.integers(1, 8), st.integers(1, 3), st.integers(1, 3))


@given(systems)
@settings(max_examples=15, deadline=None)
def test_norm_bounds_a_dense_grid_and_is_attained(system):
    norm = hinf_norm(system)
    on_grid = max(np.linalg.norm(system.at(w), 2) for w in GRID)
    assert on_grid <= norm.value * (1.0 + 1e-7)
    assert np.linalg.norm(system.at(norm.frequency), 2) == pytest.approx(norm.value, rel=1e-12)


@given(systems)
@settings(max_examples=15, deadline=None)
def test_index_is_below_a_dense_grid_and_attained(system):
    index = hminus_index(system)
    if system.D.shape[0] < system.D.shape[1]:
        assert index.value == 0.0
        return
    on_grid = min(np.linalg.svd(system.at(w), compute_uv=False)[-1] for w in GRID)
    assert index.value <= on_grid * (1.0 + 1e-7)
    assert np.linalg.svd(system.at(index.frequency), compute_uv=False)[-1] == pytest.approx(index.value, abs=1e-12)


@given(systems)
@settings(max_examples=15, deadline=None)
def test_norm_is_that_of_slycot(system):
    slycot = pytest.importorskip("slycot")
    (n, m), p = system.B.shape, len(system.C)
    peak = slycot.ab13dd("C", "I", "N", "D", n, m, p, system.A, np.eye(n), system.B, system.C, system.D, 1e-9)[0]
    assert hinf_norm(system).value == pytest.approx(peak, rel=1e-6)


def test_resonance_has_its_textbook_peak():
    damping = 1e-4
    system = StateSpace(
        np.array([[0.0, 1.0], [-1.0, -2.0 * damping]]),
        np.array([[0.0], [1.0]]),
        np.array([[1.0, 0.0]]),
        np.zeros((1, 1)),
    )
    norm = hinf_norm(system)
    assert norm.value == pytest.approx(1.0 / (2.0 * damping * np.sqrt(1.0 - damping**2)), rel=1e-7)
    assert norm.frequency == pytest.approx(np.sqrt(1.0 - 2.0 * damping**2), rel=1e-6)


def test_first_order_references_have_their_smallest_gain_at_the_ends():
    reference = StateSpace.diagonal([-2.0, -1.0], [1.0, 1.0], [1.0, -0.5], [1.0, 3.0])
    assert hminus_index(reference).value == pytest.approx(1.0)
    assert hminus_index(StateSpace.gain(np.diag([2.0, 0.5]))).value == 0.5


def test_an_unstable_system_has_no_norm():
    with pytest.raises(DesignError, match="infinite"):
        hinf_norm(StateSpace.diagonal([0.1], [1.0], [1.0], [0.0]))
