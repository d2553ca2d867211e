"""What can be freed of unknown inputs, and the condition that fails where it cannot."""

import numpy as np
import pytest

from fddbench.benchmarks.jet_engine.plant import MATRICES as JET
from fddbench.design.parity import best_parity_vector, extended, parity_vectors
from fddbench.design.unknown_input import decoupled
from fddbench.errors import DesignError

RNG = np.random.default_rng(11)
A = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, -1.0]])
"""The example of Chen and Patton (1999), section 3.3: two of three states measured, one disturbance."""
C = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
NONE = np.zeros((3, 0)), np.zeros((2, 0))


def test_an_observer_of_what_is_left_is_moved_by_no_unknown_input():
    E = np.array([[-1.0], [0.0], [0.0]])
    free = decoupled(A, NONE[0], C, NONE[1], E_x=E, E_y=np.zeros((2, 1)), what="d")
    np.testing.assert_allclose(free.T @ E, 0.0, atol=1e-12)
    # z = T x obeys z' = T A x with no d: along any d the two stay together
    x, z = RNG.standard_normal(3), None
    z = free.T @ x
    for _ in range(200):
        d = 100.0 * RNG.standard_normal(1)
        x, z = x + 0.01 * (A @ x + E @ d), z + 0.01 * free.T @ A @ x
    np.testing.assert_allclose(z, free.T @ x, atol=1e-9)


def test_an_input_that_the_outputs_hold_at_once_is_solved_for():
    E_x, E_y = RNG.standard_normal((3, 1)), np.array([[1.0], [2.0]])
    free = decoupled(A, NONE[0], C, NONE[1], E_x=E_x, E_y=E_y, what="d")
    assert free.S.shape == (1, 2)
    np.testing.assert_allclose(free.S @ E_y, 0.0, atol=1e-12)
    x, d = RNG.standard_normal(3), RNG.standard_normal(1)
    np.testing.assert_allclose(free.A @ x + free.B_y @ (C @ x + E_y @ d), A @ x + E_x @ d, atol=1e-12)


@pytest.mark.parametrize(
    ("E_x", "E_y", "message"),
    [
        (np.eye(3)[:, :2], np.zeros((2, 2)), r"2 independent ones leave none of the 2 outputs"),
        (np.eye(3)[:, 1:2], np.zeros((2, 1)), r"rank\(C E\) = 0, rank\(E\) = 1, they must be equal"),
    ],
)
def test_the_condition_that_fails_is_named(E_x, E_y, message):
    with pytest.raises(DesignError, match=f"no unknown-input observer for the gust: {message}"):
        decoupled(A, NONE[0], C, NONE[1], E_x=E_x, E_y=E_y, what="the gust")


def test_a_zero_in_the_right_half_plane_is_named():
    unstable = np.array([[1.0, 0.0], [0.0, -1.0]])
    with pytest.raises(DesignError, match=r"not detectable, nothing sees its eigenvalue 1.*right half plane"):
        decoupled(
            unstable, np.zeros((2, 0)), np.array([[0.0, 1.0], [0.0, 1.0]]), np.zeros((2, 0)),
            E_x=np.array([[0.0], [1.0]]), E_y=np.zeros((2, 1)), what="d",
        )  # fmt: skip


def test_the_disturbances_of_the_jet_engine_cannot_be_decoupled():
    """Three of them move all three outputs at once: neither an observer nor a window of any length is blind to them."""
    with pytest.raises(DesignError, match="3 independent ones leave none of the 3 outputs"):
        decoupled(JET["A"], JET["B"], JET["C"], JET["D"], E_x=JET["Bd"], E_y=JET["Dd"], what="the disturbances")
    seen, H_d = extended(np.eye(3) + 0.05 * JET["A"], 0.05 * JET["Bd"], JET["C"], JET["Dd"], 4)
    with pytest.raises(DesignError, match=r"no parity relation is blind to the disturbances: rank \[O H_d\] = 15"):
        parity_vectors(seen, H_d, "the disturbances")


def test_parity_vectors_see_neither_the_state_nor_the_inputs():
    F, G = np.eye(3) + 0.1 * A, np.array([[1.0], [0.0], [1.0]])
    seen, H = extended(F, G, C, np.zeros((2, 1)), 3)
    x, inputs, window = RNG.standard_normal(3), RNG.standard_normal(4), []
    for u in inputs:
        window.append(C @ x)
        x = F @ x + G[:, 0] * u
    V = parity_vectors(seen, np.zeros((8, 0)), "nothing")
    assert V.shape == (5, 8)
    np.testing.assert_allclose(V @ (np.concatenate(window) - H @ inputs), 0.0, atol=1e-10)
    blind = parity_vectors(seen, H, "the input")
    np.testing.assert_allclose(blind @ np.concatenate(window), 0.0, atol=1e-10)


def test_the_best_parity_vector_is_better_than_any_other_and_of_unit_noise():
    V = parity_vectors(np.ones((6, 1)), np.zeros((6, 0)), "nothing")
    fault, noise = np.diag(np.arange(6.0)), np.eye(6) + 0.5
    v, ratio = best_parity_vector(V, fault, noise)
    assert v @ noise @ v == pytest.approx(1.0)
    assert v @ fault @ v == pytest.approx(ratio)
    for other in RNG.standard_normal((50, 5)) @ V:
        assert other @ fault @ other <= ratio * (other @ noise @ other) * (1.0 + 1e-9)
