"""The loop: steady in trim, its faults between actuator and air, its sensors, its wind."""

import numpy as np
import pytest

from fddbench.faults.bias import Bias
from fddbench.faults.disconnection import Disconnection
from fddbench.faults.effectiveness import Effectiveness
from fddbench.flight.wind import still

PLANTS = ("nonlinear", "lpv_fold", "lpv_approx")


@pytest.mark.parametrize("plant", PLANTS)
def test_nothing_moves_in_trim(bench, plant):
    """Over the envelope, with dispersions: each plant begins in its own trim."""
    now = bench.fly(
        bench.loop(plant=plant), 4, 20.0,
        altitude_m=[3e3, 7e3, 9e3, 10.5e3], v_tas_m_s=[180.0, 241.0, 260.0, 250.0], mass_kg=[230e3, 263e3, 300e3, 250e3],
        x_cg_ratio=[0.2, 0.25, 0.3, 0.25], delta_c_m_percent=[0.0, 5.0, -5.0, 0.0],
    )  # fmt: skip
    for name, most in (("alpha_deg", 1e-5), ("q_deg_s", 1e-5), ("v_tas_m_s", 1e-4), ("altitude_m", 1e-3)):
        assert np.abs(now[name] - now[name][0]).max() < most
    assert not now["departed"].any()


def test_a_loss_of_effectiveness_multiplies_the_total_and_is_not_measured(bench):
    lost = Effectiveness.in_unit("deg")(kind="effectiveness", sites=("elevator",), onset_s=2.0, loss_percent=30.0)
    less = Effectiveness.in_unit("N")(kind="effectiveness", sites=("thrust",), onset_s=1.0, loss_percent=20.0)
    now = bench.fly(bench.loop(faults=[[lost, less], []]), 2, 4.0, faults=[[lost, less], []])
    true, read = now["elevator_true_deg"], now["elevator_deg"]
    assert np.array_equal(true[:50], read[:50])
    np.testing.assert_allclose(true[50:, 0], 0.7 * read[50:, 0])
    np.testing.assert_allclose(now["thrust_true_n"][25:, 0], 0.8 * now["thrust_n"][25:, 0])
    np.testing.assert_allclose(now["added"][60, :, 0], [-0.3 * read[60, 0], -0.2 * now["thrust_n"][60, 0]])
    assert np.array_equal(true[:, 1], read[:, 1])
    assert not now["added"][:, :, 1].any()
    # less nose-down elevator: the aircraft pitches up; less thrust: it slows down
    assert now["q_true_deg_s"][60, 0] > 0.05
    assert now["v_tas_m_s"][-1, 0] < now["v_tas_m_s"][-1, 1]


def test_a_loose_elevator_floats_with_the_angle_of_attack(bench):
    loose = Disconnection.in_unit("deg")(kind="disconnection", sites=("elevator",), onset_s=1.0)
    now = bench.fly(bench.loop(faults=[[loose]]), 1, 3.0, faults=[[loose]], float_ratio=-0.4)
    true, alpha = now["elevator_true_deg"][:, 0], now["alpha_true_deg"][:, 0]
    decay = np.exp(-0.04 / 0.1)
    expected = now["elevator_deg"][24, 0]
    for k in range(25, 75):
        expected = -0.4 * alpha[k] + decay * (expected + 0.4 * alpha[k])
        assert true[k] == pytest.approx(expected, abs=1e-9)


def test_sensor_errors_are_on_what_is_measured_only(bench):
    now = bench.fly(
        bench.loop(), 2, 0.4,
        alpha_error_deg=[0.5, 0.0], q_error_deg_s=[0.1, 0.0], v_tas_error_percent=[2.0, 0.0], theta_error_deg=[-0.3, 0.0],
        altitude_error_m=[30.0, 0.0],
    )  # fmt: skip
    assert now["alpha_deg"][5, 0] - now["alpha_true_deg"][5, 0] == pytest.approx(0.5)
    assert now["v_tas_m_s"][5, 0] == pytest.approx(1.02 * now["v_tas_true_m_s"][5, 0])
    assert now["altitude_m"][5, 0] - now["altitude_true_m"][5, 0] == pytest.approx(30.0)
    assert np.array_equal(now["alpha_true_deg"][:, 0], now["alpha_true_deg"][:, 1])


def test_noise_has_the_size_of_its_preset(bench):
    now = bench.fly(bench.loop(sensors="realistic"), 1, 120.0)
    noise = bench.benchmark.choices["sensors"].options["realistic"]
    for name, of in (("alpha_deg", "alpha_true_deg"), ("thrust_n", "thrust_true_n"), ("q_deg_s", "q_true_deg_s")):
        assert np.std(now[name] - now[of]) == pytest.approx(getattr(noise, name), rel=0.06)


def test_turbulence_reaches_the_aircraft(bench):
    now = bench.fly(bench.loop(wind="moderate"), 2, 30.0, gust_scale_ratio=[1.0, 0.0])
    assert np.std(now["w_gust_m_s"][:, 0]) > 0.5
    assert np.std(now["alpha_deg"][:, 0]) > 0.1
    assert not now["w_gust_m_s"][:, 1].any()
    assert np.ptp(now["alpha_deg"][:, 1]) < 1e-5


@pytest.mark.parametrize("plant", ["lpv_fold", "lpv_approx"])
@pytest.mark.parametrize("component", ["u_m_s", "w_m_s", "q_rad_s"])
def test_a_gust_moves_the_affine_aircraft_like_the_nonlinear_one(bench, plant, component):
    """One second in a steady small gust of one component: the same pitch rate within a fifth of the larger effect."""
    size = {"u_m_s": 2.0, "w_m_s": 2.0, "q_rad_s": 0.01}[component]
    air = still(np.zeros(1), **{component: np.array([size])})
    found = []
    for name in ("nonlinear", plant):
        loop = bench.loop(plant=name)
        c = bench.prepare(loop, 1).constants.plant
        x = loop.plant.states.spread(loop.plant.start(c), 1)
        at = c.trim
        for _ in range(25):
            x, _ = loop.plant.step(x, c, None, np.stack([at.elevator_deg, at.stabiliser_deg, at.thrust_n]), air)
        found.append([float(x.q_rad_s[0]), float((x.theta_rad - x.alpha_rad)[0])])
    expected, ours = np.array(found)
    assert np.abs(expected).max() > 5e-4
    np.testing.assert_allclose(ours, expected, atol=0.2 * np.abs(expected).max())


def test_thrust_falls_with_airspeed_at_a_held_lever(bench):
    now = bench.fly(bench.loop(), 2, 60.0, manoeuvre="elevator_pulse", thrust_lapse_ratio=[0.0, 0.5])
    assert np.ptp(now["thrust_n"][:, 0]) < 1e-6
    rise = now["v_tas_true_m_s"][:, 1] / 241.0 - 1.0
    np.testing.assert_allclose(now["thrust_n"][:, 1], now["thrust_n"][0, 1] * (1.0 - 0.5 * rise), rtol=1e-9)


def test_a_flight_that_leaves_the_model_departs(bench):
    stuck = Bias.in_unit("deg")(kind="bias", sites=("elevator",), onset_s=1.0, amplitude_deg=-15.0)
    now = bench.fly(bench.loop(faults=[[stuck]]), 1, 30.0, faults=[[stuck]])
    assert now["departed"][:25].max() == 0.0
    assert now["departed"].max() == 1.0


def test_what_cannot_be_flown_says_why(bench):
    prepared = bench.prepare(
        bench.loop(), 5,
        mass_kg=[263e3, 330e3, 263e3, 263e3, 263e3], altitude_m=[7e3, 11e3, 1e3, 2e3, 7e3],
        v_tas_m_s=[241.0, 275.0, 280.0, 120.0, 241.0], stabiliser_deg=[-0.54, -0.54, -0.54, -0.54, -20.0],
    )  # fmt: skip
    reasons = prepared.infeasible_reason
    assert reasons[0] == ""
    assert "thrust" in reasons[1]
    assert "airspeed 120 m/s, not in 150 ... 280" in reasons[3]
    assert "elevator" in reasons[4]


def test_the_trim_elevator_is_derived_for_the_report(bench):
    chosen = {key: next(iter(choice.options.values())) for key, choice in bench.benchmark.choices.items()}
    found = bench.benchmark.derived(chosen, bench.parameters(2, altitude_m=[7e3, 9e3]))
    assert found["elevator_trim_deg"] == pytest.approx([2.885, 1.994], abs=1e-3)
