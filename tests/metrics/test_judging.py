"""Requirements judged by rows: which runs count, what is one flight, what failed, groups, and more runs later."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from fddbench.metrics.judging import judged
from fddbench.metrics.requirements import Judgement, PlannedFlights, Requirement
from fddbench.results.schema import rows_schema

BASE = {"manoeuvre": "cruise", "detector": "d", "status": "ok", "point": 0, "level": 0, "flight_s": 20.0}
FAULTY = {"onset_s": 10.0, "outcome": "right", "normalized_detection_time": 0.5}
RIGHT = Requirement(name="right", of="right_share", limit=0.9, scenarios=("jam", "nrz"))
QUIET = Requirement(name="quiet", of="false_alarms_per_hour", limit=10.0, scenarios=("healthy", "jam"))


def rows_of(lines):
    return pa.Table.from_pylist([BASE | line for line in lines], schema=rows_schema(())).to_pandas(
        types_mapper=pd.ArrowDtype
    )


def faulty(runs, **changes):
    return [FAULTY | {"scenario": name, "run": run} | changes for name in ("jam", "nrz") for run in range(runs)]


def planned(runs=100, points=1, **own):
    each = {"points": points, "levels": 1, "healthy_h": 10.0 / 3600.0}
    found = {name: PlannedFlights(runs=runs, **each) for name in ("jam", "nrz")}
    found["healthy"] = PlannedFlights(runs=runs, points=points, levels=1, healthy_h=20.0 / 3600.0)
    return found | own


def one(required, lines, plan=None, **more) -> Judgement:
    (found,) = judged(required, rows_of(lines), plan or planned(), detector="d", **more)
    return found


def test_all_right_passes_and_all_wrong_fails_and_few_are_undecided():
    passed, failed, few = one(RIGHT, faulty(100)), one(RIGHT, faulty(100, outcome="missed")), one(RIGHT, faulty(5))
    assert (passed.verdict, passed.value, passed.runs_used, passed.runs_needed) == ("pass", 1.0, 100, 0)
    assert passed.low >= 0.9
    assert passed.decided_at < 100
    assert (failed.verdict, failed.value) == ("fail", 0.0)
    assert (few.verdict, few.decided_at, few.runs_used, few.runs_planned) == ("undecided", None, 5, 100)
    # as many as it took above, two flights each
    assert few.runs_needed == passed.decided_at - 5
    assert few.flights_needed == 2 * few.runs_needed


def test_only_the_first_runs_without_a_gap_count_in_any_order_of_rows():
    lines = [line for line in faulty(100) if (line["scenario"], line["run"]) != ("nrz", 7)]
    found = one(RIGHT, lines)
    assert (found.runs_used, found.verdict) == (7, "undecided")
    shuffled = [lines[i] for i in np.random.default_rng(0).permutation(len(lines))]
    assert one(RIGHT, shuffled) == found
    # later runs have no part in it, whatever they are
    assert one(RIGHT, [line | ({"outcome": "missed"} if line["run"] > 7 else {}) for line in lines]) == found


def test_what_is_decided_stays_so_when_runs_are_added():
    passed = one(RIGHT, faulty(100))
    more = faulty(100) + [line | {"outcome": "missed"} for line in faulty(300) if line["run"] >= 100]
    later = one(RIGHT, more, planned(300))
    assert (later.verdict, later.decided_at) == ("pass", passed.decided_at)
    assert later.value == pytest.approx(1 / 3)


def test_the_fewest_runs_of_its_scenarios_count():
    own = planned(100, nrz=PlannedFlights(points=1, levels=1, runs=20, healthy_h=0.0))
    found = one(RIGHT, [line for line in faulty(100) if line["scenario"] == "jam" or line["run"] < 20], own)
    assert (found.runs_used, found.runs_planned) == (20, 20)


def test_what_has_no_part_in_rates_neither_wins_nor_loses():
    lines = faulty(100)
    for line in lines[:40]:
        line |= {"outcome": "undecided"}
    assert one(RIGHT, lines).value == 1.0
    idle = one(RIGHT, faulty(100, outcome="undecided"))
    assert (idle.verdict, idle.value, idle.runs_needed, idle.low, idle.high) == ("undecided", None, None, 0.0, 1.0)
    assert one(RIGHT, faulty(100, status="infeasible", outcome=None)).verdict == "undecided"


def test_what_failed_is_for_nobody():
    found = one(RIGHT, faulty(100, status="error", outcome=None))
    assert (found.verdict, found.failed, found.value) == ("undecided", 200, None)
    lines = faulty(100)
    for line in lines[:30]:
        line |= {"status": "timeout", "outcome": None}
    assert one(RIGHT, lines).verdict == "undecided"


def test_no_rows_at_all_are_undecided():
    found = one(RIGHT, [])
    assert (found.verdict, found.runs_used, found.flights_needed) == ("undecided", 0, None)
    assert one(QUIET, []).verdict == "undecided"


def test_a_time_is_kept_by_those_who_find_without_a_wrong_site():
    soon = Requirement(name="soon", of="normalized_detection_time", limit=0.9, within=0.5, scenarios=("jam", "nrz"))
    assert one(soon, faulty(100)).verdict == "pass"
    assert one(soon, faulty(100, normalized_detection_time=0.51)).verdict == "fail"
    assert one(soon, faulty(100, outcome="wrong_site")).verdict == "fail"
    assert one(soon, faulty(100, normalized_detection_time=None)).verdict == "fail"
    twice = Requirement(name="twice", of="normalized_detection_time", limit=0.9, within=2.0, scenarios=("jam", "nrz"))
    assert one(twice, faulty(100, outcome="late", normalized_detection_time=1.5)).verdict == "pass"


def test_groups_are_judged_one_by_one():
    lines = faulty(60) + [line | {"point": 1, "outcome": "missed"} for line in faulty(60)]
    rows = rows_of(lines).assign(p_x_cg_ratio=lambda r: r["point"].map({0: 0.28, 1: 0.32}))
    found = list(judged(RIGHT, rows, planned(60, points=2), detector="d", by="p_x_cg_ratio"))
    assert [(each.group, each.verdict) for each in found] == [("x_cg_ratio 0.28", "pass"), ("x_cg_ratio 0.32", "fail")]
    assert one(RIGHT, lines, planned(60, points=2)).value == 0.5
    by = list(judged(RIGHT, rows, planned(60, points=2), detector="d", by="scenario"))
    assert [(each.group, each.scenarios) for each in by] == [("scenario jam", ("jam",)), ("scenario nrz", ("nrz",))]


def healthy(runs, alarm=None, outcome="quiet"):
    base = {"run": 0, "scenario": "healthy", "outcome": outcome, "false_alarm_time_s": alarm}
    jam = FAULTY | {
        "scenario": "jam",
        "false_alarm_time_s": alarm,
        "outcome": "right" if alarm is None else "false_alarm",
    }
    return [line | {"run": run} for run in range(runs) for line in (base, jam)]


def test_alarms_are_of_distinct_flights_over_their_exposure():
    found = one(QUIET, healthy(100))
    assert (found.verdict, found.value, found.low) == ("pass", 0.0, 0.0)
    # one flight of 20 s an aircraft, not two rows
    lines = healthy(100)
    lines[0] |= {"false_alarm_time_s": 5.0, "outcome": "false_alarm"}
    lines[1] |= {"false_alarm_time_s": 5.0, "outcome": "false_alarm"}
    assert one(QUIET, lines).value == pytest.approx(1 / (99 * 20.0 + 5.0) * 3600.0)
    assert one(QUIET, healthy(100, 5.0, "false_alarm")).verdict == "fail"
    share = Requirement(name="share", of="false_alarm_share", limit=0.1, scenarios=("healthy", "jam"))
    assert one(share, lines).value == pytest.approx(0.01)
    assert one(share, healthy(100, 0.0, "false_alarm")).verdict == "fail"


def test_a_flight_is_lost_where_all_its_rows_failed():
    lost = [line | {"status": "error", "outcome": None} for line in healthy(100)]
    assert one(QUIET, lost).verdict == "undecided"
    half = healthy(100)
    for line in half[::2]:
        line |= {"status": "error", "outcome": None}  # the healthy ones; those with a jam stand for them
    found = one(QUIET, half)
    assert (found.verdict, found.failed) == ("undecided", 100)
    assert found.high < 22.0  # 1000 s without an alarm
    assert one(QUIET, lost[:200:2] + lost[1::2]).low == 0.0
