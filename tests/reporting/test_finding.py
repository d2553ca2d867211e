"""Ten lines written from the data: who is best, where it is weakest, and what nobody may hide."""

import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.finding import MOST_LINES, finding_text

BOTH = ("sliding_mode", "voting_monitor")


def lines(rows, **more):
    text = finding_text(rows, summarize_alarms(rows), title="t", question="Which?", **more)
    assert text.startswith("# t\n\nWhich?\n\n1. ")
    found = [line.split(". ", 1)[1] for line in text.splitlines() if line[:1].isdigit()]
    return dict(line.rstrip(".").split(": ", 1) if ": " in line else (line, "") for line in found)


def test_the_best_comes_first_and_its_weakest_scenario_is_told(make_rows):
    found = lines(make_rows(("jam_a", "jam_b", "healthy"), BOTH, 20))
    assert found["Right in time"].startswith("sliding_mode 100 % (82.1 … 100; 40 of 40); voting_monitor 50.0 % (")
    assert found["Weakest scenario"] == "voting_monitor in jam_b, right in 0 of 20"
    assert found["Healthy sites declared"].endswith("20 of 40); never by sliding_mode")


def test_detectors_that_see_less_are_not_ranked_with_the_others(make_rows):
    found = lines(make_rows(("jam_a",), BOTH, 10), apart=["voting_monitor"])
    assert "voting_monitor" not in found["Right in time"]
    assert found["Right in time, of those that see the voted signal alone"].startswith("voting_monitor 100 %")


@pytest.mark.parametrize("outcome", ["right", "missed", "undecided"])
def test_all_alike_and_nothing_decided(make_rows, outcome):
    rows = make_rows(("jam_a",), ("d",), 4)
    rows["outcome"] = [outcome] * 4
    found = lines(rows)
    assert ("Right in time" in found) == (outcome != "undecided")
    assert ("Weakest scenario" in found) == (outcome == "missed")


def test_one_flight_has_a_share_without_an_interval_and_an_empty_table_says_so(make_rows):
    assert lines(make_rows(("jam_a",), ("d",), 1))["Right in time"] == "d 100 % (1 of 1)"
    assert list(lines(make_rows((), (), 0))) == ["No flight", "Not scored"][:1]


def test_along_a_sweep_and_never_more_than_ten_lines(make_rows):
    rows = make_rows(("jam_a", "jam_b"), ("voting_monitor",), 10)
    found = lines(rows.assign(p_size=rows["n_faulty"].astype("float64")), swept=["p_size"])
    assert found["Right [%] at p_size = 1, 2"] == "voting_monitor 100, 0"
    many = lines(rows.assign(**{f"p_{i}": rows["n_faulty"] for i in range(20)}), swept=[f"p_{i}" for i in range(20)])
    assert len(many) == MOST_LINES


def test_of_many_detectors_the_first_and_the_last_are_named(make_rows):
    found = lines(make_rows(("jam_a",), tuple(f"d{i:02}" for i in range(20)), 2))
    assert "12 more between" in found["Right in time"]
    assert found["Right in time"].count("%") == 8


def test_a_campaign_that_asks_nothing_leaves_no_blank_lines(make_rows):
    rows = make_rows(("jam_a",), ("d",), 2)
    found = finding_text(rows, summarize_alarms(rows), title="mine", question="")
    assert found.startswith("# mine\n\n1. ")
