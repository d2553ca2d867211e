"""Voters: bit for bit a median, and what the mean of the closest two must keep."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.median import Median

numbers = st.floats(-1e3, 1e3)
triples = st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=5).map(lambda rows: np.array(rows).T)
voters = pytest.mark.parametrize("voter", [Median(), ClosestTwo()], ids=("median", "closest_two"))


@given(triples)
def test_median_is_the_median_bit_for_bit(sensors):
    sensors = sensors + 0.0  # NumPy sorts -0.0 and 0.0 as it likes
    assert Median().vote(sensors).tobytes() == np.median(sensors, axis=0).tobytes()


@given(triples)
def test_closest_two_is_the_mean_of_a_closest_pair(sensors):
    found = ClosestTwo().vote(sensors)
    for i, (a, b, c) in enumerate(sensors.T):
        pairs = [(abs(p - q), 0.5 * (p + q)) for p, q in ((a, b), (a, c), (b, c))]
        least = min(distance for distance, _ in pairs)
        assert found[i] in [mean for distance, mean in pairs if distance == least]


@voters
@given(triples)
def test_between_the_least_and_the_largest(voter, sensors):
    found = voter.vote(sensors)
    assert (sensors.min(axis=0) <= found).all()
    assert (found <= sensors.max(axis=0)).all()


@voters
@given(triples)
def test_the_order_of_the_sensors_does_not_matter_but_for_ties(voter, sensors):
    gaps = np.sort(np.abs(sensors[[0, 0, 1]] - sensors[[1, 2, 2]]), axis=0)
    clear = gaps[1] > gaps[0]  # one pair is strictly the closest
    found = voter.vote(sensors)
    for order in permutations(range(3)):
        again = voter.vote(sensors[list(order)])
        assert np.array_equal(found[clear], again[clear])


@voters
@given(st.tuples(numbers, numbers, numbers), st.integers(-8, 8))
def test_shifts_and_mirrors_with_the_sensors(voter, values, shift):
    sensors = np.round(np.array(values))[:, np.newaxis]  # integers: every sum is exact
    assert voter.vote(sensors + shift) == voter.vote(sensors) + shift
    assert voter.vote(-sensors) == -voter.vote(sensors)


@voters
@given(numbers, st.floats(-1e6, 1e6), st.integers(0, 2))
def test_one_arbitrary_sensor_is_out_voted_by_two_equal_ones(voter, good, bad, site):
    sensors = np.full((3, 1), good)
    sensors[site] = bad
    assert voter.vote(sensors)[0] == good


@voters
@given(triples)
def test_bits_do_not_depend_on_the_company(voter, sensors):
    alone = np.concatenate([voter.vote(sensors[:, [i]]) for i in range(sensors.shape[1])])
    assert voter.vote(sensors).tobytes() == alone.tobytes()
