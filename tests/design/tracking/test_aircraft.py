"""The linear aircraft is the nonlinear one about its trim."""

import numpy as np
import pytest

from fddbench.design.tracking.aircraft import FlightPoint, linear_aircraft, linear_aircrafts
from fddbench.design.tracking.response import Story, fly
from fddbench.errors import DesignError

DESIGN = FlightPoint(altitude_m=7000.0, v_tas_m_s=241.0)


def test_trim_at_the_design_point():
    at = linear_aircraft(DESIGN)
    # facts of the closed loop: 0.42 deg, 2.88 deg, 41,959 N
    assert (at.alpha_deg, at.elevator_deg) == (pytest.approx(0.4237, abs=1e-3), pytest.approx(2.8845, abs=1e-3))
    assert at.thrust_kn == pytest.approx(41.959, abs=1e-3)


def test_a_gust_moves_the_nonlinear_aircraft_as_the_linear_one():
    size, at = 0.1, linear_aircraft(DESIGN)
    story = Story(duration_s=2.0, wind=lambda t: (0.0, size * (t >= 0.5)), jumps_s=(0.5,))
    flown = fly(None, DESIGN, story, step_s=0.1)
    x, fine = np.zeros(5), 1e-3
    for _ in range(round(1.4 / fine)):
        x = x + fine * (at.A @ x + at.B[:, 3] * size)
    np.testing.assert_allclose(flown["q_deg_s"][-1], x[1], rtol=0.01)
    np.testing.assert_allclose(flown["alpha_deg"][-1] - at.alpha_deg, x[0], rtol=0.01)


def test_where_there_is_no_trim():
    nowhere = FlightPoint(altitude_m=11000.0, v_tas_m_s=130.0)
    assert linear_aircrafts([DESIGN, nowhere])[1] is None
    with pytest.raises(DesignError, match="no trim at 11000 m, 130 m/s"):
        linear_aircraft(nowhere)
