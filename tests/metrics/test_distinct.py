"""Distinct flights against a dictionary filled row by row."""

import time

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.errors import FddbenchError
from fddbench.metrics.distinct import NEEDS, distinct_flights

rows_of_tables = st.lists(
    st.fixed_dictionaries(
        {
            "point": st.integers(0, 1),
            "run": st.integers(0, 2),
            "manoeuvre": st.sampled_from(["level", "turn"]),
            "detector": st.sampled_from(["a", "b"]),
            "status": st.sampled_from(["ok", "ok", "ok", "infeasible"]),
            "onset_s": st.sampled_from([None, 0.0, 5.0, 10.0, 40.0]),
            "flight_s": st.sampled_from([0.0, 10.0, 20.0]),
            "alarms": st.booleans(),
        }
    ),
    max_size=25,
)


def _table(rows):
    """A flight alarms at 3 s or not at all, whichever row of it shows so much."""
    for row in rows:
        end = min(row["flight_s"], np.inf if row["onset_s"] is None else row["onset_s"])
        row["false_alarm_time_s"] = 3.0 if row["alarms"] and end >= 3.0 else None
    return {name: [row[name] for row in rows] for name in NEEDS}


def _one_by_one(table):
    best = {}
    for i in range(len(table["run"])):
        row = {name: table[name][i] for name in NEEDS}
        if row["status"] != "ok":
            continue
        stretch = row["flight_s"] if row["onset_s"] is None else min(row["onset_s"], row["flight_s"])
        alarm = row["false_alarm_time_s"]
        if stretch == 0.0 and alarm is None:
            continue
        key = tuple(row[name] for name in ("point", "run", "manoeuvre", "detector"))
        if key not in best or stretch > best[key][1]:
            best[key] = (i, stretch, alarm is not None, stretch if alarm is None else alarm)
    return list(best.values())


@given(rows_of_tables)
def test_each_flight_stands_once_with_its_longest_healthy_stretch(rows):
    table = _table(rows)
    flights, expected = distinct_flights(table), _one_by_one(table)
    assert flights.row.tolist() == [i for i, *_ in expected]
    assert flights.alarm.tolist() == [alarm for *_, alarm, _ in expected]
    assert flights.time_s.tolist() == [time_s for *_, time_s in expected]
    assert flights.run.tolist() == [table["run"][i] for i, *_ in expected]


@given(rows_of_tables)
def test_frames_of_any_make_say_what_plain_lists_say(rows):
    table = _table(rows)
    plain = distinct_flights(table)
    frame = pd.DataFrame(table).astype({"onset_s": float, "false_alarm_time_s": float})
    arrow = frame.convert_dtypes(dtype_backend="pyarrow")
    arrow.index = arrow.index[::-1]
    for other in (distinct_flights(frame), distinct_flights(arrow)):
        np.testing.assert_array_equal(other.row, plain.row)
        np.testing.assert_array_equal(other.time_s, plain.time_s)
        np.testing.assert_array_equal(other.alarm, plain.alarm)


def test_scenarios_of_one_flight_count_once():
    """Twenty aircraft alarm at 1 s; a scenario with a fault at 10 s and one without are the same twenty flights."""
    runs = np.tile(np.arange(20), 2)
    table = {
        "point": np.zeros(40),
        "run": runs,
        "manoeuvre": ["level"] * 40,
        "detector": ["a"] * 40,
        "status": ["ok"] * 40,
        "onset_s": [10.0] * 20 + [None] * 20,
        "flight_s": [20.0] * 40,
        "false_alarm_time_s": [1.0] * 40,
    }
    flights = distinct_flights(table)
    assert flights.row.tolist() == list(range(20, 40))
    assert flights.time_s.sum() == 20.0


def test_a_million_rows_take_seconds_not_minutes():
    n = 1_000_000
    rng = np.random.default_rng(1)
    frame = pd.DataFrame(
        {
            "point": rng.integers(0, 10, n),
            "run": rng.integers(0, 1000, n),
            "manoeuvre": np.array(["level", "turn"])[rng.integers(0, 2, n)],
            "detector": np.array(["a", "b", "c"])[rng.integers(0, 3, n)],
            "status": "ok",
            "onset_s": np.where(rng.random(n) < 0.2, np.nan, 10.0),
            "flight_s": 20.0,
            "false_alarm_time_s": np.nan,
        }
    )
    start = time.process_time()
    flights = distinct_flights(frame)
    assert time.process_time() - start < 20.0  # about one second on an idle machine
    assert len(flights.row) == 60_000
    np.testing.assert_array_equal(np.unique(flights.time_s), [10.0, 20.0])


def test_missing_columns_and_lengths_are_said():
    with pytest.raises(FddbenchError, match="these are missing: point, run"):
        distinct_flights({name: [] for name in NEEDS[2:]})
    table = _table([])
    assert len(distinct_flights(table).row) == 0
    row = {name: [0] for name in NEEDS} | {"status": ["ok"], "flight_s": [None]}
    with pytest.raises(FddbenchError, match="need flight_s in every row with status ok"):
        distinct_flights(row)
