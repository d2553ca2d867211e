"""ISA and airspeed conversions against printed tables, and the laws they keep between the entries."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.flight import atmosphere as isa

altitudes = st.floats(0.0, 45e3)
speeds = st.floats(80.0, 350.0)


def one(value):
    return np.array([float(value)])


# ISO 2533:1975 / ICAO Doc 7488 tables: geopotential altitude [ft], temperature [K], pressure [Pa], density [kg/m^3]
LITERATURE = (
    (0.0, 288.15, 101325.0, 1.2250),
    (20000.0, 248.526, 46563.3, 0.65269),
    (11000.0 / 0.3048, 216.65, 22632.0, 0.36392),
    (38000.0, 216.65, 20646.2, 0.33198),
)


@pytest.mark.parametrize(("altitude_ft", "t_k", "p_pa", "rho_kg_m3"), LITERATURE)
def test_literature_standard_atmosphere(altitude_ft, t_k, p_pa, rho_kg_m3):
    assert isa.temperature_k(one(altitude_ft))[0] == pytest.approx(t_k, abs=1e-3)
    assert isa.pressure_pa(one(altitude_ft))[0] == pytest.approx(p_pa, rel=2e-5)
    assert isa.density_kg_m3(one(altitude_ft))[0] == pytest.approx(rho_kg_m3, rel=3e-5)


def test_literature_speed_of_sound():
    assert isa.sound_speed_m_s(one(0.0))[0] == pytest.approx(340.294, abs=1e-3)
    assert isa.sound_speed_m_s(one(40e3))[0] == pytest.approx(295.069, abs=1e-3)


def test_literature_published_trim_point():
    assert isa.true_airspeed_m_s(one(290.0), one(20e3))[0] == pytest.approx(199.28, abs=5e-3)
    assert isa.mach(one(290.0), one(20e3))[0] == pytest.approx(0.6306, abs=5e-5)


def test_literature_knot_and_foot():
    assert pytest.approx(0.514444, abs=1e-6) == isa.KT_M_S
    assert isa.FT_M == 0.3048


@given(speeds)
def test_calibrated_is_true_airspeed_at_sea_level(v_cas_kt):
    assert isa.true_airspeed_m_s(one(v_cas_kt), one(0.0))[0] == pytest.approx(v_cas_kt * 1852 / 3600, rel=1e-12)


@given(speeds, altitudes)
def test_impact_pressure_is_what_the_pitot_sees(v_cas_kt, altitude_ft):
    """The same impact pressure defines CAS at sea level and Mach aloft (isentropic pitot formula)."""
    at_sea = 101325.0 * ((1 + 0.2 * (v_cas_kt * 1852 / 3600 / 340.29399) ** 2) ** 3.5 - 1)
    number = isa.mach(one(v_cas_kt), one(altitude_ft))[0]
    aloft = isa.pressure_pa(one(altitude_ft))[0] * ((1 + 0.2 * number**2) ** 3.5 - 1)
    assert aloft == pytest.approx(at_sea, rel=1e-6)


@given(speeds, altitudes)
def test_dynamic_pressure_is_half_rho_v_squared(v_cas_kt, altitude_ft):
    v = isa.true_airspeed_m_s(one(v_cas_kt), one(altitude_ft))[0]
    expected = 0.5 * isa.density_kg_m3(one(altitude_ft))[0] * v * v
    assert isa.dynamic_pressure_pa(one(v_cas_kt), one(altitude_ft))[0] == pytest.approx(expected, rel=1e-12)


@given(altitudes)
def test_pressure_is_hydrostatic(altitude_ft):
    """``dp/dh = -rho g``, on both sides of the tropopause and across it."""
    step_ft = 0.5
    low, high = isa.pressure_pa(one(altitude_ft - step_ft))[0], isa.pressure_pa(one(altitude_ft + step_ft))[0]
    slope = (high - low) / (2 * step_ft * isa.FT_M)
    assert slope == pytest.approx(-isa.density_kg_m3(one(altitude_ft))[0] * 9.80665, rel=1e-5)


@given(speeds, altitudes, st.floats(1.0, 5000.0))
def test_true_airspeed_and_mach_rise_with_altitude_and_speed(v_cas_kt, altitude_ft, more):
    for quantity in (isa.mach, isa.true_airspeed_m_s):
        here = quantity(one(v_cas_kt), one(altitude_ft))[0]
        assert quantity(one(v_cas_kt), one(altitude_ft + more))[0] > here
        assert quantity(one(v_cas_kt + more / 100.0), one(altitude_ft))[0] > here
    assert isa.pressure_pa(one(altitude_ft + more))[0] < isa.pressure_pa(one(altitude_ft))[0]
    assert isa.density_kg_m3(one(altitude_ft + more))[0] < isa.density_kg_m3(one(altitude_ft))[0]


@settings(max_examples=20)
@given(st.lists(st.tuples(speeds, altitudes), min_size=2, max_size=9))
def test_bits_do_not_depend_on_the_company(points):
    v, h = np.array(points).T
    together = isa.true_airspeed_m_s(v, h)
    alone = np.concatenate([isa.true_airspeed_m_s(v[i : i + 1], h[i : i + 1]) for i in range(len(v))])
    assert together.tobytes() == alone.tobytes()
