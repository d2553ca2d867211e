"""Some columns and some rows of a large campaign, by conditions or in SQL: the rows of the whole table, no others."""

import warnings

import numpy as np
import pandas as pd
import pytest
from tests.results.conftest import fly

import fddbench
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError, PartialResultsWarning, ResultsError

CONDITIONS = [
    ([("run", "<", 3)], lambda rows: rows["run"] < 3),
    ([("run", ">=", 4), ("scenario", "=", "jam")], lambda rows: (rows["run"] >= 4) & (rows["scenario"] == "jam")),
    ([("case", "in", ["jam/0/0/5", "healthy/0/0/0"])], lambda rows: rows["case"].isin(["jam/0/0/5", "healthy/0/0/0"])),
    ([("onset_s", "=", None)], lambda rows: rows["onset_s"].isna()),
    ([("onset_s", "!=", None)], lambda rows: rows["onset_s"].notna()),
    ([("onset_s", "not in", [0.3])], lambda rows: rows["onset_s"].notna()),
    ([("run", "in", [])], lambda rows: rows["run"] < 0),
    ([], lambda rows: rows["run"] >= 0),
    (("outcome", "!=", "quiet"), lambda rows: rows["outcome"] != "quiet"),
]


@pytest.mark.parametrize(("filters", "same"), CONDITIONS)
def test_filters_give_the_rows_of_the_whole_table_in_its_order(flown, filters, same):
    rows = fddbench.load(flown)
    expected = rows[same(rows).fillna(False).astype(bool)].reset_index(drop=True)
    pd.testing.assert_frame_equal(fddbench.load(flown, filters=filters), expected, check_exact=True)
    few = fddbench.load(flown, ["case", "p_mass_kg"], filters)
    pd.testing.assert_frame_equal(few, expected[["case", "p_mass_kg"]], check_exact=True)


@pytest.mark.parametrize(
    ("filters", "told"),
    [
        ("run < 3", r"filters are a list of \(column, operator, value\).*got 'run < 3'"),
        ([("runs", "<", 3)], "condition 1: the rows have no column 'runs'. Did you mean 'run'"),
        ([("run", "<", 3), ("run", "~", 3)], "condition 2: no operator '~'; known: =, ==, !="),
        ([("run", "<")], r"condition 1: need \(column, operator, value\)"),
        ([("scenario", "in", "jam")], "scenario in needs a list of values, got 'jam'"),
        ([("run", "<", None)], "null is compared with = and != alone"),
        ([("run", "in", [1, "two"])], r"condition 1: run in \[1, 'two'\] compares with no column"),
        ([("onset_s", "=", float("nan"))], "onset_s = nan: no column holds it; what is not there is None"),
        ([[("run", "=", 1)]], r"condition 1: need \(column, operator, value\)"),
        ({"run": 3}, "filters are a list"),
        ([("run", "=", "three")], r"a value does not compare with its column \(run is int64\)"),
    ],
)
def test_a_filter_that_is_none_is_met_with_words(flown, filters, told):
    with pytest.raises(ResultsError, match=told):
        fddbench.load(flown, filters=filters)


def test_a_column_that_is_none_is_met_with_words(flown):
    with pytest.raises(
        ResultsError, match=r"no column 'cases'. Did you mean 'case'\? And no 'x'. Known: case, scenario"
    ):
        fddbench.load(flown, ["cases", "run", "x"])
    with pytest.raises(ResultsError, match=r"columns are a list of names, \['case'\]; got 'case'"):
        fddbench.load(flown, "case")


def test_all_wrong_conditions_are_told_at_once(flown):
    with pytest.raises(ResultsError, match=r"(?s)condition 1: .*condition 3: "):
        fddbench.load(flown, filters=[("a", "=", 1), ("run", "=", 1), ("run", "is", 1)])


def test_a_data_base_has_the_rows_and_events_of_load(flown):
    pytest.importorskip("duckdb")
    base = fddbench.duckdb(flown)
    for view, loaded in (("rows", fddbench.load(flown)), ("events", fddbench.load_events(flown))):
        found = base.sql(f"SELECT * FROM {view} ORDER BY scenario, point, level, run").df()
        assert list(found.columns) == list(loaded.columns)
        for name in loaded.columns:
            pd.testing.assert_series_equal(
                found[name].astype(object).where(found[name].notna(), None),
                loaded[name].astype(object).where(loaded[name].notna(), None),
                check_dtype=False,
            )


def test_a_data_base_numbers_points_as_the_campaign_of_today(tmp_path):
    pytest.importorskip("duckdb")
    path = tmp_path / "grid.yaml"
    text = (
        "name: grid\nbenchmark: yaw_rate\nseed: 5\nduration_s: 0.5\ndetectors: [voting_monitor]\n"
        "dispersions: {grid: {altitude_ft: [15000, 20000], mass_kg: VALUES}}\n"
        "scenarios: [{name: healthy, manoeuvre: cruise}]\n"
    )
    out = tmp_path / "it's [here]*"
    path.write_text(text.replace("VALUES", "[190000, 210000]"))
    fly(read_campaign(path), out)
    path.write_text(text.replace("VALUES", "[190000, 210000, 220000]"))
    fddbench.extend(out, path, jobs=1, backend="numpy")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loaded = fddbench.load(out, ["case", "point", "p_mass_kg"])
        base = fddbench.duckdb(out)
        found = base.sql('SELECT "case", point, p_mass_kg FROM rows ORDER BY point').df()
    assert loaded["p_mass_kg"].tolist() == [190000, 210000, 220000] * 2
    assert np.array_equal(found.to_numpy(), loaded.to_numpy())


def test_a_data_base_of_a_damaged_or_partial_folder_says_so(out, monkeypatch):
    pytest.importorskip("duckdb")
    list_of_shards = out / "manifest.jsonl"
    list_of_shards.write_bytes(b"".join(list_of_shards.read_bytes().splitlines(keepends=True)[:2]))
    with pytest.warns(PartialResultsWarning, match="partial, it holds 4 of 12 flights"):
        base = fddbench.duckdb(out)
    assert len(base.sql("FROM rows")) == 4
    for path in (out / "rows").glob("*.parquet"):
        path.write_bytes(path.read_bytes() + b"x")
    with pytest.raises(ResultsError, match="is not the file that was written"):
        fddbench.duckdb(out)


def test_without_duckdb_the_cure_is_named(flown, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "duckdb", None)
    with pytest.raises(FddbenchError, match=r"pip install 'fddbench\[sql\]'; or read with fddbench.load"):
        fddbench.duckdb(flown)
