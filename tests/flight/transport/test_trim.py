"""Level trim over the whole envelope."""

import numpy as np
import pytest

from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.air import air_around
from fddbench.flight.transport.equations import State, derivative, flow_of, forces, thrust_n
from fddbench.flight.transport.motion import motion_of
from fddbench.flight.transport.trim import neutral, residual, trim
from fddbench.flight.wind import still


def test_nothing_accelerates_at_any_point_of_table_5(twin):
    body, at = twin.trimmed(*twin.table_5)
    assert np.abs(residual(twin.jet, body, at)).max() < 1e-9  # attained 4e-15


def test_centre(twin):
    _, at = twin.trimmed(200e3, 0.30, 20e3, 290.0)
    assert np.rad2deg(at.alpha_rad[0]) == pytest.approx(2.66, abs=0.005)
    assert np.rad2deg(at.stabiliser_rad[0]) == pytest.approx(-2.75, abs=0.005)
    lift = 200e3 * GRAVITY_M_S2 / (twin.jet.reference.dynamic_pressure_pa * 361.6)
    assert lift == pytest.approx(0.4185, abs=1e-4)
    density, temperature = air_around(at.altitude_m).at(at.altitude_m)
    flow, _, _ = flow_of(twin.jet, State(*at.rows()), still(at.alpha_rad), density, temperature)
    assert at.thrust_ratio[0] * thrust_n(twin.jet, density, flow.mach)[0] == pytest.approx(111e3, abs=500.0)


def test_the_same_bits_in_any_company(twin):
    _, at = twin.trimmed(*twin.table_5[:, :7])
    for i in range(7):
        _, alone = twin.trimmed(*twin.table_5[:, i])
        assert [rows[i] for rows in at] == [rows[0] for rows in alone]


def test_a_trimmed_flight_moves_north_and_nowhere_else(twin):
    body, at = twin.trimmed(*twin.table_5[:, ::9])
    found = derivative(
        twin.jet, body, air_around(at.altitude_m), at.rows(), neutral(at.stabiliser_rad), still(at.alpha_rad),
        at.thrust_ratio,
    )  # fmt: skip
    expected = np.zeros_like(found)
    expected[10] = at.v_tas_m_s
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert trim(twin.jet, body, at.v_tas_m_s, at.altitude_m).alpha_rad.tobytes() == at.alpha_rad.tobytes()


def test_in_level_flight_the_drag_is_the_thrust_along_the_path(twin):
    """And lift over drag is that of a transport aircraft."""
    body, at = twin.trimmed(*twin.table_5[:, ::9])
    air, begun = air_around(at.altitude_m), State(*at.rows())
    felt = forces(twin.jet, body, air, begun, neutral(at.stabiliser_rad), still(at.alpha_rad), at.thrust_ratio)
    motion = motion_of(begun, air, felt, 0.0, 0.0, mass_kg=body.mass_kg)
    np.testing.assert_allclose(motion.drag_n, body.mass_kg * felt.thrust * np.cos(at.alpha_rad), rtol=1e-12)
    glide = body.mass_kg * GRAVITY_M_S2 / motion.drag_n
    assert (glide > 10.0).all()
    assert (glide < 20.0).all()
