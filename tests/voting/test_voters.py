"""Voters of two to seven sensors: bit for bit a median, and what the mean of the closest two must keep."""

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.blocks.layout import ROW, Layout, Nothing, record
from fddbench.voting.block import VoterBlock
from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.median import Median

numbers = st.floats(-1e3, 1e3)
triples = st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=5).map(lambda rows: np.array(rows).T)
anyhow_many = st.integers(2, 7).flatmap(
    lambda n: st.lists(st.tuples(*[numbers] * n), min_size=1, max_size=5).map(lambda rows: np.array(rows).T)
)
voters = pytest.mark.parametrize("voter", [Median(), ClosestTwo()], ids=("median", "closest_two"))


@given(anyhow_many)
def test_median_is_the_median_bit_for_bit(sensors):
    sensors = sensors + 0.0  # NumPy sorts -0.0 and 0.0 as it likes
    assert Median().vote(sensors).tobytes() == np.median(sensors, axis=0).tobytes()


@given(anyhow_many, st.randoms(use_true_random=False))
def test_the_median_does_not_ask_for_the_order_of_the_sensors(sensors, random):
    sensors = sensors + 0.0
    order = random.sample(range(len(sensors)), len(sensors))
    assert Median().vote(sensors[order]).tobytes() == Median().vote(sensors).tobytes()


@given(triples)
def test_closest_two_of_three_is_the_formula_of_three(sensors):
    """Of equally close pairs the first in the order 12, 13, 23; bit for bit."""
    a, b, c = sensors
    ab, ac, bc = np.abs(a - b), np.abs(a - c), np.abs(b - c)
    last_two = np.where(ac <= bc, 0.5 * (a + c), 0.5 * (b + c))
    expected = np.where((ab <= ac) & (ab <= bc), 0.5 * (a + b), last_two)
    assert ClosestTwo().vote(sensors).tobytes() == expected.tobytes()


@pytest.mark.parametrize(
    ("sensors", "voted"),
    [((0, 1, 2), 0.5), ((1, 0, 2), 0.5), ((0, 9, 1, 8), 0.5), ((0, 2, 1, 3), 0.5), ((7, 3), 5.0), ((1, 4, 8, 8), 8.0)],
)
def test_of_equally_close_pairs_the_first(sensors, voted):
    assert ClosestTwo().vote(np.array(sensors, dtype=float)[:, np.newaxis]).tolist() == [voted]


@given(anyhow_many)
def test_closest_two_is_the_mean_of_a_closest_pair(sensors):
    found = ClosestTwo().vote(sensors)
    for i, values in enumerate(sensors.T):
        pairs = [(abs(p - q), 0.5 * (p + q)) for p, q in combinations(values, 2)]
        least = min(distance for distance, _ in pairs)
        assert found[i] in [mean for distance, mean in pairs if distance == least]


@voters
@given(anyhow_many)
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
@given(st.lists(numbers, min_size=2, max_size=7), st.integers(-8, 8))
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
@given(anyhow_many)
def test_bits_do_not_depend_on_the_company(voter, sensors):
    alone = np.concatenate([voter.vote(sensors[:, [i]]) for i in range(sensors.shape[1])])
    assert voter.vote(sensors).tobytes() == alone.tobytes()


@given(st.integers(3, 7), numbers, st.data())
def test_fewer_than_half_arbitrary_sensors_are_out_voted_by_the_median(n, good, data):
    sensors = np.full((n, 1), good)
    bad = data.draw(st.permutations(range(n)))[: (n - 1) // 2]
    sensors[bad, 0] = [data.draw(st.floats(-1e6, 1e6)) for _ in bad]
    assert Median().vote(sensors)[0] == good


@voters
def test_a_voter_without_memory_is_a_block_without_states(voter):
    block, sensors = VoterBlock(voter), np.array([[1.0], [9.0], [2.0]])
    assert (block.states.size, block.constants.size, block.draws.size) == (0, 0, 0)
    after, voted = block.step(block.start(Nothing()), Nothing(), Nothing(), sensors)
    assert after == Nothing()
    assert np.array_equal(voted, voter.vote(sensors))


@record
class Last:
    voted: object


class Lazy:
    """A voter with a memory: the mean of what it voted before and of the mean now."""

    states = Layout(Last(voted=ROW))

    def start(self):
        return Last(voted=0.0)

    def step(self, x, sensors):
        voted = 0.5 * (x.voted + sensors.mean(axis=0))
        return Last(voted=voted), voted


def test_a_voter_may_keep_something():
    block = VoterBlock(Lazy())
    x, found = block.states.spread(block.start(Nothing()), 1), []
    for _ in range(3):
        x, voted = block.step(x, Nothing(), Nothing(), np.full((3, 1), 8.0))
        found.append(voted[0])
    assert found == [4.0, 6.0, 7.0]
