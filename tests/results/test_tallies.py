"""Tallies: sums of parts are the tally of the whole, whatever the parts, and each line names a flight that is in it."""

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fddbench
from fddbench.results.tallies import TALLIES, added, tally


@pytest.fixture(scope="module")
def rows(flown):
    return pa.Table.from_pandas(fddbench.load(flown).drop(columns="case"), preserve_index=False)


@given(parts=st.lists(st.integers(0, 3), min_size=12, max_size=12), order=st.permutations(range(4)))
@settings(max_examples=40)
def test_parts_add_up_to_the_whole_in_any_order(rows, parts, order):
    pieces = [rows.filter(pa.array(np.array(parts) == k)) for k in order]
    assert added([tally(piece) for piece in pieces]).equals(tally(rows))


def test_every_row_is_counted_once_and_its_line_names_a_flight_of_it(rows):
    found = tally(rows)
    assert found.schema.equals(TALLIES)
    assert pc.sum(found["rows"]).as_py() == len(rows)
    for line in found.to_pylist():
        same = [
            row
            for row in rows.to_pylist()
            if all(row[name] == line[name] for name in ("scenario", "detector", "outcome", "detection_time_s"))
        ]
        assert line["rows"] == len(same)
        assert line["example_run"] == min(row["run"] for row in same)


def test_times_are_summed_as_whole_microseconds(rows):
    healthy = [line for line in tally(rows).to_pylist() if line["scenario"] == "healthy"]
    assert sum(line["healthy_us"] for line in healthy) == 6 * 1_000_000
    assert sum(line["healthy_us2"] for line in healthy) == 6 * 1_000_000**2


def test_nothing_adds_up_to_nothing():
    assert added([]).equals(TALLIES.empty_table())
