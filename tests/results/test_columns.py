"""What each column means can be asked of the package and of the table itself."""

import pytest
from tests.cli.test_commands import TINY

import fddbench
from fddbench.errors import FddbenchError
from fddbench.results.schema import EVENTS, OUTCOMES, SCHEMA_VERSION, STATUSES, rows_schema


def test_every_column_is_documented():
    for table in ("rows", "events", "summary", "alarms"):
        found = fddbench.columns(table)
        assert found
        assert all(found.values()), table
    assert list(fddbench.columns()) == ["case", *rows_schema(()).names]
    assert list(fddbench.columns("events")) == ["case", *EVENTS.names]
    with pytest.raises(FddbenchError, match="no table is called 'row'; known: rows, events, summary, alarms"):
        fddbench.columns("row")


def test_a_loaded_table_says_what_its_columns_mean(tmp_path):
    (tmp_path / "tiny.yaml").write_text(TINY)
    fddbench.run(tmp_path / "tiny.yaml", tmp_path / "out", jobs=1)
    rows, events = fddbench.load(tmp_path / "out"), fddbench.load_events(tmp_path / "out")
    assert rows.attrs["columns"]["outcome"] == fddbench.columns()["outcome"]
    assert rows.attrs["columns"]["p_mass_kg"] == "true value of the parameter"
    assert set(events.attrs["columns"]) == set(events.columns)
    assert fddbench.alarms(tmp_path / "out")["distinct_flights"].tolist() == [1, 1]


def test_the_words_of_version_two():
    assert SCHEMA_VERSION == "2"
    assert "diverged" not in STATUSES
    assert all(name in fddbench.columns()["outcome"] for name in (*OUTCOMES, "quiet"))
    about = rows_schema(()).field("detection_time_s").metadata[b"about"].decode()
    assert about == fddbench.columns()["detection_time_s"]


def test_what_columns_say_is_not_copied_at_every_step(tmp_path):
    """pandas copied 400 texts whenever a column was taken: a seventh of the time of a page."""
    (tmp_path / "tiny.yaml").write_text(TINY)
    fddbench.run(tmp_path / "tiny.yaml", tmp_path / "out", jobs=1)
    rows = fddbench.load(tmp_path / "out")
    assert rows.iloc[:2][["outcome"]].attrs["columns"] is rows.attrs["columns"]
