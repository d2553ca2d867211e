"""The aircraft: integration against the matrix exponential, constants, travel and measured parameters."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from fddbench.benchmarks.yaw_rate.plant import PLANT_NEEDS
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant, LateralState, rudder_travel_deg
from fddbench.blocks.layout import Nothing, leaves
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.lateral_lpv import SCHEDULING, derivatives, lateral_lpv
from fddbench.flight.wind import still

RANDOM = np.random.default_rng(0)
PLANT = LateralLpvPlant(0.01, 1)


def constants(n=1, **given_values):
    values = {p.name: np.full(n, p.default) for p in PLANT.parameters}
    values |= {name: np.broadcast_to(np.asarray(v, float), n).copy() for name, v in given_values.items()}
    prepared = PLANT.prepare(values, ["cruise"] * n)
    PLANT.constants.check(prepared.constants, n)
    return prepared.constants, prepared.infeasible_reason


def state(*values):
    """State of one flight: phi, V_y, p, r, psi, y."""
    return PLANT.states.unpack(np.array(values)[:, np.newaxis])


def flown(x, c, *, u, gust, substeps=1):
    """State at the next sample of 10 ms."""
    after, _ = LateralLpvPlant(0.01, substeps).step(x, c, Nothing(), u, still(gust, v_m_s=gust), 0.0)
    return after


@pytest.mark.parametrize("substeps", [1, 2])
@pytest.mark.parametrize("delta", [0.0, -5.0])
def test_runge_kutta_is_the_matrix_exponential_for_held_surfaces(substeps, delta):
    c, _ = constants(mass_kg=185e3, v_cas_kt=300.0, delta_c_n_percent=delta, delta_c_y_percent=delta)
    model = lateral_lpv()
    A, B = model.matrices(model.rho(*[getattr(c, name) for name in SCHEDULING]))
    u, gust = RANDOM.normal(size=(13, 1)), np.array([1.3])
    zero = (c.delta_c_y, c.delta_c_l, c.delta_c_n)
    M, f = derivatives(A, B, u, u0_m_s=c.u0_m_s, w0_m_s=c.w0_m_s, gust_m_s=gust, delta=zero)
    block = np.zeros((5, 5))
    block[:4, :4], block[:4, 4] = M[:, :, 0], f[:, 0]
    lateral = (0.1, 2.0, 0.05, -0.03)
    x, exact = state(*lateral, 0.0, 0.0), np.array([*lateral, 1.0])
    for _ in range(100):
        x = flown(x, c, u=u, gust=gust, substeps=substeps)
        exact = expm(block * 0.01) @ exact
    found = [x.phi_rad[0], x.v_y_m_s[0], x.p_rad_s[0], x.r_rad_s[0]]
    np.testing.assert_allclose(found, exact[:4], rtol=1e-8, atol=1e-9)


def test_heading_and_track_are_the_integrals_of_yaw_rate_and_drift():
    c, _ = constants()
    x, y_m = state(0.0, 1.0, 0.0, 0.02, 0.3, 5.0), 5.0
    for _ in range(200):
        before = x
        x = flown(x, c, u=np.zeros((13, 1)), gust=np.zeros(1))
        turned = 0.005 * (x.r_rad_s[0] + before.r_rad_s[0])
        assert x.psi_rad[0] - before.psi_rad[0] == pytest.approx(turned, abs=1e-15)
        y_m += 0.01 * (199.28 * np.sin(before.psi_rad[0]) + before.v_y_m_s[0] * np.cos(before.psi_rad[0]))
    assert x.y_m[0] == pytest.approx(y_m, abs=1e-2)


@settings(max_examples=30)
@given(st.floats(150e3, 230e3), st.floats(0.2, 0.4), st.floats(5e3, 38e3), st.floats(180.0, 330.0),
       st.tuples(*[st.floats(-10.0, 10.0)] * 4))  # fmt: skip
def test_measured_is_true_times_one_plus_the_error(mass, x_cg, altitude, v_cas, errors):
    names = ("mass", "x_cg", "altitude", "v_cas")
    errors = {f"{name}_error_percent": error for name, error in zip(names, errors, strict=True)}
    true = {"mass_kg": mass, "x_cg_ratio": x_cg, "altitude_ft": altitude, "v_cas_kt": v_cas}
    c, _ = constants(**true, **errors)
    for name, unit in zip(names, ("kg", "ratio", "ft", "kt"), strict=True):
        value = true[f"{name}_{unit}"]
        assert getattr(c, f"{name}_{unit}")[0] == value
        assert getattr(c, f"{name}_measured_{unit}")[0] == pytest.approx(
            value * (1 + errors[f"{name}_error_percent"] / 100), rel=1e-15
        )
    # the plant flies the true speed, law and detectors know the one of the measured values
    assert c.v_tas_m_s[0] == true_airspeed_m_s(np.array([v_cas]), np.array([altitude]))[0]
    measured = true_airspeed_m_s(c.v_cas_measured_kt, c.altitude_measured_ft)
    assert c.v_tas_measured_m_s.tobytes() == measured.tobytes()


def test_infeasible_cases_are_told_by_their_true_parameters():
    _, reasons = constants(3, v_cas_kt=[290.0, 335.0, 290.0], v_cas_error_percent=[0.0, 0.0, 20.0])
    assert [reason[:10] for reason in reasons] == ["", "above V_MO", ""]


def test_rudder_travel_falls_with_dynamic_pressure():
    v = np.linspace(100.0, 400.0, 200)
    travel = rudder_travel_deg(v)
    assert (np.diff(travel) <= 0.0).all()
    assert (travel.min(), travel.max()) == (5.0, 30.0)
    inside = (v > 165.0) & (v < 300.0)
    line = np.polyfit(1.0 / v[inside] ** 2, travel[inside], 1)
    np.testing.assert_allclose(np.polyval(line, 1.0 / v[inside] ** 2), travel[inside], rtol=1e-9)


def test_travel_of_the_thirteen_surfaces():
    c, _ = constants(2, v_cas_kt=[400.0, 150.0])
    low, high = PLANT.travel(c)
    assert low[:, 1].tolist() == [-30.0] + [-25.0] * 4 + [0.0] * 8
    assert high[:, 0].tolist() == [5.0] + [25.0] * 4 + [35.0] * 8


def test_travel_of_the_rudder_is_that_of_the_flight():
    c, _ = constants(1, v_cas_kt=250.0)
    low, high = PLANT.travel(c)
    expected = rudder_travel_deg(np.array([250.0]))[0]
    assert (low[0, 0], high[0, 0]) == (-expected, expected)
    assert 5.0 < expected < 30.0


def test_begins_in_trim():
    c, _ = constants(2)
    begun = PLANT.states.spread(PLANT.start(c), 2)
    assert isinstance(begun, LateralState)
    assert all(not rows.any() for _, rows in leaves(begun))


def test_has_what_a_plant_needs():
    assert [name for name in PLANT_NEEDS if not hasattr(LateralLpvPlant, name)] == []


def test_motion_is_the_state_in_degrees_beside_what_is_measured():
    c, _ = constants(1, mass_error_percent=10.0)
    x = state(0.1, 3.0, 0.05, -0.03, 0.3, 5.0)
    _, motion = PLANT.step(x, c, Nothing(), np.zeros((13, 1)), still(x.r_rad_s, v_m_s=np.array([1.0])), 0.0)
    angles = (motion.phi_deg[0], motion.p_deg_s[0], motion.r_deg_s[0], motion.psi_deg[0])
    assert angles == pytest.approx(np.rad2deg([0.1, 0.05, -0.03, 0.3]), rel=1e-14)
    assert motion.beta_deg[0] == pytest.approx(np.rad2deg(np.arcsin((3.0 - 1.0) / c.v_tas_m_s[0])), rel=1e-12)
    assert motion.mass_measured_kg[0] == pytest.approx(220e3)
    assert (motion.y_m[0], motion.departed.tolist()) == (5.0, [False])
