"""Steady flight: published trims, and the laws of the iteration."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import aircraft
from fddbench.flight.b747.dynamics import derivative
from fddbench.flight.b747.trim import condition, trim

fractions = st.floats(0.0, 1.0)


def some(fraction, low, high):
    return low + fraction * (high - low)


def test_published_trim_at_9000_m():
    """Calibration: alpha, thrust and elevator of section III with its stabiliser of -0.0094 rad."""
    at = condition(9000.0, 241.0)
    found = trim(aircraft(), at)
    assert found.found.all()
    assert np.deg2rad(at.stabiliser_deg[0]) == pytest.approx(-0.0094, rel=1e-6)
    assert found.alpha_rad[0] == pytest.approx(0.0209, rel=0.005)
    assert np.deg2rad(found.elevator_deg[0]) == pytest.approx(0.0348, rel=0.005)
    assert found.thrust_n[0] == pytest.approx(39439.0, rel=0.005)


def test_trim_at_the_design_point():
    """7000 m, 241 m/s, as another program found it with the same numbers."""
    found = trim(aircraft(), condition(7000.0, 241.0))
    assert np.rad2deg(found.alpha_rad[0]) == pytest.approx(0.42, abs=0.005)
    assert found.elevator_deg[0] == pytest.approx(2.88, abs=0.005)
    assert found.thrust_n[0] == pytest.approx(41959.0, abs=5.0)


@settings(max_examples=8, deadline=None)
@given(*[fractions] * 5)
def test_nothing_accelerates_in_trim_alone_or_in_company(a, b, c, d, e):
    own = aircraft(
        np.array([some(a, 220e3, 320e3), 263e3]), x_cg_ratio=some(b, 0.15, 0.35), delta_c_d_percent=some(c, -10.0, 10.0)
    )
    at = condition(np.array([some(d, 2e3, 11e3), 7e3]), np.array([some(e, 180.0, 270.0), 241.0]), 0.02)
    found = trim(own, at)
    assert found.found.all()
    x = np.stack([found.alpha_rad, 0.0 * found.alpha_rad, at.v_tas_m_s, found.alpha_rad + 0.02, at.altitude_m])
    u = np.stack([found.elevator_deg, at.stabiliser_deg, found.thrust_n])
    rates = derivative(x, u, np.zeros((3, 2)), own, air(at.altitude_m))
    np.testing.assert_allclose(rates[:4], 0.0, atol=1e-8)
    np.testing.assert_allclose(rates[4], at.v_tas_m_s * np.sin(0.02))
    other = trim(
        aircraft(own.mass_kg[:1], x_cg_ratio=some(b, 0.15, 0.35), delta_c_d_percent=some(c, -10.0, 10.0)),
        condition(at.altitude_m[:1], at.v_tas_m_s[:1], 0.02),
    )
    assert other.elevator_deg[0] == found.elevator_deg[0]
    assert other.thrust_n[0] == found.thrust_n[0]


def test_a_condition_without_a_trim_says_so():
    found = trim(aircraft(), condition(np.array([11000.0, 7000.0]), np.array([500.0, 241.0])))
    assert found.found.tolist() == [False, True]
