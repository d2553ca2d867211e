"""Laws of motion: what is conserved without air, the steady turn, mirror symmetry, and the order of the integration."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import fsolve

from fddbench.blocks.integrate import rk4
from fddbench.flight.atmosphere import FT_M, GRAVITY_M_S2, density_kg_m3, temperature_k
from fddbench.flight.transport.aerodynamics import Controls
from fddbench.flight.transport.air import AirAround, air_around
from fddbench.flight.transport.body import body_of
from fddbench.flight.transport.equations import (
    State,
    attitude,
    derivative,
    euler_rad,
    forces,
    gravity,
    normalised,
)  # fmt: skip
from fddbench.flight.transport.reading import twin_jet
from fddbench.flight.transport.trim import neutral
from fddbench.flight.wind import still

ONE = np.ones(1)
JET = twin_jet()
BODY = body_of(JET, 185e3 * ONE, 0.27 * ONE)
small = st.floats(-0.3, 0.3)


def rows_of(*, speed=(190.0, 3.0, 8.0), rates=(0.1, -0.05, 0.07), angles=(0.3, 0.1, 0.5), altitude=6000.0):
    values = (*speed, *rates, *(each[0] for each in attitude(*(np.array([a]) for a in angles))), 0.0, 0.0, altitude)
    return np.array(values)[:, np.newaxis]


def flown(rows, seconds, *, step_s=0.01, controls=None, air=None, thrust=0.5, body=BODY):
    controls = controls or neutral(-0.04 * ONE)
    for _ in range(round(seconds / step_s)):
        around = air or air_around(rows[12])

        def rate(x, around=around):
            return derivative(JET, body, around, x, controls, still(ONE), thrust * ONE)

        rows = normalised(rk4(rate, rows, step_s=step_s))
    return rows


def to_earth(x, vector):
    """Rotation of body axes to earth axes by the matrix of the quaternion (written out, not as the equations have it)."""
    q0, q1, q2, q3 = (each[0] for each in (x.q0, x.q1, x.q2, x.q3))
    matrix = np.array(
        [
            [q0**2 + q1**2 - q2**2 - q3**2, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)],
            [2 * (q1 * q2 + q0 * q3), q0**2 - q1**2 + q2**2 - q3**2, 2 * (q2 * q3 - q0 * q1)],
            [2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), q0**2 - q1**2 - q2**2 + q3**2],
        ]
    )
    return matrix @ np.array(vector)


@pytest.mark.parametrize("i_xz", [0.0, 1.5e6])
def test_energy_and_angular_momentum_are_conserved_without_air_and_thrust(i_xz):
    zero = 0.0 * ONE
    vacuum = AirAround(
        altitude_m=zero, density_kg_m3=zero, temperature_k=250.0 * ONE, first=zero, second=zero, lapse_k_m=zero
    )
    jet = JET.model_copy(update={"inertia": JET.inertia.model_copy(update={"i_xz_kg_m2": i_xz})})
    body = body_of(jet, 185e3 * ONE, 0.27 * ONE)

    def conserved(rows):
        x = State(*rows)
        rates = np.array([x.p[0], x.q[0], x.r[0]])
        inertia = np.array([[body.i_xx[0], 0, -body.i_xz[0]], [0, body.i_yy[0], 0], [-body.i_xz[0], 0, body.i_zz[0]]])
        kinetic = 0.5 * body.mass_kg[0] * (x.u[0] ** 2 + x.v[0] ** 2 + x.w[0] ** 2)
        energy = kinetic + body.mass_kg[0] * GRAVITY_M_S2 * x.altitude[0]
        return energy, 0.5 * rates @ inertia @ rates, to_earth(x, inertia @ rates)

    begun = rows_of()
    before, after = conserved(begun), conserved(flown(begun, 10.0, air=vacuum, thrust=0.0, body=body))
    for old, new in zip(before, after, strict=True):
        np.testing.assert_allclose(new, old, rtol=1e-9, atol=1e-9 * np.abs(old).max())


@settings(max_examples=10)
@given(small, small, small, small, small, st.floats(-0.1, 0.1), small)
def test_a_mirrored_flight_is_the_mirror_of_the_flight(v, p, r, phi, psi, rudder, spoiler):
    def of(sign):
        x = rows_of(
            speed=(190.0, sign * v * 10.0, 8.0), rates=(sign * p, 0.02, sign * r), angles=(sign * phi, 0.1, sign * psi)
        )
        turned = dict.fromkeys(("aileron_1", "aileron_3", "elevator_difference"), sign * 0.05 * ONE)
        controls = Controls(
            rudder=sign * rudder * ONE,
            spoiler=sign * spoiler * ONE,
            elevator=0.02 * ONE,
            stabiliser=-0.04 * ONE,
            **turned,
        )
        return derivative(JET, BODY, air_around(x[12]), x, controls, still(ONE), 0.5 * ONE)[:, 0]

    odd = np.array([1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1])
    np.testing.assert_allclose(of(-1.0), odd * of(1.0), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("bank_deg", [10.0, 33.0, 45.0])
def test_a_steady_turn_obeys_its_law(bank_deg):
    """Level and coordinated: ``n_s cos mu - n_y sin mu = 1`` with ``sin mu = cos theta sin phi``, n_s along the lift axis."""
    phi = np.deg2rad(bank_deg)
    air, speed = air_around(6096.0 * ONE), 199.28

    def state(alpha, theta, turn):
        rates = (-turn * np.sin(theta), turn * np.cos(theta) * np.sin(phi), turn * np.cos(theta) * np.cos(phi))
        return rows_of(
            speed=(speed * np.cos(alpha), 0.0, speed * np.sin(alpha)),
            rates=rates,
            angles=(phi, theta, 0.0),
            altitude=6096.0,
        )

    def controls(stabiliser, rudder, aileron):
        each = dict.fromkeys(("aileron_3", "spoiler", "elevator", "elevator_difference"), 0.0 * ONE)
        return Controls(rudder=rudder * ONE, aileron_1=aileron * ONE, stabiliser=stabiliser * ONE, **each)

    def left(unknown):
        alpha, theta, turn, thrust, *surfaces = unknown
        found = derivative(JET, BODY, air, state(alpha, theta, turn), controls(*surfaces), still(ONE), thrust * ONE)[
            :, 0
        ]
        return [*found[:6], found[12]]

    solution, _, converged, _ = fsolve(
        left, [0.05, 0.05, GRAVITY_M_S2 / speed * np.tan(phi), 0.5, -0.05, 0.0, 0.0], xtol=1e-13, full_output=True
    )
    assert converged == 1
    alpha, theta, turn, thrust, *surfaces = solution
    x = State(*state(alpha, theta, turn))
    f = forces(JET, BODY, air, x, controls(*surfaces), still(ONE), thrust * ONE)
    f_x, f_y, f_z = (each[0] / GRAVITY_M_S2 for each in (f.x, f.y, f.z))
    n_s, n_y = f_x * np.sin(alpha) - f_z * np.cos(alpha), f_y
    mu = np.arcsin(np.cos(theta) * np.sin(phi))
    assert abs(n_s * np.cos(mu) - n_y * np.sin(mu) - 1.0) < 1e-6
    assert n_s * np.cos(phi) == pytest.approx(1.0, abs=3e-3)
    assert -f_z * np.cos(phi) == pytest.approx(1.0, abs=6e-3)


def test_runge_kutta_is_of_order_four_on_the_whole_aircraft():
    begun = rows_of(rates=(0.3, -0.05, 0.1))
    coarse, fine, finest = (flown(begun, 2.0, step_s=h) for h in (0.08, 0.04, 0.02))
    ratio = np.abs(coarse - fine)[:10].max() / np.abs(fine - finest)[:10].max()
    assert 12.0 < ratio < 20.0
    ten, five = flown(begun, 5.0, step_s=0.01), flown(begun, 5.0, step_s=0.005)
    assert np.rad2deg(np.abs(ten - five)[3:6]).max() < 1e-7  # deg/s


@settings(max_examples=30)
@given(st.floats(0.0, 14000.0), st.floats(-3.0, 3.0))
def test_air_around_an_altitude_is_the_standard_atmosphere(altitude, moved):
    if (altitude < 11000.0) != (altitude + moved < 11000.0):
        return
    density, temperature = air_around(altitude * ONE).at((altitude + moved) * ONE)
    there_ft = (altitude + moved) * ONE / FT_M
    np.testing.assert_allclose(density, density_kg_m3(there_ft), rtol=1e-10)
    np.testing.assert_allclose(temperature, temperature_k(there_ft), rtol=1e-14)


@settings(max_examples=30)
@given(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
def test_attitude_and_angles_are_inverse(phi, theta, psi):
    zero = 0.0 * ONE
    q = attitude(phi * ONE, theta * ONE, psi * ONE)
    x = State(*(zero,) * 6, *q, zero, zero, zero)
    np.testing.assert_allclose([each[0] for each in euler_rad(x)], [phi, theta, psi], atol=1e-9)
    down = to_earth(x, [each[0] for each in gravity(x)])
    np.testing.assert_allclose(down, [0.0, 0.0, GRAVITY_M_S2], atol=1e-12)


def test_the_yawing_moment_of_a_gust_alone_may_be_off_the_model():
    """30 % more of it with a gust; nothing without; and zero percent keeps every bit."""
    rows, around = rows_of(), air_around(rows_of()[12])

    def yaw(gust_m_s, off):
        body = body_of(JET, 185e3 * ONE, 0.27 * ONE, gust_yaw=None if off is None else off * ONE)
        wind = still(ONE, v_m_s=gust_m_s * ONE)
        return forces(JET, body, around, State(*rows), neutral(-0.04 * ONE), wind, 0.5 * ONE).yaw[0]

    more = yaw(2.0, 0.3) - yaw(2.0, 0.0)
    assert yaw(2.0, 0.0) == yaw(2.0, None)
    assert yaw(0.0, 0.3) == yaw(0.0, 0.0)
    # what the same gust changes by its sideslip is the same share of it; the side force at its arm is not, nor is the speed
    assert more == pytest.approx(0.3 * (yaw(2.0, 0.0) - yaw(0.0, 0.0)), rel=0.1)
