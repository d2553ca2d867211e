"""The ideal test of the yaw-rate benchmark: numbers of an independent study, and the model against flights."""

import numpy as np
import pytest
from scipy.linalg import expm

import fddbench
from fddbench.benchmarks.yaw_rate.ideal import ideal_models
from fddbench.benchmarks.yaw_rate.sensors import PRESETS
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.flight.rotating_gust import LATERAL_WINDS, LateralGust
from fddbench.interfaces.benchmark import default_choices
from fddbench.kinds import load
from fddbench.metrics.bound import Faults, detectability, power

SAMPLE_S, BEFORE, WITHIN = 0.01, 1000.0, 37  # 0.36 s after the first faulty sample, with its own
TIME_S = np.arange(WITHIN)[:, np.newaxis] * SAMPLE_S
D_99 = 4.7534 + 2.3263  # found in 99 % at a false alarm in a million


def models(wind=None, **others):
    bench = load("benchmark", "yaw_rate")()
    chosen = default_choices(bench) | ({"wind": wind} if wind else {}) | others
    values = {p.name: np.array([p.default]) for p in bench.plant(chosen).parameters}
    return bench.ideal(chosen, values, SAMPLE_S)


def one_or_pair(model, added):
    """Between "these two are off by f" and "the third is off by -f" lies f on all three."""
    return detectability(model, Faults(added=dict.fromkeys(("r1", "r2", "r3"), added), before=np.array([BEFORE])))[0][0]


def distance(model, added):
    return detectability(model, Faults(added={"r1": added, "r2": added}, before=np.array([BEFORE])))[1][0]


@pytest.mark.parametrize(("name", "jam_deg_s", "ramp_deg_s2"), [
    ("exact", 0.008, 0.039), ("walk 0.05", 0.022, 0.19), ("walk 0.5", 0.037, 1.06),
])  # fmt: skip
def test_smallest_pair_faults_of_the_study(name, jam_deg_s, ramp_deg_s2):
    """Smallest pair jam and ramp that are told from the mirrored fault in 99 % within 0.36 s, in light turbulence.

    One or pair is all that the study decides. A pair jam of 0.008 deg/s is not yet told from health, which ours asks for too:
    that takes 0.009 deg/s.
    """
    model = models(LateralGust(0.5))[name]
    jam, ramp = (0.01 * D_99 / one_or_pair(model, 0.01 * added) for added in (np.ones_like(TIME_S), TIME_S))
    assert jam == pytest.approx(jam_deg_s, abs=6e-4)
    assert ramp == pytest.approx(ramp_deg_s2, rel=0.03)
    if name == "exact":
        assert 0.01 * D_99 / distance(model, 0.01 * np.ones_like(TIME_S)) == pytest.approx(0.0094, abs=1e-4)


def test_an_oscillation_from_phase_0_is_the_published_fault_that_can_be_missed():
    """1.5 deg/s at 0.5385 rad/s; with an unknown yaw acceleration d 5.5 and P_D 0.77, else well above."""
    sine = 1.5 * np.sin(0.5385 * TIME_S)
    own = models(LateralGust(0.5))
    d = {name: distance(model, sine) for name, model in own.items()}
    assert d["walk 0.5"] == pytest.approx(5.5, abs=0.05)
    assert power(d["walk 0.5"]) == pytest.approx(0.77, abs=0.01)
    assert d["walk 0.05"] > 25.0


@pytest.mark.parametrize("sigma_m_s", [0.0, 0.5, 3.0])
def test_every_published_pair_fault_is_beyond_doubt_at_any_gust(sigma_m_s):
    """Jam, oscillation, both runaways (1.5 s for the slow one); noise and NRZ are larger still.

    The study states d >= 100 for all of them; in gust we find 26 for Runaway-A with a random walk of 0.5 deg/s^2, where the
    model's yaw acceleration takes up a ramp and only the sideslip that it would cause gives it away: P_D is one all the same.
    """
    slow = 1.0 * np.arange(151)[:, np.newaxis] * SAMPLE_S
    fast = [2.0 * np.ones_like(TIME_S), 1.5 * np.sin(0.5385 * TIME_S - 1.026), 20.0 * TIME_S]
    own = models(LateralGust(sigma_m_s))
    assert min(distance(own["exact"], added) for added in (*fast, slow)) >= 100.0
    assert min(distance(own["walk 0.5"], added) for added in fast) >= 100.0
    assert power(distance(own["walk 0.5"], slow)) == 1.0


def test_the_model_is_that_of_the_flights():
    """Innovations of its Kalman filter on a flight in gust have the covariance that it says."""
    campaign = fddbench.read("smoke", ["wind=moderate", "detectors=[voting_monitor]", "dispersions.monte_carlo.runs=1"])
    flight = fddbench.signals(campaign, "healthy")
    parameters = fddbench.plan(campaign).parameters([0])
    model = ideal_models(campaign.chosen, parameters, SAMPLE_S)["exact"]
    own = lateral_lpv()
    B = own.matrix("B", own.rho(*(parameters[name] for name in own.names)))[:, :, 0]
    A4 = own.matrix("A", own.rho(*(parameters[name] for name in own.names)))[:, :, 0]
    held = expm(np.block([[A4, np.eye(4)], [np.zeros((4, 8))]]) * SAMPLE_S)[:4, 4:] @ B
    seen = {"beta_deg": 0, "r_deg_s_1": 1, "r_deg_s_2": 2, "r_deg_s_3": 3, "p_deg_s": 4, "phi_deg": 7}
    y = np.stack([flight.signals[name][:, 0] for name in seen], axis=1)
    rows = list(seen.values())
    u = np.stack([flight.signals[f"surface_deg_{i + 1}"][:, 0] for i in range(13)], axis=1)
    A, Q, P, C, R = model.A[0], model.Q[0], model.start[0], model.C[0, rows], model.R[0][np.ix_(rows, rows)]
    x, squares = np.zeros(7), []
    for k in range(min(len(y), 1500)):
        V = C @ P @ C.T + R
        K = np.linalg.solve(V, C @ P).T
        nu = y[k] - C @ x
        squares.append(nu @ np.linalg.solve(V, nu))
        x = A @ (x + K @ nu)
        x[:4] += held @ u[k]
        P = A @ (P - K @ C @ P) @ A.T + Q
    # a chi-squared number with six degrees of freedom at each of so many samples
    assert np.mean(squares) == pytest.approx(6.0, abs=4.0 * np.sqrt(12.0 / len(squares)))


def test_a_unit_that_is_lost_whole_is_seen_in_all_three_signals():
    own = models(sensors=PRESETS["iru"])["exact"]
    alone = detectability(own, Faults(added={"r1": 0.01 * TIME_S}, before=np.array([BEFORE])))[1]
    lost = dict.fromkeys(("r1", "p1", "phi1"), 0.01 * TIME_S)
    assert detectability(own, Faults(added=lost, before=np.array([BEFORE])))[1] > 1.1 * alone
    assert "drawn errors known" in own.about


def test_what_has_no_bound_says_why():
    chosen = {"sensors": PRESETS["ideal"], "wind": LATERAL_WINDS["none"]}
    assert "at once" in ideal_models(chosen, {}, SAMPLE_S)
    bench = load("benchmark", "yaw_rate")()
    other = default_choices(bench) | {"plant": bench.choices["plant"].options["transport_6dof"]}
    assert bench.ideal(other, {}, SAMPLE_S) == "this plant states no ideal model"
