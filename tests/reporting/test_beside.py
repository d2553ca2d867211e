"""Ours beside print: which scenario stands beside which row, and what became of the flights that were not right."""

import pytest

from fddbench.metrics.summary import summarize
from fddbench.reporting.beside import Told, beside
from fddbench.reporting.published import published


def _texts(found):
    return {(line[0].text, line[1].text): [cell.text for cell in line[2:]] for line in found.lines}


@pytest.fixture
def summary(make_rows):
    return lambda *scenarios: summarize(make_rows(scenarios, ("sliding_mode", "voting_monitor"), 20))


def test_a_plain_name_stands_beside_every_variant(summary):
    found = beside(summary("jam_b", "healthy_cruise"), published("table8"))
    assert found.groups == ("Simulink blocks", "Airbus SAO blocks")
    lines = _texts(found)
    ours = lines["jam_b", "sliding_mode"]
    assert ours[0] == "20 of 20"
    assert (ours[4], ours[7]) == ("11 (0.3056)", "10 (0.2778)")
    assert int(ours[5].replace("\u2212", "-")) == int(ours[1]) - 11
    assert lines["healthy_cruise", "sliding_mode"][0] == "20 of 20"
    assert [line[0].text for line in found.lines[2:]] == ["jam_b", "jam_b"]
    assert found.told[0] == Told(detector="sliding_mode", sound=True, away=None)
    assert found.told[2] == Told(detector="sliding_mode", sound=True, away=int(ours[1]) - 11)
    assert not found.told[3].sound


def test_what_was_not_right_is_said(summary):
    line = next(of for of in beside(summary("jam_b"), published("table8")).lines if of[1].text == "voting_monitor")
    assert (line[2].text, line[2].small, line[2].alarm) == ("0 of 20", "20 wrong", True)


def test_a_name_that_says_its_row_stands_beside_that_row_alone(summary, make_rows):
    rows = make_rows(("jam_a",), ("sliding_mode",), 5)
    rows["scenario"] = "jam_a_half_size"
    found = beside(summarize(rows), published("table10"))
    assert found.groups == ("in print",)
    assert len(found.lines) == 1
    assert found.lines[0][6].text == "100 (0.0083)"


def test_what_is_not_in_print_has_no_table(summary):
    assert beside(summary("healthy"), published("table8")) is None


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"wind": "light"}, "wind light, in print none"),
        ({"onset_s": 5.0}, "onset 5 s, in print 2 s"),
        ({"amplitude_percent": 2.5}, "amplitude 2.5 %, in print 1.25 %"),
        ({"amplitude_percent": {"uniform": [1, 2]}}, "amplitude drawn or swept, in print 1.25 %"),
        ({"sites": ["r1", "r2"]}, "2 faulty sites, in print 1"),
        ({}, ""),
    ],
)
def test_only_the_same_conditions_stand_beside_print(make_rows, changes, words):
    fault = {"kind": "jam", "sites": ["r1"], "onset_s": 2.0, "amplitude_percent": 1.25}
    fault |= {name: value for name, value in changes.items() if name != "wind"}
    campaign = {"wind": changes.get("wind", "none"), "scenarios": [{"name": "jam_a", "faults": [fault]}]}
    found = beside(summarize(make_rows(("jam_a",), ("d",), 5)), published("table8"), campaign)
    assert (found.apart, len(found.lines)) == (((("jam_a", words),), 0) if words else ((), 1))
