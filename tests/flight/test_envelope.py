"""The level-flight envelope: laws that any choice of its numbers must keep."""

from collections import Counter
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.flight import envelope
from fddbench.flight.atmosphere import density_kg_m3, true_airspeed_m_s
from fddbench.flight.transport.reading import twin_jet

masses, altitudes, speeds = st.floats(110e3, 250e3), st.floats(1e3, 40e3), st.floats(150.0, 330.0)


GRID = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T[[0, 2, 3]]
"""Mass, altitude and airspeed of the grid of Table 5 of the paper."""


def one(value):
    return np.array([float(value)])


@given(masses, altitudes, speeds)
def test_lift_carries_the_weight(mass, altitude, v_cas):
    v = true_airspeed_m_s(one(v_cas), one(altitude))
    q = 0.5 * density_kg_m3(one(altitude)) * v * v
    lift = envelope.lift_coefficient(one(mass), one(altitude), one(v_cas)) * q * 361.6
    np.testing.assert_allclose(lift, mass * 9.80665, rtol=1e-12)


@given(masses, altitudes, speeds, st.floats(1e3, 50e3))
def test_a_lighter_aircraft_flies_wherever_a_heavier_one_does(mass, altitude, v_cas, less):
    heavy, light = (envelope.infeasible_reasons(one(m), one(altitude), one(v_cas))[0] for m in (mass, mass - less))
    assert light == "" or heavy != ""


@given(masses, altitudes, speeds)
def test_every_refusal_says_which_limit_and_by_how_much(mass, altitude, v_cas):
    (reason,) = envelope.infeasible_reasons(one(mass), one(altitude), one(v_cas))
    assert reason == "" or reason.startswith(("above V_MO: ", "above M_MO: ", "buffet: ", "thrust: "))


def test_each_limit_is_met_somewhere():
    mass = np.array([200e3, 200e3, 233e3, 233e3, 200e3])
    altitude = np.array([5e3, 38e3, 38e3, 38e3, 20e3])
    v_cas = np.array([331.0, 300.0, 160.0, 240.0, 290.0])
    reasons = envelope.infeasible_reasons(mass, altitude, v_cas)
    assert [reason.split(":")[0] for reason in reasons] == ["above V_MO", "above M_MO", "buffet", "thrust", ""]


def test_the_drag_rise_is_the_cube_beyond_its_mach_number():
    """200 t at 30,000 ft and 320 kt: Mach 0.842, C_L 0.335; the formula of the docstring, by hand."""
    mass, altitude, v_cas = one(200e3), one(30e3), one(320.0)
    number, lift = envelope.mach(v_cas, altitude)[0], envelope.lift_coefficient(mass, altitude, v_cas)[0]
    rise = number - 0.785 + 0.10 * (lift - 0.45)
    assert 0.03 < rise < 0.06  # so that a square or a fourth power would be far off
    q = envelope.dynamic_pressure_pa(v_cas, altitude)[0]
    by_hand = (0.0165 + 0.041 * lift**2 + 20.0 * rise**3) * q * 361.6
    np.testing.assert_allclose(envelope.drag_n(mass, altitude, v_cas)[0], by_hand, rtol=1e-12)


def words(reasons):
    return Counter(reason.split(":")[0] for reason in reasons)


def test_27_of_the_108_points_of_table_5_cannot_be_flown():
    found = words(envelope.infeasible_reasons(*GRID))
    assert found == {"": 81, "above M_MO": 9, "buffet": 15, "thrust": 3}


def test_literature_the_flight_of_the_paper_s_figure_5_flies():
    where = one(185e3), one(37e3), one(267.0)
    assert envelope.infeasible_reasons(*where) == ("",)
    assert envelope.drag_n(*where)[0] / 1e3 == pytest.approx(102.0, abs=0.5)
    weaker = twin_jet().model_copy(update={"thrust": twin_jet().thrust.model_copy(update={"sea_level_n": 620e3})})
    assert envelope.infeasible_reasons(*where, aircraft=weaker) == ("thrust: 102 kN needed, 98 kN available",)


def test_a_manoeuvre_needs_more_than_its_trim():
    """The steady turn of 33 deg takes 12 more points, 20 kt less takes 9; both say why."""
    flies = np.array([reason == "" for reason in envelope.infeasible_reasons(*GRID)])
    mass, altitude, v_cas = GRID[:, flies]
    turn = envelope.infeasible_reasons(mass, altitude, v_cas, load_factor=1.0 / np.cos(np.radians(33.0)))
    assert words(turn) == {"": 69, "buffet": 9, "thrust": 3}
    assert all(reason.endswith(" at load factor 1.19") for reason in turn if reason)
    assert words(envelope.infeasible_reasons(mass, altitude, v_cas - 20.0)) == {"": 72, "buffet": 9}


@given(masses, altitudes, speeds, st.floats(1.0, 2.5), st.floats(0.01, 1.0))
def test_who_cannot_pull_less_cannot_pull_more(mass, altitude, v_cas, factor, more):
    where = one(mass), one(altitude), one(v_cas)
    easy, hard = (envelope.infeasible_reasons(*where, load_factor=n)[0] for n in (factor, factor + more))
    assert easy == "" or hard != ""
