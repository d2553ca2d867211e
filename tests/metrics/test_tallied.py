"""Summaries of tallies are those of the rows; where rows would have been needed they are wider, never narrower."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.summary import summarize
from fddbench.metrics.tallied import summarize_tallies, tallied_alarms
from fddbench.results.schema import rows_schema
from fddbench.results.tallies import tally

_NOT_COUNTED = ("estimate_bias_median", "estimate_rms_median")
_OUTCOMES = ("right", "late", "missed", "wrong_site", "false_alarm", "undecided")


def _row(run, point, outcome, tenths, status="ok"):
    ok, alarmed = status == "ok", outcome == "false_alarm"
    found = outcome in ("right", "late")
    return {
        "scenario": "jam", "manoeuvre": "cruise", "point": point, "level": 0, "run": run, "detector": "d", "status": status,
        "outcome": outcome if ok else None, "n_faulty": 1, "onset_s": 4.0 if ok else None, "flight_s": 20.0 if ok else None,
        "false_alarm_time_s": tenths / 10 if ok and alarmed else None,
        "detection_time_s": tenths / 10 if ok and found else None,
        "detection_time_limit_s": 2.0 if ok else None,
        "normalized_detection_time": tenths / 20 if ok and found else None,
        "isolated": found if ok else None, "over_declared": outcome == "wrong_site" if ok else None,
        "changes": tenths % 3 if ok else None, "margin_healthy": tenths / 40 if ok else None, "departed_s": None,
    }  # fmt: skip


def _both(lines):
    schema = rows_schema(())
    table = pa.Table.from_pylist([{name: line.get(name) for name in schema.names} for line in lines], schema=schema)
    frame, counted = (each.to_pandas(types_mapper=pd.ArrowDtype) for each in (table, tally(table)))
    return frame, counted


flights = st.lists(
    st.tuples(
        st.sampled_from(_OUTCOMES), st.integers(1, 39), st.sampled_from(["ok", "ok", "ok", "error", "infeasible"])
    ),
    min_size=1,
    max_size=40,
)


@given(flights)
@settings(max_examples=150)
def test_at_one_point_all_columns_are_those_of_the_rows(flights):
    rows, counted = _both([_row(run, 0, *flight) for run, flight in enumerate(flights)])
    for whole, added in (
        (summarize(rows), summarize_tallies(counted)),
        (summarize_alarms(rows), tallied_alarms(counted)),
    ):
        [one], [other] = whole.to_dict("records"), added.to_dict("records")
        for name in set(one) - set(_NOT_COUNTED):
            if name == "runs" and not one["distinct_flights"]:
                continue
            value = one[name]
            wanted = pytest.approx(value, rel=1e-9) if isinstance(value, float) else value
            assert (pd.isna(value) and pd.isna(other[name])) or other[name] == wanted, name


def wider(low, high, one, other):
    if not pd.isna(other[low]):
        assert other[low] <= one[low] * (1 + 1e-9)
        assert other[high] >= one[high] * (1 - 1e-9)


@given(flights, st.integers(2, 4))
@settings(max_examples=80)
def test_over_several_points_counts_are_the_same_and_shares_no_surer(flights, n_points):
    flights = [(outcome, tenths, "ok") for outcome, tenths, _ in flights]
    rows, counted = _both([_row(run, p, *flight) for run, flight in enumerate(flights) for p in range(n_points)])
    [one], [other] = summarize(rows).to_dict("records"), summarize_tallies(counted).to_dict("records")
    for name in (*_OUTCOMES, "decided", "detections", "detection_time_median_s", "distinct_flights", "alarms", "pools"):
        assert one[name] == other[name] or (pd.isna(one[name]) and pd.isna(other[name]))
    wider("false_alarm_low_per_hour", "false_alarm_high_per_hour", one, other)
    if len({flight[0] for flight in flights}) > 1 and not pd.isna(other["right_low_percent"]):
        # rows of a run that all agree tell as much as one
        wider("right_low_percent", "right_high_percent", one, other)


def test_quantiles_are_observed_values():
    rows, counted = _both([_row(run, 0, "right", run + 1) for run in range(20)])
    [line] = summarize_tallies(counted).to_dict("records")
    times = rows["detection_time_s"].to_numpy(dtype=float)
    for name, share in (("median", 0.5), ("p95", 0.95), ("max", 1.0)):
        assert line[f"detection_time_{name}_s"] == np.quantile(times, share, method="inverted_cdf")
