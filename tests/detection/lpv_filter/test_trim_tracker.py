"""What takes slow offsets out, and what it lets pass."""

import numpy as np
import pytest

from fddbench.blocks.layout import Layout
from fddbench.detection.lpv_filter.gains import TrimEntry
from fddbench.detection.lpv_filter.trim_tracker import TrimTracker

SAMPLE_S = 0.1


def left_over(estimate, *, freeze=0.5, time_constant_s=10.0, learn_s=0.0):
    entry = TrimEntry(time_constant_s=time_constant_s, freeze_above=(freeze,), learn_s=learn_s)
    tracker = TrimTracker(entry, SAMPLE_S)
    state, shown = Layout(tracker.shape).spread(tracker.start(), 1), []
    for value in estimate:
        state, left = tracker.step(state, np.array([[value]]))
        shown.append(left[0, 0])
    return np.array(shown)


def test_an_offset_that_grows_slowly_is_taken_out_to_its_rate_times_the_time_constant():
    left = left_over(0.01 * SAMPLE_S * np.arange(3000))  # 0.01 a second, up to 3
    assert left[-1] == pytest.approx(0.01 * 10.0, rel=0.02)


def test_a_fault_larger_than_the_distance_stays_however_long_it_lasts():
    left = left_over(np.where(np.arange(5000) < 500, 0.0, 1.0))
    assert np.all(left[500:] == 1.0)


def test_one_that_is_smaller_is_forgotten():
    left = left_over(np.where(np.arange(5000) < 500, 0.0, 0.4))
    assert left[500] == 0.4
    assert abs(left[-1]) < 1e-6


def test_the_first_seconds_are_learnt_and_say_nothing():
    left = left_over(np.full(300, 7.0), learn_s=5.0)
    assert np.all(left[:50] == 0.0)
    np.testing.assert_allclose(left[50:], 0.0, atol=1e-12)
    assert left_over(np.full(300, 7.0))[-1] == 7.0  # without, it is taken for a fault
