"""The voter that rejects: a plain median until somebody stays apart, then the mean of those left; declared ones are out too."""

from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.layout import Nothing
from fddbench.errors import FddbenchError
from fddbench.testing import check_voter
from fddbench.voting.block import VoterBlock
from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.mean_of_left import mean_of_left
from fddbench.voting.median import Median
from fddbench.voting.monitored import Monitored

N = Nothing()


def voted(block, sensors, declared=None):
    """Voted signal, (n_time,), and who is out at the end, of sensors, (n_time, n_sensors)."""
    x, found = block.states.spread(block.start(N), 1), []
    for k, row in enumerate(np.asarray(sensors, dtype=float)):
        told = None if declared is None else np.asarray(declared[k], dtype=float)[:, np.newaxis]
        x, value = block.step(x, N, N, row[:, np.newaxis], told)
        found.append(float(value[0]))
    return np.array(found), getattr(x, "out", np.zeros((3, 1)))[:, 0].tolist()


def monitored(confirm=3, n=3):
    return VoterBlock(Monitored(threshold=0.5, confirm_samples=confirm, n_sensors=n))


@pytest.mark.parametrize("n_sensors", [3, 5])
def test_voter_keeps_the_contract(n_sensors):
    check_voter("monitored", n_sensors=n_sensors)


@settings(max_examples=30)
@given(st.lists(st.tuples(*[st.floats(-0.25, 0.25)] * 3), min_size=1, max_size=30))
def test_sensors_that_agree_are_voted_as_the_median_bit_for_bit(rows):
    found, out = voted(monitored(), rows)
    assert found.tolist() == [sorted(row)[1] for row in rows]
    assert out == [0.0, 0.0, 0.0]


def test_a_sensor_is_lost_once_it_has_been_apart_for_the_confirmation_time_and_stays_lost():
    apart = np.tile([0.0, 0.2, 0.0], (12, 1))
    apart[2:5, 2] = 9.0  # samples 2 to 4: held for two samples, then back
    assert voted(monitored(), apart)[1] == [0.0, 0.0, 0.0]
    apart[5, 2] = 9.0  # samples 2 to 5: held for three
    found, out = voted(monitored(), apart)
    assert out == [0.0, 0.0, 1.0]
    assert found[:6].tolist() == [0.0, 0.0, 0.2, 0.2, 0.2, 0.2]
    assert found[6:].tolist() == [0.1] * 6  # the mean of two from the next sample on, though it agrees again


def test_of_two_that_are_due_together_the_farthest_goes_and_two_left_accuse_nobody():
    found, out = voted(monitored(confirm=1), np.tile([0.0, 3.0, -5.0], (6, 1)))
    assert out == [0.0, 0.0, 1.0]
    assert found.tolist() == [0.0, 0.0, 1.5, 1.5, 1.5, 1.5]


def test_equal_faults_on_two_sensors_throw_the_healthy_one_out():
    assert voted(monitored(confirm=1), np.tile([2.0, 2.0, 0.0], (4, 1)))[1] == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("kind", [Median, ClosestTwo, Monitored])
def test_declared_sensors_leave_the_vote_while_they_are_declared_unless_all_are(kind):
    block = VoterBlock.on(kind, "r_deg_s", 3, 0.01)
    row = [0.1, 0.3, 0.2]
    told = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [1, 1, 1], [0, 0, 0]]
    plain, _ = voted(block, [row] * 5)
    found, _ = voted(block, [row] * 5, told)
    assert found.tolist() == [plain[0], 0.25, 0.3, plain[3], plain[4]]


@pytest.mark.parametrize("kind", [Median, ClosestTwo, Monitored])
def test_rows_of_zeros_are_none_bit_for_bit(kind):
    block = VoterBlock.on(kind, "r_deg_s", 3, 0.01)
    rows = np.random.default_rng(1).normal(size=(40, 3))
    assert voted(block, rows)[0].tobytes() == voted(block, rows, np.zeros((40, 3)))[0].tobytes()


def test_a_lost_sensor_stays_out_beside_a_declared_one_and_declarations_that_leave_nobody_count_for_nothing():
    rows = np.tile([0.0, 0.2, 9.0], (8, 1))
    told = np.zeros((8, 3))
    told[5] = [1, 0, 0]
    told[6] = [1, 1, 0]
    found, _ = voted(monitored(confirm=1), rows, told)
    assert found[4:].tolist() == [0.1, 0.2, 0.1, 0.1]


def test_its_numbers_follow_the_signal_and_the_clock():
    made = Monitored.for_signal("phi_units_deg", 5, 0.02)
    assert (made.threshold, made.confirm_samples, made.states.size) == (1.0, 5, 10)

    class Mine(Monitored):
        thresholds = MappingProxyType({"r_deg_s": 2.0})
        confirm_s = 0.2

    assert (Mine.for_signal("r_deg_s", 3, 0.01).threshold, Mine().threshold) == (2.0, 2.0)
    assert Mine.for_signal("n_z_g", 3, 0.01).threshold == np.inf
    with pytest.raises(FddbenchError, match=r"voter Monitored: confirm_s = 0.1 falls between two samples of 0.04 s"):
        Monitored.for_signal("r_deg_s", 3, 0.04)


def test_the_mean_of_those_left_of_many():
    sensors, out = np.arange(5.0)[:, np.newaxis], np.array([0.0, 1.0, 0.0, 0.0, 1.0])[:, np.newaxis]
    assert mean_of_left(sensors, out, np.array([7.0]))[0] == pytest.approx(5.0 / 3.0)


def test_a_subclass_in_a_file_beside_a_campaign_is_a_voter(tmp_path):
    text = (
        "from fddbench.voting.monitored import Monitored\n\nclass Mine(Monitored):\n    thresholds = {'r_deg_s': 2.0}\n"
    )
    (tmp_path / "mine.py").write_text(text)
    check_voter("mine.py:Mine", beside=tmp_path)
    assert "vote" in dir(Monitored)  # what a campaign asks of one from a file
