"""The nonlinear model beside NASA CR-2144, and the laws of its motion in wind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import aircraft
from fddbench.flight.b747.dynamics import airflow, derivative
from fddbench.flight.b747.trim import condition, trim

CALM = np.zeros((3, 1))
STEPS = (1e-5, 1e-5, 1e-2, 1e-5, 1.0)


def level(own, altitude_m, v_tas_m_s):
    at = condition(altitude_m, v_tas_m_s)
    found = trim(own, at)
    zero = np.zeros_like(found.alpha_rad)
    x = np.stack([found.alpha_rad, zero, at.v_tas_m_s, found.alpha_rad, at.altitude_m])
    return x, np.stack([found.elevator_deg, at.stabiliser_deg, found.thrust_n])


def oscillations(own, altitude_m, v_tas_m_s):
    """Frequencies [rad/s] and damping ratios [-] of the oscillatory modes, slow first."""
    x, u = level(own, altitude_m, v_tas_m_s)
    columns = []
    for j, step in enumerate(STEPS):
        h = np.zeros((5, 1))
        h[j] = step
        up, down = (derivative(x + s * h, u, CALM, own, air((x + s * h)[4])) for s in (1.0, -1.0))
        columns.append((up - down)[:, 0] / (2.0 * step))
    poles = np.linalg.eigvals(np.stack(columns, axis=1))
    return sorted((abs(pole), -pole.real / abs(pole)) for pole in poles if pole.imag > 0.0)


def test_modes_of_flight_condition_9_of_cr_2144():
    """With its own mass and inertia: short period 0.958 rad/s, 0.391; phugoid 0.067 rad/s."""
    own = aircraft(np.array([288756.0]))
    assert own.iyy_kg_m2[0] == pytest.approx(4.488e7)
    speed = 0.8 * float(air(np.array([12192.0])).sound_m_s[0])
    (phugoid, _), (short, damping) = oscillations(own, 12192.0, speed)
    assert short == pytest.approx(0.958, rel=0.05)
    assert damping == pytest.approx(0.391, rel=0.10)
    assert phugoid == pytest.approx(0.067, rel=0.10)


def test_the_moment_of_alphadot_is_solved_exactly():
    """With and without C_m of alphadot, qdot differs by that coefficient times the alphadot of the same moment."""
    x, u = level(aircraft(), 7000.0, 241.0)
    x = x + np.array([[0.02], [0.01], [0.0], [0.0], [0.0]])
    rates = {
        value: derivative(x, u, CALM, aircraft(c_m_alphadot=value), air(x[4]))[:, 0] for value in (0.0, -2.75, -5.5)
    }
    assert rates[0.0][0] == rates[-5.5][0] != 0.0
    q_pa = 0.5 * float(air(x[4]).density_kg_m3[0]) * 241.0**2
    per_alphadot = q_pa * 511.0 * 8.324 * 8.324 / 241.0 / 4.38e7
    for value in (-2.75, -5.5):
        assert rates[value][1] - rates[0.0][1] == pytest.approx(value * per_alphadot * rates[0.0][0], rel=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.floats(-0.05, 0.15), st.floats(150.0, 280.0), st.floats(-15.0, 15.0), st.floats(-15.0, 15.0))
def test_the_motion_through_the_air_is_that_over_ground_without_the_wind(alpha, speed, u_g, w_g):
    x = np.array([[alpha], [0.01], [speed], [alpha], [7000.0]])
    flow = airflow(x, np.array([[u_g], [w_g], [0.002]]))
    assert flow.v_tas_m_s * np.cos(flow.alpha_rad) + u_g == pytest.approx(speed * np.cos(alpha), abs=1e-9)
    assert flow.v_tas_m_s * np.sin(flow.alpha_rad) + w_g == pytest.approx(speed * np.sin(alpha), abs=1e-9)
    assert flow.q_rad_s[0] == pytest.approx(0.008)


def test_a_gust_from_below_lifts_and_pitches_down():
    x, u = level(aircraft(), 7000.0, 241.0)
    calm, gust = (derivative(x, u, wind, aircraft(), air(x[4]))[:, 0] for wind in (CALM, [[0.0], [-3.0], [0.0]]))
    assert gust[0] < calm[0]  # the path turns up
    assert gust[1] < calm[1]
