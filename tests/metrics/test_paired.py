"""Pairs: against the textbook test and brute force, under hypothesis what must not matter, and coverage by simulation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binomtest

from fddbench.metrics.paired import holm, paired_shares, paired_times


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=40))
def test_with_one_flight_a_run_it_is_mcnemar(pairs):
    a, b = np.array(pairs).T
    found = paired_shares(a, b, range(len(a)))
    only_a, only_b = int(np.sum(a & ~b)), int(np.sum(b & ~a))
    assert (found.only_a, found.only_b) == (only_a, only_b)
    assert found.difference == pytest.approx(b.mean() - a.mean())
    exact = binomtest(only_b, only_a + only_b).pvalue if only_a + only_b else 1.0
    assert found.p_value == pytest.approx(exact, rel=1e-12)  # summed in another order


@given(st.lists(st.tuples(st.booleans(), st.booleans(), st.integers(0, 5)), min_size=1, max_size=30), st.randoms())
def test_order_and_sides_do_not_matter(flights, random):
    a, b, run = (np.array(column) for column in zip(*flights, strict=True))
    found, turned = paired_shares(a, b, run), paired_shares(b, a, run)
    assert turned.difference == -found.difference
    assert turned.p_value == found.p_value
    order = list(range(len(run)))
    random.shuffle(order)
    assert paired_shares(a[order], b[order], run[order]) == found
    if found.low is not None:
        assert found.low <= found.high
        assert (turned.low, turned.high) == pytest.approx((-found.high, -found.low))


def test_flights_of_one_run_count_as_one_look():
    # nine flights of each aircraft fail together: nine times the rows are no more evidence
    a, b, run = np.array([0, 0, 0, 0, 1]), np.array([1, 1, 1, 1, 1]), np.arange(5)
    once, often = paired_shares(a, b, run), paired_shares(np.tile(a, 9), np.tile(b, 9), np.tile(run, 9))
    assert often.p_value == once.p_value == 0.125
    assert (often.low, often.high) == pytest.approx((once.low, once.high))


def test_the_interval_holds_the_truth():
    rng, inside = np.random.default_rng(1), 0
    for _ in range(400):
        run = np.repeat(np.arange(40), 3)
        aircraft = rng.random(40)[run] < 0.3  # what goes wrong with an aircraft goes wrong in all its flights
        a, b = aircraft | (rng.random(120) < 0.1), aircraft & (rng.random(120) < 0.8)
        truth = 0.3 * 0.8 - (1 - 0.7 * 0.9)
        found = paired_shares(a, b, run)
        inside += found.low <= truth <= found.high
    assert inside >= 0.925 * 400


def test_times_pair_where_both_are_known_and_the_median_has_exact_ends():
    a_s, b_s = np.arange(20.0), np.arange(20.0) + 0.1
    b_s[3] = np.nan
    found = paired_times(a_s, b_s, range(20))
    assert (found.pairs, found.median_s, found.low_s, found.high_s) == (19, *[pytest.approx(0.1)] * 3)
    assert found.p_value == pytest.approx(2 * 0.5**19)
    few = paired_times([1.0, 2.0], [2.0, 3.0], [0, 1])
    assert (few.median_s, few.low_s, few.high_s) == (1.0, None, None)
    nothing = paired_times([np.nan], [1.0], [0])
    assert (nothing.pairs, nothing.median_s, nothing.p_value) == (0, None, None)
    rng, inside = np.random.default_rng(2), 0
    for _ in range(300):
        found = paired_times(np.zeros(25), rng.exponential(size=25), range(25))
        inside += found.low_s <= np.log(2.0) <= found.high_s
    assert inside >= 0.925 * 300


def test_nothing_to_compare_is_null_not_nan():
    found = paired_shares([], [], [])
    assert (found.pairs, found.difference, found.low, found.p_value) == (0, None, None, None)
    one = paired_shares([1], [0], [0])
    assert (one.difference, one.low, one.high) == (-1.0, None, None)


@given(st.lists(st.floats(0.0, 1.0), max_size=12))
def test_holm_is_never_smaller_and_keeps_the_order(p):
    adjusted = holm(p)
    assert all(adjusted >= np.array(p) - 1e-15)
    order = np.argsort(p, kind="stable")
    assert (np.diff(adjusted[order]) >= 0.0).all()
    if p:
        assert adjusted.min() == pytest.approx(min(1.0, len(p) * min(p)))


def test_holm_leaves_what_was_not_tested():
    assert np.array_equal(holm([np.nan, 0.02]), [np.nan, 0.02], equal_nan=True)
