import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.campaign.check import describe
from fddbench.campaign.load import read_campaign
from fddbench.campaign.plan import plan
from fddbench.campaign.streams import scenario_stream
from fddbench.clock import on_clock, samples

TWO = "      - {kind: jam, sites: [r1], onset_s: 4, amplitude_percent: 10}\n"
LATE = TWO + "      - {kind: noise, sites: [r2], onset_s: 9, end_s: 12, variance_percent: 1}\n"


def test_numbers_cases_scenario_by_scenario(write):
    found = plan(read_campaign(write(), ["scenarios.healthy.runs=2", "dispersions.grid.speed_kt=[200, 250]"]))
    assert [(scenario.first_case, scenario.n_cases) for scenario in found.scenarios] == [(0, 4), (4, 10)]
    assert (found.n_cases, found.n_rows) == (14, 14)
    at = found.locate([0, 3, 4, 13])
    assert at.scenario.tolist() == [0, 0, 1, 1]
    assert (at.point.tolist(), at.level.tolist(), at.run.tolist()) == ([0, 1, 0, 1], [0] * 4, [0, 1, 0, 4])
    assert found.names([3, 13]) == ("healthy/1/0/1", "jam_a/1/0/4")
    assert found.numbers(found.names(range(14))).tolist() == list(range(14))
    for outside in (-1, 14):
        with pytest.raises(IndexError, match="0 ... 13"):
            found.locate([outside])


def test_flights_are_long_enough_for_their_faults(write):
    healthy, jam = plan(read_campaign(write())).scenarios
    assert (healthy.durations_s, healthy.samples, healthy.latest_onset_s, healthy.requirement_s, healthy.n_faulty) == (
        (60.0,), (6001,), None, None, 0,
    )  # fmt: skip
    assert (jam.durations_s, jam.samples, jam.latest_onset_s, jam.requirement_s, jam.n_faulty) == (
        (129.0,), (12901,), 4.0, 120.0, 1,
    )  # fmt: skip
    assert jam.stream == scenario_stream("evaluation", "jam_a")


def test_the_scenario_s_duration_and_limit_win(write):
    overrides = ["duration_s=200", "scenarios.jam_a.duration_s=20", "scenarios.jam_a.detection_time_limit_s=1.5"]
    healthy, jam = plan(read_campaign(write(), overrides)).scenarios
    assert (healthy.durations_s, jam.durations_s) == ((200.0,), (20.0,))
    assert (jam.requirement_s, jam.event_requirements_s) == (1.5, (1.5,))


def test_two_faults_have_their_own_limits_and_a_common_one(write):
    jam = plan(read_campaign(write(**{TWO: LATE}), ["duration_s=20"])).scenarios[1]
    assert (jam.latest_onset_s, jam.requirement_s, jam.event_requirements_s) == (9.0, 0.36, (120.0, 120.0))
    assert jam.faulty_sites == ("r1", "r2")


def test_delay_prolongs_the_flight(write):
    delayed = TWO.replace("[r1]", "[r1, r3]").replace("onset_s", "delay_s: 2, onset_s")
    jam = plan(read_campaign(write(**{TWO: delayed}))).scenarios[1]
    assert jam.durations_s == (pytest.approx(4 + 2 + 0.36 + 5),)


def test_run_seven_is_the_same_aircraft_in_every_scenario(write):
    found = plan(read_campaign(write()))
    mass = found.parameters(range(10))["mass_kg"]
    np.testing.assert_array_equal(mass[:5], mass[5:])
    np.testing.assert_array_equal(found.parameters([8, 1, 3])["mass_kg"], mass[[8, 1, 3]])
    assert set(found.parameters([0])) == {"mass_kg", "x_cg_percent", "altitude_ft", "speed_kt"}


def test_another_scenario_changes_no_flight(write):
    inserted = {"scenarios:\n": "scenarios:\n  - {name: first, manoeuvre: cruise, runs: 3}\n"}
    before, after = plan(read_campaign(write())), plan(read_campaign(write(**inserted)))
    np.testing.assert_array_equal(
        before.parameters(range(10))["mass_kg"], after.parameters(np.arange(10) + 3)["mass_kg"]
    )
    assert [scenario.stream for scenario in before.scenarios] == [scenario.stream for scenario in after.scenarios[1:]]


@given(st.integers(0, 10**6), st.sampled_from([0.01, 0.02, 0.04, 0.005, 0.0125]))
def test_every_sample_is_on_the_clock(number, sample_s):
    assert on_clock(number * sample_s, sample_s)
    assert samples(number * sample_s, sample_s) == number
    assert not on_clock((number + 0.4) * sample_s, sample_s)


def test_says_what_would_run(write):
    text = describe(plan(read_campaign(write(), ["dispersions.sequence.speed_kt=[200, 230, 260]"])))
    for part in (
        "Campaign good",
        "Does it work?",
        "Benchmark toy, plant lateral_lpv, voter median, sensors white, wind none",
        "jam amplitude_percent=10 on r1 at 4 s",
        "5 Monte-Carlo runs",
        "mass_kg uniform in 150000 to 200000",
        "in sequence speed_kt: 200, 230, 260",
        "plain (watcher): made up; tuned on tuning seed 3",
        "30 cases x 1 detector = 30 rows, 0.7875 h of flight",
        "with 2 jobs, and 0.2 MB on disk",
    ):
        assert part in text


def test_says_where_rows_may_be_undecided(write):
    path = write()
    assert "undecided" not in describe(plan(read_campaign(path)))
    text = describe(plan(read_campaign(path, ["scenarios.jam_a.duration_s=20"])))
    assert "undecided, not missed, where the flight ends before its limit: jam_a" in text
