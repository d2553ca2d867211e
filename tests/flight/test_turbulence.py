"""The lateral gust: Dryden's spectrum, with the same variance at every sample time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm, solve_continuous_lyapunov

from fddbench.flight.turbulence import GustState, LateralGust
from fddbench.flight.wind import Encounter

times = st.floats(0.0005, 0.5)
speeds = st.floats(80.0, 300.0)
OUTPUT = np.array([np.sqrt(3.0), 1.0 - np.sqrt(3.0)])


def prepared(sample_s=0.01, v=200.0, *, sigma=1.0, scale=1.0, normals=((0.0,), (0.0,))):
    """Gust of one sigma, and its constants."""
    gust, normals = LateralGust(sigma), np.array(normals)
    n_cases = normals.shape[1]
    speeds_m_s, scale_ratio = (np.broadcast_to(np.asarray(each, float), n_cases) for each in (v, scale))
    return gust, gust.prepare(normals, Encounter(scale_ratio=scale_ratio, v_tas_m_s=speeds_m_s), sample_s)


def stepped(gust, c, state, normals):
    """State at the next sample, (2,), and the gust at this one, of one flight."""
    x = GustState(first=np.array([state[0]]), second=np.array([state[1]]))
    after, air = gust.step(x, c, np.array(normals)[:, None], np.float64(0.0), like=np.zeros(1))
    return np.array([after.first[0], after.second[0]]), air.v_m_s[0]


def discrete(sample_s, v):
    """Transition and noise input of the recursion, read off the block by unit states and unit normals."""
    gust, c = prepared(sample_s, v)
    eye, zero = np.eye(2), np.zeros(2)
    F = np.column_stack([stepped(gust, c, e, zero)[0] for e in eye])
    G = np.column_stack([stepped(gust, c, zero, e)[0] for e in eye])
    H = np.array([stepped(gust, c, e, zero)[1] for e in eye])
    return F, G, H


def continuous(v):
    """``x' = A x + b w`` of the module's docstring, with unit white noise w."""
    tau = 533.4 / v
    return np.array([[-1.0, 0.0], [1.0, -1.0]]) / tau, np.array([[1.0], [0.0]]) / np.sqrt(tau), tau


def stationary_start():
    gust, c = prepared(normals=np.eye(2))
    begun = gust.start(c)
    G0 = np.stack([begun.first, begun.second])
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
    normals = np.array([[0.3, 0.3], [-1.2, -1.2]])
    found = []
    for sigma, scale in ((3.0, [0.0, 1.0]), (1.0, 1.0), (6.0, 0.5)):
        gust, c = prepared(sigma=sigma, scale=scale, normals=normals)
        more = {"sample": np.float64(0.0), "like": np.zeros(2)}
        state, _ = gust.step(gust.start(c), c, normals, **more)
        found.append((state, gust.step(state, c, normals, **more)[1].v_m_s))
    assert found[0][1].tolist() == [0.0, 3.0 * found[1][1][0]]
    assert found[2][1][0] == 3.0 * found[1][1][0]
    assert found[0][0].first.tolist() == found[1][0].first.tolist()
    assert found[0][0].second.tolist() == found[1][0].second.tolist()
