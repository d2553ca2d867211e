"""The linear-quadratic law follows its models, whatever they are."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from fddbench.design.tracking.aircraft import FlightPoint, linear_aircraft
from fddbench.design.tracking.closed_loop import actuated
from fddbench.design.tracking.lqi import Tolerances, lqi_law, regulator
from fddbench.design.tracking.reference import corner_rad_s

TOLERANCES = Tolerances(
    settling_s=(15.0, 45.0),
    error=(0.5, 0.7),
    integral=(1.0, 3.0),
    pitch_rate_deg_s=2.0,
    order=(1.0, 8.0),
    speed_filter_s=20.0,
)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32))
def test_the_regulator_equations_hold(seed):
    random = np.random.default_rng(seed)
    A, B, C, S = (random.standard_normal(shape) for shape in ((4, 4), (4, 2), (2, 4), (3, 3)))
    C_m = random.standard_normal((2, 3))
    x, u = regulator(A, B, C, S, C_m)
    size = 1.0 + np.abs(x).max() + np.abs(u).max()
    np.testing.assert_allclose(x @ S, A @ x + B @ u, atol=1e-7 * size)
    np.testing.assert_allclose(C @ x, C_m, atol=1e-7 * size)


def test_a_step_of_flight_path_is_that_of_the_model_and_leaves_the_speed():
    plant, law = (
        actuated(linear_aircraft(FlightPoint(altitude_m=7000.0, v_tas_m_s=241.0))),
        lqi_law(linear_aircraft(FlightPoint(altitude_m=7000.0, v_tas_m_s=241.0)), TOLERANCES),
    )
    n = plant.order
    A = np.block([[plant.A + plant.B @ law.D @ plant.C, plant.B @ law.C], [law.B @ plant.C, law.A]])
    by_step = np.concatenate([plant.B @ law.D[:, 0], law.B[:, 0]])
    whole = np.zeros((len(A) + 1, len(A) + 1))
    whole[:-1, :-1], whole[:-1, -1] = A, by_step
    w = corner_rad_s(15.0)
    for t in (2.0, 5.0, 15.0, 40.0):
        x = expm(whole * t)[:-1, -1]
        seen = plant.C @ x[:n]
        # engines and elevator lag, which the design leaves out
        assert abs(seen[2] - (1.0 - (1.0 + w * t) * np.exp(-w * t))) < 0.02
        assert abs(seen[6]) < 0.05
