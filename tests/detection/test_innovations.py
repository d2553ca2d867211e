"""Monitors of innovations and their like without a model: laws that hold for all, and what is special to each."""

import numpy as np
import pytest
from tests.detection.rig import NO, bus, declared, flown, measured, noisy, shipped

from fddbench.errors import DesignError

WITH_MODEL = ("kalman_monitor_yaw_rate", "cusum_yaw_rate", "glr_yaw_rate")
ALL = (*WITH_MODEL, "coast", "fixed_threshold")
RAMP = 0.01 * np.arange(60)


@pytest.mark.parametrize("design", ALL)
@pytest.mark.parametrize(
    "faults",
    [{}, {1: 0.5}, {2: -0.5}, {0: 2.0, 2: 2.0}, {1: 1.0, 2: -1.5}, {0: 100.0 * (-1.0) ** (np.arange(60) // 5)}],
    ids=["none", "one", "another", "pair", "opposite", "nrz"],
)
def test_who_jumps_is_declared_and_nobody_else(design, faults):
    assert declared(shipped(design), noisy(faults)) == set(faults)


@pytest.mark.parametrize("design", WITH_MODEL)
@pytest.mark.parametrize("faults", [{0: RAMP}, {1: RAMP, 2: RAMP}], ids=["one", "pair"])
def test_a_model_tells_a_slow_pair_from_a_slow_sensor(design, faults):
    assert declared(shipped(design), noisy(faults)) == set(faults)


def test_without_rates_or_a_model_a_slow_pair_wins_the_vote():
    assert declared(shipped("fixed_threshold"), noisy({1: RAMP, 2: RAMP})) == {0}


def test_the_last_agreement_is_left_behind_by_a_turn():
    """The sensor that stands still as the turn starts is nearest to what all read when they last agreed."""
    r = noisy({}, n=100, first=40, moving=0.02)
    r[40:, 0] = r[39, 0]
    assert declared(shipped("coast"), r) == {1, 2}


@pytest.mark.parametrize("design", ALL)
def test_four_sensors_are_watched_as_well_and_its_bits_do_not_depend_on_the_company(design):
    detector = shipped(design, bus(4))
    assert detector.watches == ("r1", "r2", "r3", "r4")
    r = np.concatenate([noisy({3: 2.0}, n_sensors=4), noisy({}, n_sensors=4, seed=1)], axis=2)
    together = [v.residual for v in flown(detector, r)]
    for case in (0, 1):
        alone = [v.residual[0] for v in flown(detector, r[:, :, case : case + 1])]
        assert alone == [row[case] for row in together]
    assert declared(detector, r[:, :, :1]) == {3}


@pytest.mark.parametrize("design", WITH_MODEL)
def test_what_they_need(design):
    with pytest.raises(DesignError, match="needs the signals .'beta_deg'"):
        shipped(design, bus(without=("beta_deg",)))


def test_cusum_takes_threshold_over_shift_less_drift_and_half_that_for_twice_the_threshold():
    detector = shipped("cusum_yaw_rate", drift_sigma=1.0, sum_threshold_sigma=40.0)
    x = detector.states.spread(detector.start(NO), 1)
    for _ in range(300):
        x, _ = detector.step(x, NO, NO, measured(np.zeros((3, 1))))
    S = detector.watch.innovations(x.watch, np.zeros((3, 1)))[1][0]
    r = np.array([[0.0], [0.0], [-5.0 * np.sqrt(S)]])
    sums = []
    for _ in range(12):
        x, verdict = detector.step(x, NO, NO, measured(r))
        sums.append(verdict.signals["sum_sigma"][0])
    np.testing.assert_allclose(sums, 4.0 * np.arange(1, 13), rtol=0.05)  # S grows a little while it coasts


def _best(e, w, R, P, explained):
    """Reduction of the misfit of sizes a by the best sizes on the columns of `explained`, by the textbook."""
    a = w @ e / (w @ w)
    weight = np.linalg.inv(R / (w @ w) * np.eye(3) + P * (w.sum() / (w @ w)) ** 2 * np.ones((3, 3)))
    G = np.array(explained, dtype=float).T
    spoken = G.T @ weight @ a
    return spoken @ np.linalg.solve(G.T @ weight @ G, spoken)


def test_glr_is_the_ratio_of_the_best_fits_with_and_without_each_sensor():
    detector = shipped("glr_yaw_rate", windows_samples=[3, 7])
    x, rng = detector.states.spread(detector.start(NO), 1), np.random.default_rng(5)
    past = []
    for _ in range(30):
        r = rng.normal(scale=0.1, size=(3, 1))
        e, S = detector.watch.innovations(x.watch, r)
        past.append(e[:, 0])
        x, verdict = detector.step(x, NO, NO, measured(r))
    R, E = detector.watch.filter.noise, np.eye(3)
    tries = [(np.array(past[-L:]), w) for L in (3, 7) for w in (np.ones(L), np.arange(1.0, L + 1.0))]
    found = {}
    for sites in ((0,), (1,), (2,), (0, 1), (0, 2), (1, 2)):
        alike = max(_best(e, w, R, S[0] - R, [sum(E[i] for i in sites)]) for e, w in tries)
        free = max(_best(e, w, R, S[0] - R, [E[i] for i in sites]) for e, w in tries)
        found[sites] = max(alike, free - detector.gains.ratio_threshold) if len(sites) == 2 else alike
    against = [
        max(v for g, v in found.items() if i in g) - max(v for g, v in found.items() if i not in g) for i in range(3)
    ]
    assert verdict.signals["likelihood_ratio"][0] == pytest.approx(max(against), rel=1e-6)


def test_glr_refuses_windows_out_of_order_and_two_sensors():
    with pytest.raises(DesignError, match="windows_samples"):
        shipped("glr_yaw_rate", windows_samples=[5, 5])
    with pytest.raises(DesignError, match="needs 3 or more redundant sensors"):
        shipped("glr_yaw_rate", bus(2))
