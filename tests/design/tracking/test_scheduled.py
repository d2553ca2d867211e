"""Gains over dynamic pressure."""

import numpy as np
import pytest

from fddbench.design.tracking.aircraft import FlightPoint
from fddbench.design.tracking.scheduled import envelope_points, fitted
from fddbench.errors import DesignError
from fddbench.systems import StateSpace

POINTS = [FlightPoint(altitude_m=h, v_tas_m_s=v) for h in (2000.0, 8000.0) for v in (180.0, 220.0, 260.0)]


def laws(gain):
    D = np.zeros((2, 7))
    return [StateSpace(np.eye(1), np.ones((1, 7)), np.full((2, 1), gain(p.dynamic_pressure_pa)), D) for p in POINTS]


def test_gains_that_are_linear_between_the_knots_are_found_exactly():
    knots = np.array([9000.0, 15000.0, 35000.0])
    C, D = fitted(POINTS, laws(lambda q: np.interp(q, knots, [1.0, -2.0, 5.0])), knots)
    np.testing.assert_allclose(C[:, 0, 0], [1.0, -2.0, 5.0])
    np.testing.assert_allclose(D, 0.0, atol=1e-12)


def test_a_knot_that_no_point_is_near_is_refused():
    with pytest.raises(DesignError, match="no point of the envelope lies near one of the knots"):
        fitted(POINTS, laws(lambda q: q), np.array([9000.0, 35000.0, 90000.0, 95000.0]))


def test_points_that_cannot_be_flown_are_left_out():
    points = envelope_points([150.0, 280.0], [1000.0, 11000.0])
    assert [(p.altitude_m, p.v_tas_m_s) for p in points] == [(1000.0, 150.0), (1000.0, 280.0), (11000.0, 280.0)]
