"""Manoeuvres: what the tables say, and that the closed loop flies them."""

import numpy as np
import pytest

from fddbench.benchmarks.yaw_rate.manoeuvres import DURATIONS_S, KNOTS, bank_commands

NAMES = tuple(DURATIONS_S)
# mass, X_cg, altitude, airspeed: centre, and corners of the published box
POINTS = np.array(
    [(200e3, 0.3, 20e3, 290), (180e3, 0.27, 15e3, 260), (220e3, 0.33, 25e3, 320), (220e3, 0.27, 25e3, 260)]
)
N_POINTS = len(POINTS)


@pytest.fixture(scope="module")
def flown(bench):
    """All manoeuvres at all points, side by side, once."""
    loop = bench.loop()
    names = [name for name in NAMES for _ in range(N_POINTS)]
    mass, x_cg, altitude, v_cas = np.tile(POINTS, (len(NAMES), 1)).T
    signals = bench.fly(
        loop, len(names), 60.0, manoeuvres=names, detector=bench.sliding_mode(loop),
        mass_kg=mass, x_cg_ratio=x_cg, altitude_ft=altitude, v_cas_kt=v_cas,
    )  # fmt: skip
    return {
        name: {key: value[..., N_POINTS * i : N_POINTS * (i + 1)] for key, value in signals.items()}
        for i, name in enumerate(NAMES)
    }


@pytest.mark.parametrize("name", NAMES)
def test_flown_without_departing_and_back_to_wings_level(flown, name):
    now = flown[name]
    assert not now["departed"].any()
    assert np.abs(now["phi_true_deg"][-1]).max() < 0.2
    assert np.abs(now["beta_true_deg"]).max() < 2.0
    assert np.abs(now["phi_true_deg"]).max() <= 1.35 * np.abs(now["bank_command_deg"]).max()


@pytest.mark.parametrize("name", NAMES)
def test_bank_follows_the_command_half_a_second_to_a_second_later(flown, name):
    command, phi = flown[name]["bank_command_deg"], flown[name]["phi_true_deg"]
    error = min(np.abs(phi[lag:] - command[: len(command) - lag]).max() for lag in range(30, 110, 10))
    assert error <= 0.35 * np.abs(command).max()


def test_steady_turn_holds_the_bank_and_the_turn_rate(flown):
    """``psi' = g tan(phi) / V``, here of the linear model: g phi / V within its sideslip."""
    now = flown["turn_coordination_1"]
    held = slice(2400, 2800)
    np.testing.assert_allclose(now["phi_true_deg"][held], 20.0, atol=0.3)
    rate = (now["psi_deg"][2800] - now["psi_deg"][2400]) / 4.0
    np.testing.assert_allclose(rate, np.rad2deg(9.80665 / now["v_tas_m_s"][0]) * np.deg2rad(20.0), rtol=0.06)


def test_yaw_angle_mode_turns_by_10_deg_and_back_at_every_speed(flown):
    psi = flown["yaw_angle_mode"]["psi_deg"]
    np.testing.assert_allclose(psi[2990], 10.0, atol=0.3)
    np.testing.assert_allclose(psi[-1], 0.0, atol=0.05)


def test_cruise_is_perfectly_still(flown):
    for name in ("phi_true_deg", "beta_true_deg", "psi_deg", "y_m", "residual"):
        assert not flown["cruise"][name].any()


@pytest.mark.parametrize("name", NAMES)
def test_healthy_reconstruction_stays_small_with_the_model_known(flown, name):
    """Plant and observer share the model: what is left is input lag and the threshold that opens."""
    assert np.abs(flown[name]["reconstruction_deg_s"]).max() < 0.25
    assert not flown[name]["declared"].any()


@pytest.mark.parametrize("name", NAMES)
def test_tables_rise_in_time_are_padded_and_start_level(name):
    for v in (70.0, 130.0, 200.0, 290.0):
        time_s, bank_deg = bank_commands([name], np.array([v]))
        assert time_s.shape == bank_deg.shape == (KNOTS, 1)
        assert (np.diff(time_s[:, 0]) >= 0.0).all()
        assert time_s[-1, 0] <= DURATIONS_S[name]
        assert bank_deg[0, 0] == bank_deg[-1, 0] == 0.0


def test_each_case_has_its_own_table():
    names = ["cruise", "yaw_angle_mode", "roll_doublet"]
    v = np.array([150.0, 200.0, 250.0])
    together = bank_commands(names, v)
    for i, name in enumerate(names):
        alone = bank_commands([name], v[i : i + 1])
        for all_of_them, own in zip(together, alone, strict=True):
            assert np.array_equal(all_of_them[:, i], own[:, 0])
