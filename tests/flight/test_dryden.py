"""Six-component turbulence: the printed spectra, exactly, whatever the sample time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.linalg import expm, solve_continuous_lyapunov

from fddbench.blocks.layout import leaves
from fddbench.flight.dryden import (
    INTENSITIES_M_S,
    LONGITUDINAL_WINDS,
    SCALE_LENGTH_M,
    SIX_COMPONENT_WINDS,
    Dryden,
    LateralDryden,
    LongitudinalDryden,
)
from fddbench.flight.wind import CalmAir, Encounter

times, speeds, spans = st.floats(0.001, 0.2), st.floats(80.0, 300.0), st.floats(10.0, 80.0)
COMPONENTS = ("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s")
L, SIGMA = 1750 * 0.3048, 1.5
N_STATES = 8


def flight(sample_s=0.01, v=200.0, b=60.0, *, normals=None, n_cases=1):
    """Turbulence, its constants in flights that are all alike, with zero or given normals before the first sample."""
    wind = Dryden(SIGMA)
    rows = np.zeros((wind.before.size, n_cases)) if normals is None else normals
    meets = Encounter(v_tas_m_s=np.full(n_cases, v), span_m=b)
    return wind, wind.prepare(wind.before.unpack(rows), meets, sample_s)


def stepped(wind, c, state, normals):
    """State at the next sample, (8, n_cases), and the components at this one, (6, n_cases)."""
    x = wind.states.unpack(state)
    after, air = wind.step(x, c, wind.draws.unpack(normals), np.float64(0.0), like=state[0])
    return wind.states.pack(after, state.shape[1]), np.array([getattr(air, name) for name in COMPONENTS])


def discrete(sample_s, v, b):
    """Transition, noise input and output of the recursion, read off by unit states and unit normals; and the start's G0."""
    wind, c = flight(sample_s, v, b, n_cases=N_STATES)
    F, H = stepped(wind, c, np.eye(N_STATES), np.zeros((wind.draws.size, N_STATES)))
    G, _ = stepped(wind, c, np.zeros((N_STATES, N_STATES)), np.eye(N_STATES))
    wind, c = flight(sample_s, v, b, normals=np.eye(N_STATES), n_cases=N_STATES)
    return F, G, H, wind.states.pack(wind.start(c), N_STATES)


def continuous(v, b):
    """``x' = A x + B w`` of the docstrings, states in the order of the block: u, (w1, w2, wz), p, (v1, v2, vz)."""
    A, B, tau, root3 = np.zeros((8, 8)), np.zeros((8, 4)), L / v, np.sqrt(3.0)
    for at, lag_s in ((1, 4 * b / (np.pi * v)), (5, 3 * b / (np.pi * v))):
        A[at : at + 2, at : at + 2] = np.array([[-1.0, 0.0], [1.0, -1.0]]) / tau
        A[at + 2, at : at + 3] = np.array([root3, 1.0 - root3, -1.0]) / lag_s
        B[at, 1 if at == 1 else 3] = 1.0 / np.sqrt(tau)
    for at, lag_s in ((0, tau), (4, 4 * b / (np.pi * v))):
        A[at, at], B[at, at // 2] = -1.0 / lag_s, np.sqrt(2.0 / lag_s)
    return A, B


def spectrum(name, b):
    """One-sided spectrum over the spatial frequency, as MIL-F-8785C prints it [unit^2 / (rad/m)]."""

    def across(o):
        return SIGMA**2 * L / np.pi * (1 + 3 * (L * o) ** 2) / (1 + (L * o) ** 2) ** 2

    return {
        "u_m_s": lambda o: SIGMA**2 * 2 * L / np.pi / (1 + (L * o) ** 2),
        "v_m_s": across,
        "w_m_s": across,
        "p_rad_s": lambda o: SIGMA**2 / L * 0.8 * (np.pi * L / (4 * b)) ** (1 / 3) / (1 + (4 * b * o / np.pi) ** 2),
        "q_rad_s": lambda o: o**2 / (1 + (4 * b * o / np.pi) ** 2) * across(o),
        "r_rad_s": lambda o: o**2 / (1 + (3 * b * o / np.pi) ** 2) * across(o),
    }[name]


@settings(max_examples=15)
@given(times, speeds, spans)
def test_transition_and_noise_are_those_of_the_continuous_filters(sample_s, v, b):
    A, B = continuous(v, b)
    F, G, _, _ = discrete(sample_s, v, b)
    np.testing.assert_allclose(F, expm(A * sample_s), rtol=1e-9, atol=1e-13)
    block = expm(np.block([[-A, B @ B.T], [np.zeros((8, 8)), A.T]]) * sample_s)
    Q = block[8:, 8:].T @ block[:8, 8:]  # Van Loan
    np.testing.assert_allclose(G @ G.T, Q, rtol=1e-6, atol=1e-13)


@settings(max_examples=15)
@given(times, speeds, spans)
def test_variances_stay_at_every_sample_time(sample_s, v, b):
    F, G, H, G0 = discrete(sample_s, v, b)
    A, B = continuous(v, b)
    P = G0 @ G0.T
    np.testing.assert_allclose(P, solve_continuous_lyapunov(A, -B @ B.T), rtol=1e-9, atol=1e-12)
    begun = np.diag(H @ P @ H.T)
    np.testing.assert_allclose(begun[:3], SIGMA**2, rtol=1e-12)
    for _ in range(60):
        P = F @ P @ F.T + G @ G.T
    np.testing.assert_allclose(np.diag(H @ P @ H.T), begun, rtol=1e-9)


@settings(max_examples=10)
@given(st.floats(0.002, 0.02), speeds, spans, st.integers(2, 10))
def test_n_steps_carry_the_air_as_far_as_one_of_n_times_the_length(sample_s, v, b, n):
    F, G, H, _ = discrete(sample_s, v, b)
    big_F, big_G, big_H, _ = discrete(n * sample_s, v, b)
    P = np.zeros((8, 8))
    for _ in range(n):
        P = F @ P @ F.T + G @ G.T
    np.testing.assert_allclose(np.linalg.matrix_power(F, n), big_F, rtol=1e-9, atol=1e-13)
    np.testing.assert_allclose(P, big_G @ big_G.T, rtol=1e-6, atol=1e-13)
    np.testing.assert_array_equal(H, big_H)


@pytest.mark.parametrize("name", COMPONENTS)
@pytest.mark.parametrize(("v", "b"), [(200.0, 60.3), (150.0, 35.0)])
def test_literature_autocovariance_is_that_of_the_printed_spectrum(name, v, b):
    """``R(tau) = integral of Phi(Omega) cos(Omega V tau)``, at lags up to four seconds."""
    sample_s = 0.05
    F, _, H, G0 = discrete(sample_s, v, b)
    h, P, density = H[COMPONENTS.index(name)], G0 @ G0.T, spectrum(name, b)
    variance = quad(density, 0.0, np.inf, limit=400)[0]
    for k in (0, 1, 4, 20, 80):
        lag_m = v * k * sample_s
        found = quad(density, 0.0, np.inf, weight="cos", wvar=lag_m, limit=400)[0] if k else variance
        assert h @ np.linalg.matrix_power(F, k) @ P @ h == pytest.approx(found, rel=1e-5, abs=1e-5 * variance)


@pytest.mark.parametrize(("gust", "rotation", "sign", "spans_over_pi"), [
    ("w_m_s", "q_rad_s", -1.0, 4.0),
    ("v_m_s", "r_rad_s", 1.0, 3.0),
])  # fmt: skip
def test_q_and_r_are_the_gradients_of_the_very_w_and_v(gust, rotation, sign, spans_over_pi):
    """``lag rotation' + rotation = +-gust' / V``, along a flight with its own noise, integrated over it."""
    v, b, sample_s, n = 220.0, 60.3, 0.001, 4000
    rng = np.random.default_rng(5)
    wind, c = flight(sample_s, v, b, normals=rng.normal(size=(N_STATES, 1)))
    state, seen = wind.states.pack(wind.start(c), 1), []
    for _ in range(n):
        state, air = stepped(wind, c, state, rng.normal(size=(wind.draws.size, 1)))
        seen.append(air[:, 0])
    gusts, rotations = (np.array(seen)[:, COMPONENTS.index(name)] for name in (gust, rotation))
    lag_s = spans_over_pi * b / (np.pi * v)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * sample_s * (rotations[1:] + rotations[:-1]))])
    left = lag_s * (rotations - rotations[0]) + integral
    np.testing.assert_allclose(left, sign * (gusts - gusts[0]) / v, atol=3e-3 * np.ptp(gusts) / v)
    assert np.ptp(gusts) > 0.5


@settings(max_examples=10)
@given(st.integers(0, 1000))
def test_the_halves_fly_alone_what_they_fly_in_the_whole(seed):
    rng = np.random.default_rng(seed)
    start, drawn = rng.normal(size=(N_STATES, 3)), rng.normal(size=(20, N_STATES, 3))
    meets = Encounter(v_tas_m_s=np.array([120.0, 200.0, 240.0]), span_m=60.3, scale_ratio=0.5)
    more, found = {"sample": np.float64(0.0), "like": np.zeros(3)}, {}
    for wind in (Dryden(3.0), LongitudinalDryden(3.0), LateralDryden(3.0)):
        at = {stream: 4 * j for j, stream in enumerate(Dryden.draws.streams)}
        before = {stream: 4 * j for j, stream in enumerate(Dryden.before.streams)}
        rows = np.concatenate([start[before[s] : before[s] + 4] for s in wind.before.streams])
        c = wind.prepare(wind.before.unpack(rows), meets, 0.01)
        x = wind.start(c)
        for normals in drawn:
            n = wind.draws.unpack(np.concatenate([normals[at[s] : at[s] + 4] for s in wind.draws.streams]))
            x, air = wind.step(x, c, n, **more)
        found[type(wind)] = dict(leaves(air))
    for half, names in (
        (LongitudinalDryden, ("u_m_s", "w_m_s", "q_rad_s")),
        (LateralDryden, ("v_m_s", "p_rad_s", "r_rad_s")),
    ):
        for name in COMPONENTS:
            expected = found[Dryden][name] if name in names else np.zeros(3)
            assert found[half][name].tobytes() == expected.tobytes()


def test_literature_intensities_and_length():
    assert INTENSITIES_M_S == {"light": 1.5, "moderate": 3.0, "severe": 6.0}
    assert pytest.approx(533.4) == SCALE_LENGTH_M
    for winds in (SIX_COMPONENT_WINDS, LONGITUDINAL_WINDS):
        assert isinstance(next(iter(winds.values())), CalmAir)
        assert {name: wind.sigma_m_s for name, wind in winds.items() if name != "none"} == INTENSITIES_M_S


def test_the_numbers_are_those_that_were_kept_for_it():
    assert [consumer for consumer, _ in Dryden.draws.streams] == [12, 13]
    assert [consumer for consumer, _ in Dryden.before.streams] == [14, 15]
