"""The bound beside the scores: its column where it says something, its text, and what exceeds it."""

import pandas as pd
import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.bound import bounds_table, breaches, with_bounds
from fddbench.metrics.summary import summarize
from fddbench.reporting.bounds import HEADS, bound_lines, bounds_text
from fddbench.reporting.terminal import to_text


def stated(scenario, p_d, model="exact"):
    line = {"scenario": scenario, "model": model, "about": f"{model} in words", "p_fa": 1e-6, "window_s": 0.36}
    return line | {"flights": 25, "d": 5.5, "d_least": 5.0, "p_d": p_d, "d_health": 100.0, "p_detect": 1.0}


@pytest.fixture
def summary(make_rows):
    return summarize(make_rows(("jam_a", "jam_b"), ("sliding_mode", "voting_monitor"), 50))


def test_each_score_has_the_bound_of_the_model_that_knows_most(summary):
    table = bounds_table(
        [stated("jam_b", 0.77), stated("jam_b", 0.5, "walk"), {"scenario": "jam_a", "about": "no model"}]
    )
    lines = with_bounds(summary, table).set_index(["scenario", "detector"])
    assert lines.loc[("jam_b", "sliding_mode"), "bound_percent"] == pytest.approx(77.0)
    assert pd.isna(lines.loc[("jam_a", "sliding_mode"), "bound_percent"])


def test_one_that_only_detects_stands_beside_the_probability_of_an_alarm(summary):
    blind = summary.assign(isolated=pd.array([None] * len(summary), dtype="Int64"))
    lines = with_bounds(blind, bounds_table([stated("jam_b", 0.77)]))
    assert lines["bound_percent"].dropna().unique().tolist() == [100.0]


def test_a_score_above_its_bound_is_told_with_the_assumption(summary):
    """sliding_mode is right in 50 of 50 flights, 92.9 % at least; voting_monitor in none."""
    (first,) = breaches(summary, bounds_table([stated("jam_b", 0.77)]))
    assert first.startswith("sliding_mode in jam_b: 100.0 % right, at least 92.9 %, where “exact” allows 77.0 %")
    assert "a false alarm in 1e-06 of decisions; it had 0 in 50 flights" in first
    (second,) = breaches(summary, bounds_table([stated("jam_b", 0.95), stated("jam_b", 0.5, "walk")]))
    assert "“walk” allows 50.0 %" in second
    assert "the aircraft is better known" in second
    assert breaches(summary, bounds_table([stated("jam_b", 0.95)])) == []


def test_the_terminal_has_the_column_where_it_says_something(summary, make_rows):
    alarms = summarize_alarms(make_rows(("jam_b",), ("sliding_mode", "voting_monitor"), 50))
    for p_d, shown in ((0.77, True), (1.0, False)):
        text = to_text(with_bounds(summary, bounds_table([stated("jam_b", p_d)])), alarms)
        assert ("bound" in text) == shown
        assert max(map(len, text.splitlines())) <= 80
    assert "77.0" in to_text(with_bounds(summary, bounds_table([stated("jam_b", 0.77)])), alarms)


def test_text_and_lines():
    table = bounds_table([stated("jam_b", 0.77), {"scenario": "jam_a", "about": "no model"}])
    text = bounds_text(table)
    assert "jam_b" in text
    assert "exact in words" in text
    assert "no model" in text
    first, second = bound_lines(table)
    assert len(first) == len(second) == len(HEADS)
    assert [cell.text for cell in first][3:6] == ["5.5", "5", "77.0"]
    assert "nothing to find" in bounds_text(bounds_table([]))
