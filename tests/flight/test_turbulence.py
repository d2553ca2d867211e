"""The lateral gust: Dryden's spectrum, with the same variance at every sample time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm, solve_continuous_lyapunov

from fddbench.flight import turbulence as gust

times = st.floats(0.0005, 0.5)
speeds = st.floats(80.0, 300.0)
OUTPUT = np.array([np.sqrt(3.0), 1.0 - np.sqrt(3.0)])


def discrete(sample_s, v):
    """Transition and noise input of the recursion, read off `gust_step` by unit states and unit normals."""
    c = gust.gust_constants(sigma_m_s=np.ones(1), v_tas_m_s=np.array([v]), sample_s=sample_s)
    eye, zero = np.eye(2), np.zeros(2)
    F = np.column_stack([gust.gust_step(e[:, None], c, zero[:, None])[:, 0] for e in eye])
    G = np.column_stack([gust.gust_step(zero[:, None], c, e[:, None])[:, 0] for e in eye])
    H = np.array([gust.gust_m_s(e[:, None], c)[0] for e in eye])
    return F, G, H


def continuous(v):
    """``x' = A x + b w`` of the module's docstring, with unit white noise w."""
    tau = 533.4 / v
    return np.array([[-1.0, 0.0], [1.0, -1.0]]) / tau, np.array([[1.0], [0.0]]) / np.sqrt(tau), tau


def stationary_start():
    G0 = np.column_stack([gust.gust_start(e[:, None])[:, 0] for e in np.eye(2)])
    return G0 @ G0.T


@given(speeds)
def test_literature_transfer_function_is_dryden_lateral(v):
    """MIL-F-8785C: ``G(s) = sigma sqrt(tau) (1 + sqrt3 tau s) / (1 + tau s)^2`` on unit white noise."""
    A, b, tau = continuous(v)
    w = np.logspace(-2, 2, 30) / tau
    s = 1j * w
    found = [OUTPUT @ np.linalg.solve(si * np.eye(2) - A, b)[:, 0] for si in s]
    np.testing.assert_allclose(found, np.sqrt(tau) * (1 + np.sqrt(3) * tau * s) / (1 + tau * s) ** 2, rtol=1e-9)
    # and the module's output row and discretisation are those of this state space
    _, _, H = discrete(0.01, v)
    np.testing.assert_allclose(H, OUTPUT, rtol=1e-14)


@given(times, speeds)
def test_transition_is_the_matrix_exponential(sample_s, v):
    A, _, _ = continuous(v)
    F, _, _ = discrete(sample_s, v)
    np.testing.assert_allclose(F, expm(A * sample_s), rtol=1e-12, atol=1e-15)


@given(times, speeds)
def test_process_noise_is_the_integral_of_the_continuous_noise(sample_s, v):
    """Van Loan: the covariance gathered over one sample."""
    A, b, _ = continuous(v)
    block = expm(np.block([[-A, b @ b.T], [np.zeros((2, 2)), A.T]]) * sample_s)
    Q = block[2:, 2:].T @ block[:2, 2:]
    _, G, _ = discrete(sample_s, v)
    np.testing.assert_allclose(G @ G.T, Q, rtol=1e-6, atol=1e-15)


@given(times, speeds)
def test_variance_stays_sigma_squared_at_every_sample_time(sample_s, v):
    F, G, H = discrete(sample_s, v)
    P = stationary_start()
    assert pytest.approx(1.0, rel=1e-12) == H @ P @ H
    for _ in range(50):
        P = F @ P @ F.T + G @ G.T
        assert pytest.approx(1.0, rel=1e-12) == H @ P @ H
    np.testing.assert_allclose(P, stationary_start(), rtol=1e-12)


@given(speeds)
def test_start_is_the_stationary_covariance(v):
    A, b, _ = continuous(v)
    np.testing.assert_allclose(stationary_start(), solve_continuous_lyapunov(A, -b @ b.T), rtol=1e-12)


@given(st.floats(0.002, 0.02), speeds, st.integers(2, 10))
def test_autocovariance_does_not_depend_on_the_step(sample_s, v, n):
    """n steps of T carry the gust as far as one step of n T."""
    F, G, _ = discrete(sample_s, v)
    big_F, big_G, _ = discrete(n * sample_s, v)
    P = np.zeros((2, 2))
    for _ in range(n):
        P = F @ P @ F.T + G @ G.T
    np.testing.assert_allclose(np.linalg.matrix_power(F, n), big_F, rtol=1e-10)
    np.testing.assert_allclose(P, big_G @ big_G.T, rtol=1e-6, atol=1e-15)


def test_sigma_scales_the_gust_and_nothing_else():
    v, normals = np.array([200.0, 200.0]), np.array([[0.3, 0.3], [-1.2, -1.2]])
    c = gust.gust_constants(sigma_m_s=np.array([0.0, 3.0]), v_tas_m_s=v, sample_s=0.01)
    unit = gust.gust_constants(sigma_m_s=np.ones(2), v_tas_m_s=v, sample_s=0.01)
    state = gust.gust_step(gust.gust_start(normals), c, normals)
    assert gust.gust_m_s(state, c).tolist() == [0.0, 3.0 * gust.gust_m_s(state, unit)[0]]


def test_literature_intensities():
    assert gust.WINDS_M_S == {"none": 0.0, "light": 1.5, "moderate": 3.0, "severe": 6.0}
    assert pytest.approx(1750 * 0.3048) == gust.SCALE_LENGTH_M
