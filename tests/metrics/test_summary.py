"""Lines of the summary, and the false alarms of a detector: counts, what pools, where no rate is."""

import pandas as pd
import pyarrow as pa
import pytest

from fddbench.metrics.alarms import ALARMS, summarize_alarms
from fddbench.metrics.clustered import korn_graubard
from fddbench.metrics.exposure import alarm_rate
from fddbench.metrics.intervals import clopper_pearson
from fddbench.metrics.summary import COUNTED, NEEDS, SUMMARY, summarize
from fddbench.results.schema import rows_schema

RIGHT = {"outcome": "right", "isolated": True, "over_declared": False, "changes": 1}
MISSED = {"outcome": "missed", "isolated": False, "over_declared": False, "changes": 0}
QUIET = {"scenario": "healthy", "n_faulty": 0, "onset_s": None, "detection_time_limit_s": None, "outcome": "quiet"}


def rows_of(*lines):
    """Arrow-backed rows; what a line does not say is null; a run of its own each unless told."""
    base = {"scenario": "jam_a", "manoeuvre": "cruise", "detector": "d", "status": "ok", "n_faulty": 1}
    base |= {"point": 0, "level": 0, "onset_s": 2.0, "flight_s": 20.0, "detection_time_limit_s": 10.0}
    listed = [base | {"run": i} | line for i, line in enumerate(lines)]
    return pa.Table.from_pylist(listed, schema=rows_schema(())).to_pandas(types_mapper=pd.ArrowDtype)


def only(rows, **more):
    summary = summarize(rows, **more)
    assert len(summary) == 1
    return summary.iloc[0]


def test_outcomes_add_up_and_shares_are_of_the_decided():
    names = ["right"] * 3 + ["wrong_site", "late", "missed", "false_alarm", "undecided", "undecided"]
    rows = rows_of(*({"outcome": name} for name in names), {"status": "infeasible"}, {"status": "timeout"})
    line = only(rows)
    assert (line.flights, line.flown, line.infeasible, line.failed, line.decided) == (11, 9, 1, 1, 7)
    assert sum(line[name] for name in COUNTED if name != "quiet") == line.flown
    assert line.quiet is pd.NA
    low, high = (100.0 * float(end) for end in clopper_pearson(3, 7))
    assert line.right_percent == pytest.approx(300 / 7)
    assert (line.right_low_percent, line.right_high_percent) == (pytest.approx(low), pytest.approx(high))
    assert line.wrong_site_percent == pytest.approx(100 / 7)


def test_no_rate_where_nothing_is_decided():
    line = only(rows_of({"outcome": "undecided"}, {"outcome": "undecided"}))
    assert (line.undecided, line.decided, line.right) == (2, 0, 0)
    for name in ("right_percent", "right_low_percent", "wrong_site_percent"):
        assert line[name] is pd.NA


def test_four_points_of_the_same_runs_are_clustered_and_say_so():
    lines = [
        RIGHT | {"point": point, "run": run} if run else MISSED | {"point": point, "run": run}
        for point in range(4)
        for run in range(10)
    ]
    line = only(rows_of(*lines))
    assert line.pools == "4 points"
    expected = korn_graubard([0] + [4] * 9, range(10), trials=4)
    assert line.right_percent == 90.0
    assert line.right_low_percent == pytest.approx(100.0 * expected.low)
    assert line.right_low_percent < 100.0 * float(clopper_pearson(36, 40)[0])
    assert only(rows_of(*lines[:10])).pools is pd.NA


def test_a_grid_without_monte_carlo_has_shares_and_no_intervals():
    line = only(rows_of(*(RIGHT | {"point": point, "run": 0} for point in range(5))))
    assert (line.right_percent, line.pools) == (100.0, "5 points")
    assert line.right_low_percent is pd.NA
    assert line.false_alarm_per_hour == 0.0
    assert line.false_alarm_high_per_hour is pd.NA


def test_times_flicker_and_estimates():
    lines = [
        RIGHT | {"detection_time_s": t, "normalized_detection_time": t / 10.0, "estimate_bias": -t}
        for t in (1.0, 2.0, 4.0)
    ]
    line = only(rows_of(*lines, MISSED | {"changes": 7, "departed_s": 3.0}))
    assert (line.detection_time_median_s, line.detection_time_p95_s, line.detection_time_max_s) == (2.0, 4.0, 4.0)
    assert line.normalized_detection_time_max == pytest.approx(0.4)
    assert (line.detections, line.changes_max, line.estimate_bias_median, line.departed) == (3, 7, -2.0, 1)
    assert line.estimate_rms_median is pd.NA
    assert (line.isolated, line.over_declared) == (3, 0)


def test_a_healthy_scenario_has_no_outcomes_of_faults():
    line = only(rows_of(QUIET, QUIET | {"outcome": "false_alarm", "false_alarm_time_s": 5.0}))
    assert line.healthy
    assert (line.quiet, line.false_alarm, line.alarms, line.distinct_flights) == (1, 1, 1, 2)
    for name in ("right", "wrong_site", "missed", "right_percent", "isolated", "detection_time_limit_s"):
        assert line[name] is pd.NA
    assert line.exposure_h == pytest.approx(25.0 / 3600.0)


def test_one_flight_in_two_scenarios_alarms_once():
    """20 runs alarm at 1 s, in a healthy scenario and before the fault of another: 3600 per hour in each and together."""
    early = {"outcome": "false_alarm", "false_alarm_time_s": 1.0}
    both = [part | early | {"run": run} for run in range(20) for part in ({"onset_s": 10.0}, QUIET)]
    rows = rows_of(*both)
    summary, alarms = summarize(rows), summarize_alarms(rows).iloc[0]
    expected = alarm_rate([1] * 20, [1.0] * 20, range(20))
    assert (alarms.alarms, alarms.distinct_flights, alarms.runs) == (20, 20, 20)
    for line in (*summary.to_dict("records"), alarms):
        assert line["false_alarm_per_hour"] == pytest.approx(3600.0)
        assert (round(line["false_alarm_low_per_hour"]), round(line["false_alarm_high_per_hour"])) == (2199, 5560)
        assert line["false_alarm_low_per_hour"] == pytest.approx(expected.low)
    assert alarms.pools is pd.NA
    assert summarize_alarms(rows_of(RIGHT, RIGHT | {"manoeuvre": "turn", "run": 0})).iloc[0].pools == "2 manoeuvres"


def test_what_was_tuned_on_these_flights_is_marked():
    rows = rows_of(RIGHT, RIGHT | {"detector": "tuned"})
    assert summarize(rows, in_sample=["tuned"])["in_sample"].tolist() == [False, True]
    assert summarize_alarms(rows, in_sample=["tuned"])["in_sample"].tolist() == [False, True]


def test_nothing_flown_gives_counts_and_no_rates():
    line = only(rows_of({"status": "infeasible", "flight_s": None}, {"status": "error", "flight_s": None}))
    assert (line.flights, line.flown, line.infeasible, line.failed) == (2, 0, 1, 1)
    assert (line.right, line.detections, line.exposure_h, line.distinct_flights) == (0, 0, 0.0, 0)
    assert line.detection_time_limit_s == 10.0
    for name in (
        "right_percent",
        "false_alarm_per_hour",
        "alarms_percent",
        "detection_time_median_s",
        "margin_healthy_max",
    ):
        assert line[name] is pd.NA


def test_order_of_appearance_whatever_the_order_of_shards():
    names = [("b", "y"), ("b", "x"), ("a", "x"), ("a", "y")]
    summary = summarize(rows_of(*({"scenario": s, "detector": d} | RIGHT for s, d in names)))
    found = list(zip(summary["scenario"], summary["detector"], strict=True))
    assert found == [("b", "y"), ("b", "x"), ("a", "y"), ("a", "x")]


@pytest.mark.parametrize("kind", ["float", "object"])
def test_all_null_columns_of_any_kind(kind):
    empty = pd.Series([None, None], dtype=kind)
    rows = rows_of(MISSED, MISSED)
    line = only(
        rows.assign(**dict.fromkeys(("detection_time_s", "isolated", "estimate_bias", "margin_healthy"), empty))
    )
    assert (line.detections, line.missed) == (0, 2)
    assert line.isolated is pd.NA


def test_empty_tables_and_documented_columns():
    for found, schema in ((summarize(rows_of()), SUMMARY), (summarize_alarms(rows_of()), ALARMS)):
        assert list(found.columns) == schema.names
        assert found.empty
        assert all(field.metadata[b"about"] for field in schema)
    assert set(NEEDS) <= set(rows_schema(()).names)


def test_the_limit_of_a_line_is_the_smallest_of_its_flights():
    line = only(rows_of(RIGHT, RIGHT | {"run": 1, "detection_time_limit_s": 4.0}, RIGHT | {"run": 2}))
    assert line.detection_time_limit_s == 4.0
