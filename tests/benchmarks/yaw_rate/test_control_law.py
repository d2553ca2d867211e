"""The control law: its gains, and the stability of the loop they close."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm, solve_continuous_are

from fddbench.benchmarks.yaw_rate import control_law as law
from fddbench.blocks.layout import Nothing
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.lateral_lpv import lateral_lpv

DEG = np.pi / 180.0
GAINS = np.array([law.AILERON_GAINS, law.RUDDER_GAINS])
ALLOCATION = np.zeros((13, 2))
ALLOCATION[1:5, 0] = (1.0, -1.0, 1.0, -1.0)
ALLOCATION[0, 1] = 1.0
BOX = np.array([[180e3, 220e3], [0.27, 0.33], [15e3, 25e3], [260.0, 320.0]])
POINTS = [*product(*BOX), *np.random.default_rng(0).uniform(BOX[:, 0], BOX[:, 1], (40, 4))]


def model(point):
    rho = lateral_lpv().rho(*[np.array([value]) for value in point])
    return (matrix[:, :, 0] for matrix in lateral_lpv().matrices(rho))


def redesign():
    """LQR on [phi, V_y, p, r, integral of phi] with inputs [roll order, rudder] at the centre of the box."""
    A, B = model((200e3, 0.3, 20e3, 290.0))
    F, G = np.zeros((5, 5)), np.zeros((5, 2))
    F[:4, :4], F[4, 0], G[:4] = A, 1.0, B @ ALLOCATION
    Q, R = np.diag(law.Q_DIAGONAL), np.diag(law.R_DIAGONAL)
    return np.linalg.solve(R, G.T @ solve_continuous_are(F, G, Q, R))


def test_gains_are_those_of_the_stated_design_within_4_percent():
    np.testing.assert_allclose(GAINS, redesign(), rtol=0.04)


def test_gains_are_those_of_the_stated_design_to_4_digits():
    np.testing.assert_allclose(GAINS, redesign(), rtol=1e-4, atol=5e-5)


def closed_loop(point):
    """``d/dt [phi V_y p r integral roll rudder]`` with actuators of 14 rad/s, damper and surfaces unlimited."""
    A, B = model(point)
    v = true_airspeed_m_s(np.array([point[3]]), np.array([point[2]]))[0]
    K = GAINS.copy()
    K[:, 0] -= K[:, 3] * 9.80665 / v  # yaw rate is fed back about that of the coordinated turn
    F = np.zeros((7, 7))
    F[:4, :4], F[:4, 5:], F[4, 0] = A, B @ ALLOCATION, 1.0
    F[5:, :5], F[5:, 5:] = -14.0 * K, -14.0 * np.eye(2)
    return F


def test_the_loop_is_stable_over_the_whole_box():
    assert max(np.linalg.eigvals(closed_loop(point)).real.max() for point in POINTS) < -0.4


def test_the_sampled_loop_is_stable_at_10_and_20_ms():
    """Orders computed from this sample's state and held; surfaces move by the exact first order."""
    for sample_s in (0.01, 0.02):
        for point in POINTS[::4]:
            F = closed_loop(point)
            # the plant sees the surface position held over the sample; then the surfaces move towards the order
            held = F.copy()
            held[5:] = 0.0
            step = expm(held * sample_s)
            share = 1.0 - np.exp(-14.0 * sample_s)
            step[4], step[4, 4], step[4, 0] = 0.0, 1.0, sample_s
            step[5:] = share * F[5:] / 14.0
            step[5:, 5:] = (1.0 - share) * np.eye(2)
            assert np.abs(np.linalg.eigvals(step)).max() < np.exp(-0.3 * sample_s)


def orders(*, integral=0.0, command=0.0, **measured):
    values = {"phi_deg": 0.0, "beta_deg": 0.0, "p_deg_s": 0.0, "r_voted_deg_s": 0.0, "v_tas_m_s": 199.28, **measured}
    measured = SimpleNamespace(**{name: np.array([float(value)]) for name, value in values.items()})
    x = law.LawState(integral_rad_s=np.array([float(integral)]))
    after, u = law.LateralLaw(sample_s=0.01).step(x, Nothing(), Nothing(), measured, np.array([float(command)]))
    return after.integral_rad_s, u


small = st.floats(-1.0, 1.0)


@given(small, small, small, small, st.floats(-0.05, 0.05), small)
def test_is_the_state_feedback_while_no_limit_is_met(phi, beta, p, r, integral, command):
    after, u = orders(phi_deg=phi, beta_deg=beta, p_deg_s=p, r_voted_deg_s=r, integral=integral, command=command)
    r_error = r - 9.80665 / 199.28 * phi
    state = np.array([(phi - command) * DEG, 199.28 * beta * DEG, p * DEG, r_error * DEG, integral])
    roll, rudder = -GAINS @ state
    expected = ALLOCATION @ [roll, rudder]
    spoil = max(abs(roll) - 10.0, 0.0)
    expected[5::2], expected[6::2] = (0.0, spoil) if roll > 0 else (spoil, 0.0)
    np.testing.assert_allclose(u[:, 0], expected, atol=1e-10)
    assert after[0] == pytest.approx(integral + 0.01 * (phi - command) * DEG, abs=1e-15)


def test_rests_in_a_coordinated_turn():
    """The yaw rate of the turn asks for no rudder through the damper."""
    turn_deg_s = 9.80665 / 199.28 * 20.0
    _, u = orders(phi_deg=20.0, command=20.0, r_voted_deg_s=turn_deg_s)
    np.testing.assert_allclose(u, 0.0, atol=1e-9)


@given(st.floats(-500.0, 500.0))
def test_the_yaw_rate_alone_never_asks_for_more_than_the_authority_of_the_damper(r):
    _, u = orders(r_voted_deg_s=r)
    assert abs(u[0, 0]) <= 5.0


def test_roll_orders_roll_to_the_commanded_side():
    _, B = model((200e3, 0.3, 20e3, 290.0))
    for command in (20.0, -20.0, 1.0):
        _, u = orders(command=command)
        assert np.sign(B[2] @ u[:, 0]) == np.sign(command)
        assert np.sign(B[2, 5:] @ u[5:, 0]) in (0.0, np.sign(command))
        assert (u[5:] >= 0.0).all()


def test_the_integral_does_not_wind_up():
    integral = 0.0
    for _ in range(2000):
        after, _ = orders(phi_deg=60.0, integral=integral)
        integral = float(after[0])
    assert integral == 0.35
