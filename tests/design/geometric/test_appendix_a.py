"""The example of the paper: its subspaces and matrices, the misprinted filter, and exact decoupling while rho moves."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fddbench.design.geometric import (
    contains,
    identity_error,
    invariant_subspace,
    residual_generator,
    unobservability_subspace,
)

A = np.array([
    [[-2.0, 0.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.5, -1.0]],
    [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
])  # fmt: skip
L1, L2 = np.array([[1.0], [0.0], [0.0]]), np.array([[0.0], [1.0], [0.0]])
B = np.hstack([L1, L2])
C = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
P1, P2 = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
CORRECTED = {
    "blind to fault 1": (
        np.array([[[-0.4407, 0.5], [-0.5932, -1.0]], np.zeros((2, 2))]),
        np.array([[[0.0, 0.5593], [0.0, -1.0932]], [[0.0, -1.0], [0.0, -1.0]]]),
        P1,
    ),
    "blind to fault 2": (np.array([[[-3.5]], [[0.0]]]), np.array([[[-1.5, 0.0]], [[0.0, 0.0]]]), P2),
}
PRINTED = {
    "blind to fault 1": (
        np.array([[[0.5593, 0.5], [-1.0932, -1.0]], [[-1.0, 0.0], [-1.0, 0.0]]]),
        np.array([[[0.5593, 0.0], [-1.0932, 0.0]], [[-1.0, 0.0], [-1.0, 0.0]]]),
        P1,
    ),
    "blind to fault 2": (np.array([[[-3.5]], [[0.0]]]), np.array([[[1.5, 0.0]], [[0.0, 0.0]]]), P2),
}


def same(S, T):
    return S.shape == T.shape and contains(S, T)


def test_its_subspaces():
    assert same(invariant_subspace(A, C, L1), L1)
    assert same(invariant_subspace(A, C, L2), L2)
    assert same(unobservability_subspace(A, C, L1), L1)
    assert same(unobservability_subspace(A, C, L2), np.eye(3)[:, 1:])


@pytest.mark.parametrize("name", CORRECTED)
def test_the_corrected_filter_keeps_the_identity_and_the_printed_one_does_not(name):
    assert identity_error(*CORRECTED[name], A, C) < 1e-12
    assert identity_error(*PRINTED[name], A, C) > 0.3


@pytest.fixture(scope="module")
def bank():
    return residual_generator(A, B, C, {"1": L1, "2": L2}, box=[[-0.5, 0.5]], decay=0.3)


def test_ours_has_the_same_matrices_where_they_are_determined(bank):
    for fault, P, H, F in (("2", P1, [[0.0, 1.0]], [[0.0, 1.0], [0.0, 0.0]]), ("1", P2, [[1.0, 0.0]], [[1.0, 0.0]])):
        found = bank[fault]
        np.testing.assert_allclose(found.P, P, atol=1e-12)
        np.testing.assert_allclose(found.H, H, atol=1e-12)
        np.testing.assert_allclose(found.F[0], F, atol=1e-12)
        np.testing.assert_allclose(found.M, [[1.0, 0.0]] if len(P) == 2 else [[1.0]], atol=1e-12)
        assert identity_error(found.N, found.G, found.P, A, C) < 1e-12


def test_ours_is_quadratically_stable_at_every_corner(bank):
    assert bank["2"].active == (0,)
    for found in bank.values():
        for rho in (-0.5, 0.5):
            N = found.N[0] + rho * found.N[1]
            assert np.linalg.eigvalsh(N.T @ found.X + found.X @ N + 2 * 0.3 * found.X)[-1] <= 0.0


def fly(filter_, v):
    """Residual over 20 s of a filter (N, G, F, M, H, P) beside a plant whose rho swings, started with its state at P x."""
    N, G, F, M, H, P = filter_

    def rho(t):
        return 0.5 * np.sin(0.7 * t) * np.cos(0.13 * t * t)

    def rate(t, z):
        x, w, u, r = z[:3], z[3:], np.array([np.sin(t), np.cos(2 * t)]), rho(t)
        dx = (A[0] + r * A[1]) @ x + B @ (u + v(t))
        return np.concatenate([dx, (N[0] + r * N[1]) @ w - (G[0] + r * G[1]) @ (C @ x) + F @ u])

    x0 = np.array([1.0, -0.5, 0.7])
    t = np.linspace(0.0, 20.0, 401)
    z = solve_ivp(rate, (0.0, 20.0), np.concatenate([x0, P @ x0]), t_eval=t, rtol=1e-11, atol=1e-12).y
    return np.abs(M @ z[3:] - H @ (C @ z[:3])).max()


def test_both_filters_decouple_exactly_while_rho_moves(bank):
    faults = {"1": lambda t: np.array([1.0 + np.sin(3 * t), 0.0]), "2": lambda t: np.array([0.0, 1.0 + np.sin(3 * t)])}
    for own, found in bank.items():
        ours = (found.N, found.G, found.F[0], found.M, found.H, found.P)
        peak = {fault: fly(ours, v) for fault, v in faults.items()}
        other = "2" if own == "1" else "1"
        assert peak[other] < 1e-9 * peak[own]


def test_the_corrected_one_decouples_and_the_printed_one_does_not():
    F, M, H = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])
    for filters, low, high in ((CORRECTED, 0.0, 1e-8), (PRINTED, 0.1, np.inf)):
        N, G, P = filters["blind to fault 1"]
        assert low <= fly((N, G, F, M, H, P), lambda t: np.array([1.0, 0.0])) <= high
