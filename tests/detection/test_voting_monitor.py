"""The voting monitor: counts samples exactly, and believes the vote."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError

from fddbench.blocks.layout import Nothing
from fddbench.detection.voting_monitor import VotingMonitor
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site
from fddbench.voting.median import Median


def sites(n):
    return tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(n))


BUS = Bus(sample_s=0.01, sites=sites(3), signals={"r_deg_s": 3, "r_voted_deg_s": 0})


def monitor(confirm_one_s=0.1, bus=BUS):
    return VotingMonitor.from_design(VotingMonitor.Gains(flag_threshold_deg_s=0.3, confirm_one_s=confirm_one_s), bus)


def declared_of(r, detector):
    """Declared sites, (n_time, 3, n_cases), for sensors (n_time, 3, n_cases)."""
    state, found = detector.states.spread(detector.start(Nothing()), r.shape[2]), []
    for sample in r:
        measured = SimpleNamespace(r_deg_s=sample, r_voted_deg_s=Median().vote(sample))
        state, verdict = detector.step(state, Nothing(), Nothing(), measured)
        found.append(verdict.declared)
    return np.array(found)


def sensors(first=200, n=400, sites=(1,), last=None, n_sensors=3):
    r = np.zeros((n, n_sensors, 1))
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


def test_residual_is_deviation_over_threshold():
    detector = monitor()
    r = np.array([[0.0], [0.9], [-0.1]])
    state = detector.states.spread(detector.start(Nothing()), 1)
    measured = SimpleNamespace(r_deg_s=r, r_voted_deg_s=np.zeros(1))
    _, verdict = detector.step(state, Nothing(), Nothing(), measured)
    assert verdict.residual[0] == pytest.approx(3.0)
    assert set(verdict.signals) == set(detector.recorded)


@pytest.mark.parametrize("n", [2, 4, 5, 7])
def test_it_watches_as_many_sensors_as_there_are(n):
    bus = Bus(sample_s=0.01, sites=sites(n), signals={"r_deg_s": n, "r_voted_deg_s": 0})
    detector = monitor(bus=bus)
    assert detector.watches == tuple(f"r{i + 1}" for i in range(n))
    r = sensors(sites=(n - 1,), n_sensors=n)
    r[:, n - 1] *= 2.0
    declared = declared_of(r, detector)
    first = np.flatnonzero(declared.sum(axis=1)[:, 0])[0]
    assert first == 210
    # of two sensors nobody can say which; of more the one that is off
    assert declared[-1, :, 0].tolist() == ([1.0, 0.0] if n == 2 else [0.0] * (n - 1) + [1.0])


def test_bits_do_not_depend_on_the_company():
    r = np.random.default_rng(0).normal(scale=0.3, size=(300, 3, 6))
    together = declared_of(r, monitor(0.02))
    assert together.any()
    for i in range(6):
        assert np.array_equal(declared_of(r[:, :, [i]], monitor(0.02)), together[:, :, [i]])


def test_what_it_needs_and_refuses():
    with pytest.raises(DesignError, match="needs the signals .'r_voted_deg_s'."):
        monitor(bus=Bus(sample_s=0.01, sites=sites(1), signals={"r_deg_s": 3}))
    with pytest.raises(DesignError, match="needs 2 or more redundant sensors on r_deg_s"):
        monitor(bus=Bus(sample_s=0.01, sites=sites(1), signals=BUS.signals))
    with pytest.raises(ValidationError, match="greater than 0"):
        VotingMonitor.Gains(flag_threshold_deg_s=0.0, confirm_one_s=1.0)
