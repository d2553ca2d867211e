import pandas as pd
import pyarrow as pa
import pytest

from fddbench.metrics.summary import SUMMARY, summarize, true_detection
from fddbench.results.schema import rows_schema

FOUND = {
    "classified": True,
    "isolated": True,
    "over_declared": False,
    "missed": False,
    "censored": False,
    "false_alarm": False,
}
NOTHING = FOUND | {"classified": False, "isolated": False, "missed": True}


def rows_of(*lines):
    """Arrow-backed rows; what a line does not say is null."""
    base = {"scenario": "jam_a", "manoeuvre": "cruise", "run": 0, "detector": "d", "status": "ok", "n_faulty": 1}
    base |= {"onset_s": 2.0, "flight_s": 20.0, "detection_time_limit_s": 10.0}
    listed = [base | {"case": i} | line for i, line in enumerate(lines)]
    return pa.Table.from_pylist(listed, schema=rows_schema(())).to_pandas(types_mapper=pd.ArrowDtype)


def only(rows):
    summary = summarize(rows)
    assert len(summary) == 1
    return summary.iloc[0]


def test_counts_rates_and_times():
    found = [FOUND | {"detection_time_s": t, "normalized_detection_time": t / 10.0} for t in (1.0, 2.0, 4.0)]
    line = only(rows_of(*found, NOTHING, {"status": "infeasible"}, {"status": "timeout"}))
    assert (line.flights, line.flown, line.infeasible, line.failed) == (6, 4, 1, 1)
    assert (line.true_detection, line.true_detection_percent, line.true_detection_all_percent) == (3, 75.0, 50.0)
    assert line.true_detection_low_percent < 75.0 < line.true_detection_high_percent
    assert (line.missed, line.missed_trials, line.detections) == (1, 4, 3)
    assert (line.detection_time_median_s, line.detection_time_p95_s, line.detection_time_max_s) == (2.0, 4.0, 4.0)
    assert line.normalized_detection_time_max == pytest.approx(0.4)


def test_exposure_ends_at_the_onset_or_at_the_end_of_the_flight():
    line = only(
        rows_of(FOUND, FOUND | {"flight_s": 1.0}, FOUND | {"false_alarm": True, "onset_s": 3597.0, "flight_s": 4e3})
    )
    assert line.exposure_h == pytest.approx(1.0)
    assert line.false_alarm_per_hour == pytest.approx(1.0)
    assert (line.false_alarm, line.true_detection) == (1, 2)
    assert line.false_alarm_low_per_hour < 1.0 < line.false_alarm_high_per_hour


def test_censored_flights_are_neither_missed_nor_true():
    censored = NOTHING | {"missed": None, "censored": True}
    line = only(rows_of(FOUND, NOTHING, censored))
    assert (line.censored, line.missed, line.missed_trials, line.missed_percent) == (1, 1, 2, 50.0)
    assert (line.true_detection, line.true_detection_trials) == (1, 3)


def test_healthy_scenario_has_no_fault_scores():
    healthy = {"n_faulty": 0, "onset_s": None, "detection_time_limit_s": None, "margin_healthy": 0.7}
    line = only(rows_of(healthy | {"false_alarm": False}, healthy | {"false_alarm": True, "flight_s": 3580.0}))
    assert line.healthy
    assert (line.true_detection, line.false_alarm, line.exposure_h) == (1, 1, 1.0)
    for name in (
        "over_declared",
        "missed_percent",
        "isolated",
        "censored",
        "detection_time_max_s",
        "detection_time_limit_s",
    ):
        assert line[name] is pd.NA
    assert line.margin_healthy_max == 0.7


def test_nothing_flown_gives_counts_and_no_rates():
    line = only(rows_of({"status": "infeasible", "flight_s": None}, {"status": "diverged", "flight_s": None}))
    assert (line.flights, line.flown, line.infeasible, line.failed) == (2, 0, 1, 1)
    assert (line.true_detection, line.detections, line.exposure_h) == (0, 0, 0.0)
    for name in ("true_detection_percent", "false_alarm_per_hour", "detection_time_median_s", "margin_healthy_max"):
        assert line[name] is pd.NA
    assert line.true_detection_all_percent == 0.0


def test_order_of_appearance_whatever_the_order_of_shards():
    names = [("b", "y"), ("b", "x"), ("a", "x"), ("a", "y")]
    summary = summarize(rows_of(*({"scenario": s, "detector": d} | FOUND for s, d in names)))
    assert list(zip(summary["scenario"], summary["detector"], strict=True)) == [
        ("b", "y"),
        ("b", "x"),
        ("a", "y"),
        ("a", "x"),
    ]


@pytest.mark.parametrize("kind", ["float", "object"])
def test_all_null_columns_of_any_kind(kind):
    rows = rows_of(NOTHING, NOTHING)
    empty = pd.Series([None, None], dtype=kind)
    line = only(
        rows.assign(detection_time_s=empty, normalized_detection_time=empty, margin_healthy=empty, missed=empty)
    )
    assert (line.detections, line.missed) == (0, 0)
    assert line.normalized_detection_time_max is pd.NA


def test_empty_table_and_documented_columns():
    summary = summarize(rows_of())
    assert list(summary.columns) == SUMMARY.names
    assert summary.empty
    assert all(field.metadata[b"about"] for field in SUMMARY)


def test_true_detection_needs_all_three():
    spoilt = [FOUND | change for change in ({}, {"classified": False}, {"missed": True}, {"false_alarm": True})]
    assert true_detection(rows_of(*spoilt)).tolist() == [True, False, False, False]
