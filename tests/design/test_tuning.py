"""Law: the chosen thresholds keep the rate on the flights they were chosen on, and smaller ones do not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.design.tuning import held_peaks, tuned
from fddbench.errors import CampaignError, DesignError, Mistake


@given(st.integers(1, 200), st.integers(1, 4), st.floats(0.0, 0.99), st.integers(0, 10**6))
@settings(deadline=None, max_examples=60)
def test_keeps_the_rate_and_leaves_little_of_it(n, residuals, rate, seed):
    peaks = np.random.default_rng(seed).gamma(2.0, size=(n, residuals))
    found = tuned(peaks, rate)
    alarms = int(np.any(peaks > np.array(found.thresholds), axis=1).sum())
    assert alarms == found.alarms <= rate * n + 1e-9
    assert found.alarms > np.floor(rate * n) - residuals or found.alarms == n - 1
    assert all(threshold in peaks[:, i] for i, threshold in enumerate(found.thresholds))


@given(st.integers(0, 12), st.integers(0, 10**6))
@settings(deadline=None, max_examples=60)
def test_a_held_peak_is_the_level_at_which_the_alarm_begins(confirm, seed):
    signal = np.random.default_rng(seed).standard_normal((60, 3))
    peaks = held_peaks(signal, confirm)
    for level, alarms in ((peaks * (1.0 + 1e-12), False), (peaks * (1.0 - 1e-12), True)):
        held, declared = np.zeros(3), np.zeros(3, dtype=bool)
        for sample in np.abs(signal):
            held = np.where(sample > level, held + 1.0, 0.0)
            declared |= held - 1.0 >= confirm
        assert (declared == alarms).all()


def test_a_flight_shorter_than_the_confirmation_cannot_alarm():
    assert held_peaks(np.ones((3, 2)), 3).tolist() == [0.0, 0.0]


def test_flights_that_have_ended_do_not_count():
    signal = np.array([[1.0], [2.0], [np.nan], [np.nan]])
    assert held_peaks(signal, 0).tolist() == [2.0]


def test_residuals_that_stay_at_zero_are_refused():
    with pytest.raises(DesignError, match="stays at zero"):
        tuned(np.zeros((5, 2)), 0.0)


def test_a_design_of_another_aircraft_is_refused_without_a_place_in_no_file():
    said = str(CampaignError((Mistake("", "design 'x' needs other signals"),)))
    assert said == "design 'x' needs other signals"
