"""Shared decisions: who is accused does not depend on the order of sensors, on which way they fail, or on the company."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.layout import Nothing
from fddbench.detection.decision import Confirmation, Miscompare, live_mean, live_sensors, spread
from fddbench.errors import DesignError

NO = Nothing()
SIZE = st.floats(0.5, 50.0) | st.floats(-50.0, -0.5)


def suspected(faults, *, predicted=0.0, n=40, declared=None):
    """Suspected sensors after n samples of constant faults (n_sensors,), statistic the distance from the prediction."""
    y = np.array(faults, dtype=float)[:, np.newaxis]
    block = Miscompare(0.1, mean_s=0.05, sample_s=0.01, n_sensors=len(y))
    out = np.zeros_like(y) if declared is None else np.array(declared, dtype=float)[:, np.newaxis]
    x = block.states.spread(block.start(NO), 1)
    for _ in range(n):
        x, found = block.step(x, NO, NO, y, np.abs(y - predicted), out)
    return found.suspected[:, 0].tolist(), bool(found.differ[0])


@settings(max_examples=30, deadline=None)
@given(SIZE, SIZE, st.permutations(range(3)))
def test_one_and_two_sensors_that_fail_in_any_way_are_accused_and_the_healthy_one_never(a, b, order):
    for faults in ([a, 0.0, 0.0], [a, a, 0.0]):
        placed = [faults[i] for i in order]
        assert suspected(placed) == ([value != 0.0 for value in placed], True)
    both = [[a, b, 0.0][i] for i in order]
    wrong, _ = suspected(both)
    assert not wrong[both.index(0.0)]
    assert all(wrong[i] for i in range(3) if both[i] != 0.0)


def test_a_prediction_off_by_more_than_half_of_the_fault_accuses_the_healthy_sensor():
    assert suspected([1.0, 0.0, 0.0], predicted=0.49)[0] == [True, False, False]
    assert suspected([1.0, 0.0, 0.0], predicted=0.51)[0] == [False, True, True]


def test_declared_sensors_are_compared_with_nobody():
    assert suspected([9.0, 0.0, 0.0], declared=[1, 0, 0]) == ([False] * 3, False)
    assert suspected([9.0, 2.0, 0.0], declared=[1, 0, 0]) == ([False, True, False], True)


def test_noise_that_crosses_zero_differs_as_steadily_as_a_jump_and_is_soon_forgotten():
    rng = np.random.default_rng(0)
    block = Miscompare(0.1, mean_s=0.05, sample_s=0.01, n_sensors=3)
    x, found = block.states.spread(block.start(NO), 1), []
    for k in range(200):
        y = np.zeros((3, 1))
        y[0] = rng.normal(scale=128.0) if k < 100 else 0.0
        x, compared = block.step(x, NO, NO, y, np.abs(y) + 0.0 * y, np.zeros((3, 1)))
        found.append(bool(compared.differ[0]))
    assert all(found[:100])
    assert not any(found[130:])


def test_four_and_two_sensors_are_compared_as_well():
    assert suspected([1.0, 0.0, 0.0, 2.0])[0] == [True, False, False, True]
    assert suspected([0.0, -1.0])[0] == [False, True]


def test_what_is_left_does_not_depend_on_what_is_declared_or_on_the_order():
    for order in permutations(range(4)):
        y = np.array([[1.0], [2.0], [4.0], [1e6]])[list(order)]
        out = np.array([[0.0], [0.0], [0.0], [1.0]])[list(order)]
        assert (live_mean(y, out)[0], live_sensors(out)[0], spread(y, out)[0]) == pytest.approx((7.0 / 3.0, 3.0, 3.0))
    assert live_mean(y, np.ones((4, 1)))[0] == 0.0
    assert spread(y, np.ones((4, 1)))[0] == 0.0


def test_a_suspicion_counts_when_it_has_stood_for_the_whole_time_and_then_for_good():
    block, found = Confirmation(0.1, sample_s=0.01, n_sites=1), []
    x = block.states.spread(block.start(NO), 1)
    for k in range(60):
        x, declared = block.step(x, NO, NO, np.array([[5 <= k < 15 or 20 <= k < 31]]))
        found.append(declared[0, 0])
    assert np.flatnonzero(found).tolist() == list(range(30, 60))
    with pytest.raises(DesignError, match="confirm_s"):
        Confirmation(0.015, sample_s=0.01, n_sites=1)
