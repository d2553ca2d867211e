"""Outlier, confirmation, choice and latch: the laws of the decision logic."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.consolidation import deviations_deg_s, largest_deviation_deg_s, outlier
from fddbench.detection.isolation import choose, latch
from fddbench.errors import DesignError

distances = st.lists(st.sampled_from((0.0, 0.1, 0.2, 0.5, 7.0)), min_size=3, max_size=3)
energies = st.lists(st.sampled_from((0.0, 0.5, 1.0, 3.0, 900.0, 1e4, 1e6)), min_size=3, max_size=3)
trips = st.lists(st.sampled_from((0.0, 1.0)), min_size=3, max_size=3)
sites = st.integers(0, 2)


def rows(values):
    return np.array(values, dtype=float)[:, np.newaxis]


@given(distances)
def test_outlier_is_the_first_of_the_farthest(values):
    expected = np.zeros(3)
    expected[int(np.argmax(values))] = 1.0
    assert np.array_equal(outlier(rows(values))[:, 0], expected)


@given(st.lists(st.floats(-100, 100), min_size=3, max_size=3), st.floats(-100, 100))
def test_deviations_are_distances(sensors, voted):
    found = deviations_deg_s(rows(sensors), np.array([voted]))
    assert np.array_equal(found[:, 0], np.abs(np.array(sensors) - voted))
    assert largest_deviation_deg_s(found)[0] == found.max()


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_held_samples_counts_the_last_unbroken_run(flags):
    count = np.zeros(1)
    for k, flag in enumerate(flags):
        count = held_samples(count, np.array([flag]))
        run = next((i for i, f in enumerate(reversed(flags[: k + 1])) if not f), k + 1)
        assert count[0] == run


@given(st.integers(1, 500), st.sampled_from((0.001, 0.005, 0.01, 0.02, 0.04)))
def test_whole_confirmation_times_are_exact_sample_numbers(n, sample_s):
    assert samples("confirm_s", n * sample_s, sample_s) == n


@pytest.mark.parametrize(
    ("time_s", "sample_s", "near"),
    [(0.1, 0.04, "0.08 and 0.12"), (0.025, 0.01, "0.02 and 0.03"), (0.004, 0.01, "0 and 0.01")],
)
def test_a_time_between_samples_is_a_design_for_another_clock(time_s, sample_s, near):
    with pytest.raises(
        DesignError, match=f"confirm_s = {time_s} falls .* the nearest are {near}.*made for another clock"
    ):
        samples("confirm_s", time_s, sample_s)


def test_a_window_lasts_at_least_a_sample():
    with pytest.raises(DesignError, match="window_s = 0.004 is shorter than a sample of 0.01 s; the shortest is 0.01"):
        samples("window_s", 0.004, 0.01, least=1)


def one_hot(site):
    out = np.zeros((3, 1))
    out[site] = 1.0
    return out


@given(sites, st.integers(0, 2), trips, energies)
def test_as_many_sites_as_faulty_sensors_whatever_the_energy_monitor_says(far, n, tripped, energy):
    chosen = choose(one_hot(far), np.array([float(n)]), rows(tripped), rows(energy))
    assert set(np.unique(chosen)) <= {0.0, 1.0}
    assert chosen.sum() == n


@given(sites, energies)
def test_without_a_trip_one_is_the_outlier_and_two_are_the_others(far, energy):
    none = np.zeros((3, 1))
    assert np.array_equal(choose(one_hot(far), np.ones(1), none, rows(energy)), one_hot(far))
    assert np.array_equal(choose(one_hot(far), np.full(1, 2.0), none, rows(energy)), 1.0 - one_hot(far))
    assert not choose(one_hot(far), np.zeros(1), none, rows(energy)).any()


@given(sites, st.integers(1, 2), trips, energies)
def test_tripped_sensors_come_first_and_the_larger_energy_before_the_smaller(far, n, tripped, energy):
    chosen = choose(one_hot(far), np.array([float(n)]), rows(tripped), rows(energy))[:, 0] > 0.0
    hot = np.array(tripped) > 0.0
    if (chosen & ~hot).any():
        assert not (hot & ~chosen).any()
    for i in np.flatnonzero(hot & chosen):
        for j in np.flatnonzero(hot & ~chosen):
            assert energy[i] >= energy[j]


@given(sites, st.integers(1, 2), trips)
def test_what_the_trips_leave_open_the_vote_decides(far, n, tripped):
    chosen = choose(one_hot(far), np.array([float(n)]), rows(tripped), np.ones((3, 1)))[:, 0] > 0.0
    hot = np.array(tripped) > 0.0
    if hot.sum() < n:
        preferred = np.arange(3) == far if n == 1 else np.arange(3) != far
        rest = chosen & ~hot
        if (preferred & ~hot).any():
            assert (rest & preferred).any()


def test_energies_choose_among_tripped_sensors_the_outlier_has_no_bonus():
    chosen = choose(one_hot(0), np.ones(1), np.ones((3, 1)), rows([1e6, 1.001e6, 2.0]))
    assert chosen[:, 0].tolist() == [0.0, 1.0, 0.0]


@given(st.lists(st.tuples(st.integers(0, 2), sites), min_size=1, max_size=20))
def test_latched_sites_change_only_when_the_number_rises(history):
    declared, n = np.zeros((3, 1)), np.zeros(1)
    expected = np.zeros(3)
    for number, far in history:
        now = np.maximum(n, float(number))
        chosen = choose(one_hot(far), now, np.zeros((3, 1)), np.zeros((3, 1)))
        if now[0] > n[0]:
            expected = chosen[:, 0]
        declared = latch(declared, chosen, n_before=n, n_now=now)
        n = now
        assert np.array_equal(declared[:, 0], expected)
        assert declared.sum() == n[0]
