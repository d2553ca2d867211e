"""All manoeuvres over the envelope: none departs, and each stays within what its protection allows.

A sample of the 81 points of Table 5 that can be flown; the whole was flown once, with coefficients -10 ... 10 % and errors of
-10 and 10 %, without a departure.
"""

import numpy as np
import pytest

from fddbench.benchmarks.yaw_rate.transport.profiles import MANOEUVRES
from fddbench.flight.atmosphere import mach
from fddbench.flight.envelope import buffet_lift, lift_coefficient
from fddbench.flight.transport.limits import highest_alpha_rad
from fddbench.flight.transport.reading import twin_jet

PAPER = {"cruise", "pitch_protection_1", "yaw_angle_mode", "aoa_protection_1", "turn_coordination_2", "nose_up"}
MATURATION = {
    *("dqm", "dpm", "drm", "all_trim_mode", "side_slip_mode", "speed_change", "nose_down", "n_z_limitation_1"),
    *("speed_mach_protection", "roll_protection", "nose_up_2"),
}


def test_manoeuvres_are_those_of_tables_2_and_9():
    assert set(MANOEUVRES) == PAPER | MATURATION | {"turn_coordination_1"}


@pytest.fixture(scope="module")
def flown(six):
    """By manoeuvre: condition and signals of flights that can be flown, half of them with random coefficients."""
    loop = six.loop()
    points = six.table_5[:, ::5]
    condition = np.tile(points, (1, len(MANOEUVRES)))
    names = np.repeat(list(MANOEUVRES), points.shape[1])
    random = np.random.default_rng(2)
    share = np.where(np.arange(len(names)) % 2, 1.0, 0.0)
    deltas = {f"delta_c_{axis}_percent": share * random.uniform(-10.0, 10.0, len(names)) for axis in "xyzlmn"}
    reasons, signals = six.fly(loop, condition, names, **deltas)
    able = reasons == ""
    return {
        name: (condition[:, able & (names == name)], {k: v[:, able & (names == name)] for k, v in signals.items()})
        for name in MANOEUVRES
    }


@pytest.mark.parametrize("name", MANOEUVRES)
def test_no_flight_departs(name, flown):
    condition, signals = flown[name]
    assert condition.shape[1] >= 12
    assert not signals["departed"].any()


def gained(signals, name):
    return signals[name] - signals[name][0]


def test_cruise_holds_altitude_track_and_airspeed(flown):
    _, signals = flown["cruise"]
    assert np.abs(gained(signals, "altitude_true_ft")).max() < 1.0
    assert np.abs(gained(signals, "v_cas_true_kt")).max() < 0.1
    assert np.abs(signals["psi_deg"]).max() < 0.02


def test_turns_reach_their_bank_angle_and_hold_it(flown):
    for name, bank in (("turn_coordination_1", 20.0), ("turn_coordination_2", 33.0)):
        _, signals = flown[name]
        assert np.abs(signals["phi_true_deg"][2000] - bank).max() < 0.5
        assert np.abs(signals["beta_true_deg"][2000]).max() < 0.3
        assert signals["phi_true_deg"].max() < bank + 3.0
        assert np.abs(signals["phi_true_deg"][-1]).max() < 0.5
    _, signals = flown["turn_coordination_2"]
    assert np.abs(signals["phi_true_deg"].min(0) + 33.0).max() < 1.5


def test_yaw_angle_mode_turns_by_ten_degrees_and_back(flown):
    _, signals = flown["yaw_angle_mode"]
    assert (signals["psi_deg"][3000] > 8.5).all()
    assert (signals["psi_deg"][3000] < 10.5).all()
    assert (np.abs(signals["psi_deg"][-1]) < 1.5).all()
    assert np.abs(signals["phi_true_deg"]).max() < 18.0


def test_pitch_protection_keeps_the_nose_below_its_limit(flown):
    condition, signals = flown["pitch_protection_1"]
    limit = np.where(condition[3] <= 200.0, 25.0, 30.0)
    assert (signals["theta_true_deg"].max(0) <= limit + 1.5).all()


def test_incidence_stays_near_buffet_with_the_stick_at_its_stop(flown):
    condition, signals = flown["aoa_protection_1"]
    m, _, h, v = condition
    to_buffet = buffet_lift(mach(v, h)) / lift_coefficient(m, h, v)
    most, zero = np.rad2deg(highest_alpha_rad(twin_jet(), signals["mach"])), twin_jet().lift.alpha_zero_deg
    share = (signals["alpha_true_deg"] - zero) / (most - zero)
    assert share[:, to_buffet >= 1.1].max() <= 1.08


def test_load_factor_protection(flown):
    _, signals = flown["n_z_limitation_1"]
    assert -0.25 <= signals["n_z_true_g"].min() < 0.3
    assert 2.3 < signals["n_z_true_g"].max() <= 2.8


def test_speed_protection(flown):
    _, signals = flown["speed_mach_protection"]
    limits = twin_jet().limits
    assert limits.v_mo_kt < signals["v_cas_true_kt"].max() <= limits.v_mo_kt + 25.0
    assert signals["mach"].max() <= limits.m_mo + 0.02


def test_roll_protection_lets_67_degrees_pass_and_comes_back_to_33(flown):
    _, signals = flown["roll_protection"]
    assert (signals["phi_true_deg"].max(0) > 64.0).all()
    assert signals["phi_true_deg"].max() <= 74.0
    assert np.abs(signals["phi_true_deg"][-1] - 33.0).max() < 1.0


def test_pedals_make_sideslip(flown):
    _, signals = flown["side_slip_mode"]
    asked = np.minimum(4.0, signals["beta_true_deg"][2000])
    assert (asked > 2.0).all()
    _, signals = flown["drm"]
    assert signals["beta_true_deg"].max() > 0.8
    assert signals["beta_true_deg"].min() < -0.8


def test_speed_changes_by_ten_knots_and_back(flown):
    _, signals = flown["speed_change"]
    change = gained(signals, "v_cas_true_kt")
    assert (np.abs(np.abs(change[3200]) - 10.0) < 3.0).all()
    # where little thrust is left it comes back slowly
    assert np.median(np.abs(change[-1])) < 2.0
    assert (np.abs(change[-1]) < 10.0).all()


def test_nose_goes_up_and_down(flown):
    for name, least, most in (("nose_up", 0.5, 7.0), ("nose_up_2", 0.5, 12.0)):
        _, signals = flown[name]
        rise = gained(signals, "theta_true_deg").max(0)
        assert (rise > least).all()  # buffet caps where there is little to it
        assert (rise < most).all()
    _, signals = flown["nose_down"]
    assert (np.abs(gained(signals, "theta_true_deg")[2200] + 5.0) < 1.0).all()


def test_doublets_of_the_stick(flown):
    _, signals = flown["dpm"]
    p = signals["p_true_deg_s"]
    assert (p[:2000].max(0) > 8.0).all()
    assert (p[2400:].max(0) > 12.0).all()
    assert np.abs(signals["phi_true_deg"][2400]).max() < 1.0
    _, signals = flown["dqm"]
    pulled = gained(signals, "n_z_true_g")
    assert pulled[:1500].max() == pytest.approx(0.3, abs=0.12)
    assert pulled[3000:4000].min() == pytest.approx(-0.3, abs=0.15)


def test_heading_goes_on_beyond_half_a_turn(six):
    slow = np.array([[150e3], [0.3], [10e3], [200.0]])
    _, signals = six.fly(six.loop(sensors="ideal"), slow, "roll_protection", seconds=120.0)
    psi = signals["psi_deg"][:, 0]
    assert psi[-1] > 200.0
    assert np.abs(np.diff(psi)).max() < 0.1
