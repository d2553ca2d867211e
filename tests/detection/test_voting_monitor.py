"""The voting monitor: counts samples exactly, and believes the vote."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError

from fddbench.detection.voting_monitor import VotingMonitor
from fddbench.errors import DesignError
from fddbench.interfaces import Bus
from fddbench.voting.median import Median

BUS = Bus(sample_s=0.01, sites=("r1", "r2", "r3"), signals={"r_deg_s": 3, "r_voted_deg_s": 0})


def monitor(confirm_one_s=0.1, bus=BUS):
    return VotingMonitor.from_design(VotingMonitor.Gains(flag_threshold_deg_s=0.3, confirm_one_s=confirm_one_s), bus)


def declared_of(r, detector):
    """Declared sites, (n_time, 3, n_cases), for sensors (n_time, 3, n_cases)."""
    state, found = detector.start(r.shape[2]), []
    for sample in r:
        state, verdict = detector.step(state, SimpleNamespace(r_deg_s=sample, r_voted_deg_s=Median().vote(sample)))
        found.append(verdict.declared)
    return np.array(found)


def sensors(first=200, n=400, sites=(1,), last=None):
    r = np.zeros((n, 3, 1))
    r[first:last, list(sites)] = 0.5
    return r


def test_a_flag_raised_at_200_with_a_tenth_of_a_second_declares_at_210():
    n = declared_of(sensors(), monitor()).sum(axis=1)[:, 0]
    assert np.flatnonzero(n)[0] == 210
    assert (n[210:] == 1.0).all()


@pytest.mark.parametrize(("last", "declares"), [(210, False), (211, True)])
def test_the_flag_must_stand_the_whole_time(last, declares):
    assert declared_of(sensors(last=last), monitor()).any() == declares


def test_an_interrupted_flag_starts_again():
    r = sensors()
    r[205] = 0.0
    assert np.flatnonzero(declared_of(r, monitor()).sum(axis=1))[0] == 216


def test_declares_for_good_the_sensor_that_was_out_when_the_time_expired():
    r = sensors(last=260)
    r[260:, 0] = -9.0
    declared = declared_of(r, monitor())
    assert declared[-1, :, 0].tolist() == [0.0, 1.0, 0.0]


def test_two_sensors_that_fail_alike_win_the_vote_and_the_healthy_one_is_declared():
    declared = declared_of(sensors(sites=(0, 2)), monitor())
    assert declared[-1, :, 0].tolist() == [0.0, 1.0, 0.0]


def test_the_threshold_itself_raises_no_flag():
    r = np.zeros((50, 3, 1))
    r[:, 0] = 0.3
    assert not declared_of(r, monitor()).any()


@pytest.mark.parametrize("sample_s", [0.005, 0.02, 0.05])
def test_the_confirmation_is_a_time_and_not_a_number(sample_s):
    bus = Bus(sample_s=sample_s, sites=BUS.sites, signals=BUS.signals)
    n = declared_of(sensors(), monitor(0.1, bus)).sum(axis=1)
    assert np.flatnonzero(n)[0] == 200 + round(0.1 / sample_s)


def test_ratio_is_deviation_over_threshold():
    detector = monitor()
    r = np.array([[0.0], [0.9], [-0.1]])
    _, verdict = detector.step(detector.start(1), SimpleNamespace(r_deg_s=r, r_voted_deg_s=np.zeros(1)))
    assert verdict.ratio[0] == pytest.approx(3.0)
    assert set(verdict.signals) == set(detector.recorded)


def test_bits_do_not_depend_on_the_company():
    r = np.random.default_rng(0).normal(scale=0.3, size=(300, 3, 6))
    together = declared_of(r, monitor(0.02))
    assert together.any()
    for i in range(6):
        assert np.array_equal(declared_of(r[:, :, [i]], monitor(0.02)), together[:, :, [i]])


def test_what_it_needs_and_refuses():
    with pytest.raises(DesignError, match="needs the signals .'r_voted_deg_s'."):
        monitor(bus=Bus(sample_s=0.01, sites=("a",), signals={"r_deg_s": 3}))
    with pytest.raises(ValidationError, match="greater than 0"):
        VotingMonitor.Gains(flag_threshold_deg_s=0.0, confirm_one_s=1.0)
