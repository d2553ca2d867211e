"""How shares go over what is swept: never over what is drawn, never over sizes that belong to different scenarios."""

import numpy as np
import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.courses import courses, found_at, worst_value
from fddbench.reporting.page.ranking import ranking

GUST = "p_gust_gradient_m"


def flown(told, outcome, gust_of, scenarios=("jam_a", "jam_b")):
    rows = told(scenarios, ("one", "other"), 12, outcome)
    rows[GUST] = [float(gust_of(s, run)) for s, run in zip(rows["scenario"], rows["run"], strict=True)]
    return rows


def lost_above_20(s, d, run):
    return "missed" if d == "one" and run % 3 == 2 else "right"


def test_first_and_last_value_of_what_every_scenario_sweeps(told):
    columns = Columns(flown(told, lost_above_20, lambda s, run: (9, 15, 25)[run % 3]))
    (course,) = courses(columns, [GUST])
    assert (course.first, course.last) == ("9", "25")
    assert list(course.shares) == [("one", 100.0, 0.0), ("other", 100.0, 100.0)]


def test_what_is_drawn_in_every_run_has_no_course(told):
    """Of six drawn sizes the smallest and the largest were called the ends of a sweep, one flight each."""
    assert courses(Columns(flown(told, lost_above_20, lambda s, run: 9.0 + run)), [GUST]) == []


def test_sizes_of_different_scenarios_have_no_course(told):
    assert courses(Columns(flown(told, lost_above_20, lambda s, run: 9.0 if s == "jam_a" else 25.0)), [GUST]) == []
    partly = flown(told, lost_above_20, lambda s, run: (9, 25)[run % 2] if s == "jam_a" else np.nan)
    assert courses(Columns(partly), [GUST]) == []


@pytest.fixture
def worst(told):
    """What is said of 20 runs that fly every value, 9, 15 and 25 m."""

    def say(outcome, about="Which discrete gust is worst for the published scheme?"):
        rows = told(("jam_a", "jam_b"), ("one", "other"), 60, lambda s, d, run: outcome(s, run % 3, run // 3, d))
        number = rows["run"].to_numpy(dtype=int)
        rows[GUST], rows["point"], rows["run"] = np.array([9.0, 15.0, 25.0])[number % 3], number % 3, number // 3
        ranks = ranking(Columns(rows), summarize_alarms(rows))
        return "".join(piece for piece, _ in worst_value(about, Columns(rows), [GUST], ranks))

    return say


def test_which_value_is_worst_is_said_where_it_is_asked(worst):
    lost = worst(lambda s, point, run, d: "missed" if point == 1 else "right")
    assert lost == "gust gradient [m] 15 is worst: one is right in 0 % there, in up to 100 % elsewhere. "
    assert worst(lambda *_: "right") == (
        "None is worse than another, gust gradient [m] of 9 to 25: one is right in 100 % at each. "
    )
    assert worst(lambda *_: "right", about="Which detector is best?") == ""


def test_no_value_is_worst_that_chance_may_explain_or_that_is_not_alone(worst):
    few = worst(lambda s, point, run, d: "missed" if (s, point, run) == ("jam_a", 1, 0) else "right")
    assert few == "Not decided which is worst: one is right in 97.5 to 100 % over gust gradient [m] 9 to 25. "
    tie = worst(lambda s, point, run, d: "missed" if point else "right")
    assert tie.startswith("Not decided which is worst: one is right in 0 to 100 %")


def test_a_value_that_some_scenarios_do_not_fly_is_not_compared(told):
    rows = flown(told, lambda s, d, run: "missed" if s == "jam_b" else "right", lambda s, run: (9, 15, 25)[run % 3])
    rows = rows[~((rows["scenario"] == "jam_a") & (rows[GUST] == 15.0))].reset_index(drop=True)
    ranks = ranking(Columns(rows), summarize_alarms(rows))
    assert worst_value("Which discrete gust is worst?", Columns(rows), [GUST], ranks) == []


def test_a_value_at_which_nothing_is_decided_is_not_the_worst(worst):
    """Of no decided flight a share of 0 % was told: the value that nobody had judged was the worst."""
    outcomes = {"one": ("right", "undecided", "right"), "other": ("right", "missed", "missed")}
    said = worst(lambda s, point, run, d: outcomes[d][point])
    assert said == "None is worse than another, gust gradient [m] of 9 to 25: one is right in 100 % at each. "


def test_where_faults_are_found_is_said_where_it_is_asked(told):
    def outcome(s, d, run):
        return "missed" if (d == "one" and run % 4 in (0, 3)) or d == "two" else "right"

    rows = told(("jam_a",), ("one", "two", "three"), 80, outcome)
    number = rows["run"].to_numpy(dtype=int)
    rows[GUST], rows["run"] = np.array([9.0, 15.0, 25.0, 40.0])[number % 4], number // 4
    columns = Columns(rows)
    ranks = ranking(columns, summarize_alarms(rows))

    def said(about):
        return "".join(piece for piece, _ in found_at(about, columns, [GUST], ranks))

    assert said("At which gusts is a jam found?") == (
        "Right in 90 % or more at gust gradient [m] of 9 to 40, jam_a: three at all 4; one at 15 to 25; two at none. "
    )
    assert said("Which detector is best?") == ""
    assert found_at("At which gusts?", columns, ["p_mass_kg"], ranks) == []
