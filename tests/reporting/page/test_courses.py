"""How shares go over what is swept: never over what is drawn, never over sizes that belong to different scenarios."""

import numpy as np

from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.courses import courses, worst_value
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


def test_which_value_is_worst_is_said_where_it_is_asked(told):
    def said(about, outcome):
        rows = flown(told, outcome, lambda s, run: (9, 15, 25)[run % 3])
        columns = Columns(rows)
        return "".join(
            piece for piece, _ in worst_value(about, columns, [GUST], ranking(columns, summarize_alarms(rows)))
        )

    asked = "Which discrete gust is worst for the published scheme?"
    both_lost = said(asked, lambda s, d, run: "missed" if run % 3 == 1 else "right")
    assert both_lost == "gust gradient [m] 15 is worst: one is right in 0 % there, in up to 100 % elsewhere. "
    assert said(asked, lambda *_: "right") == (
        "None is worse than another, gust gradient [m] of 9 to 25: one is right in 100 % at each. "
    )
    assert said("Which detector is best?", lost_above_20) == ""
