"""Cells of the matrix: outcomes add up, pooled false alarms are those of distinct flights, the worst come first."""

import json
import re

import numpy as np
import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.distinct import distinct_flights
from fddbench.metrics.summary import summarize
from fddbench.reporting.page.cells import cells
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.matrix import matrix_lines, matrix_scene, words
from fddbench.reporting.page.payload import counts_of, payload
from fddbench.reporting.page.ranking import ranking

LOST = {1: ("infeasible", "buffet: too slow"), 2: ("error", "ValueError")}


@pytest.fixture
def rows(make_rows):
    return make_rows(("jam_b", "jam_a", "noise_a", "healthy"), ("voting_monitor", "sliding_mode"), 30, LOST)


def own(rows):
    columns = Columns(rows)
    return columns, cells(columns, summarize(rows), len(columns.detectors) - 1)


def test_outcomes_of_each_cell_add_up_to_the_flown_flights(rows):
    columns, found = own(rows)
    assert len(found) == 8
    for cell in found.values():
        assert sum(counts_of(cell.line).values()) == cell.line["flown"] == 28
    sent = payload(columns, found, "results/x")
    assert all(sum(cell["o"]) == cell["n"] == 28 for line in sent["c"] for cell in line)
    json.dumps(sent, allow_nan=False)


def test_pooled_false_alarms_are_those_of_distinct_flights(told):
    def outcome(scenario, _, run):
        return "false_alarm" if run < 4 else "quiet" if scenario == "healthy" else "right"

    rows = told(("jam_a", "jam_b", "healthy"), ("d",), 20, outcome)
    (rank,) = ranking(Columns(rows), summarize_alarms(rows))
    flights = distinct_flights(rows)
    assert (rank.alarms, rank.distinct_flights) == (int(flights.alarm.sum()), len(flights.alarm)) == (4, 20)


def test_ranks_pool_what_the_cells_say(rows):
    columns, found = own(rows)
    for rank in ranking(columns, summarize_alarms(rows)):
        mine = [counts_of(cell.line) for (_, d), cell in found.items() if d == rank.number and not cell.line["healthy"]]
        for name in ("right", "late", "missed", "wrong_site", "undecided", "false_alarm"):
            assert rank.outcomes.get(name, 0) == sum(counts.get(name, 0) for counts in mine)


def test_words_say_what_the_bar_shows(rows):
    _, found = own(rows)
    assert words(found[0, 0].line) == "28 wrong site of 28"
    assert words(found[3, 0].line).startswith("all 28 quiet, ≥ ")
    bar = matrix_lines(*own(rows))[0].cells[0].bar
    widths = [float(w) for w in re.findall(r'width="([\d.]+)"', bar)]
    assert sum(widths) == pytest.approx(150.0)


def test_the_worst_flights_are_those_with_healthy_sites_declared(told):
    rows = told(("jam_a",), ("d",), 20, lambda s, d, run: {3: "wrong_site", 5: "missed", 9: "late"}.get(run, "right"))
    _, found = own(rows)
    assert [name.split("/")[2] for name in found[0, 0].worst] == ["3", "5", "9"]
    quiet = told(("jam_a",), ("d",), 20, lambda *_: "right")
    assert len(own(quiet)[1][0, 0].worst) == 1


def test_declared_beside_true_adds_up(rows):
    _, found = own(rows)
    assert found[0, 0].declared == [("r1+r2", "r3", 28)]
    assert sum(n for *_, n in found[2, 1].declared) == 28


def test_two_names_never_print_alike(make_rows):
    names = tuple(
        f"sliding_mode_of_the_published_design_with_a_{what}_in_the_middle_of_its_name" for what in ("b", "c")
    )
    rows = make_rows(("jam_a",), names, 4)
    columns = Columns(rows)
    text = matrix_scene(columns, cells(columns, summarize(rows), None)).svg(standalone=True)
    heads = re.findall(r'font-weight="700"[^>]*>([^<]+)<', text)[:2]
    assert len(set(heads)) == 2


def test_paired_differences_are_adjusted_over_scenarios(rows):
    _, found = own(rows)
    assert found[0, 1].paired is None  # the one that others are compared with
    each = found[0, 0].paired
    assert (each.only_a, each.only_b) == (28, 0)
    assert found[0, 0].p_holm >= each.p_value
    assert np.isclose(each.difference, -1.0)


def test_a_scenario_with_faulty_and_healthy_logs_adds_up_too(told):
    def logs(bad):
        rows = told(
            ("jam_a",), ("d",), 10, lambda s, d, run: "quiet" if run < 4 else "missed" if run == 9 and bad else "right"
        )
        rows.loc[rows["run"] < 4, "n_faulty"] = 0
        return own(rows)

    for bad, said in ((False, "6 right, 4 quiet of 10"), (True, "1 missed of 10")):
        columns, found = logs(bad)
        assert sum(counts_of(found[0, 0].line).values()) == found[0, 0].line["flown"] == 10
        (cell,) = payload(columns, found, "results/x")["c"][0]
        assert sum(cell["o"]) == cell["n"]
        assert words(found[0, 0].line) == said
