"""The table at the end of a run: a golden one, its width, what is left to --wide."""

import os
from pathlib import Path

import pandas as pd
import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.summary import summarize
from fddbench.reporting.terminal import to_text

GOLDEN = Path(__file__).parent / "golden"


def text_of(rows, *, wide=False, in_sample=()):
    return to_text(summarize(rows, in_sample=in_sample), summarize_alarms(rows, in_sample=in_sample), wide=wide)


@pytest.mark.parametrize("wide", [False, True])
def test_golden(make_rows, wide):
    """After a deliberate change run ``FDDBENCH_REWRITE=1 pytest tests/reporting/test_terminal.py`` and read the difference."""
    lost = {3: ("infeasible", "stall"), 5: ("error", "ValueError: x")}
    rows = make_rows(("jam_a", "jam_b", "noise_a", "healthy_cruise"), ("sliding_mode", "voting_monitor"), 50, lost)
    text = text_of(rows, wide=wide, in_sample=("voting_monitor",)) + "\n"
    path = GOLDEN / f"{'wide' if wide else 'narrow'}.txt"
    if os.environ.get("FDDBENCH_REWRITE"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    assert text == path.read_text(encoding="utf-8")


@pytest.mark.parametrize("flights", [1, 12, 300])
@pytest.mark.parametrize(
    "names", [("a", "b"), ("a_detector_with_a_very_long_name_indeed", "a_detector_with_a_very_short_name_indeed")]
)
def test_eighty_columns_hold_everything(make_rows, flights, names):
    rows = make_rows(
        ("jam_a", "noise_b", "a_scenario_of_a_healthy_aircraft_in_turn_coordination_2_" * 2), names, flights
    )
    text = text_of(rows)
    assert max(map(len, text.splitlines())) <= 80
    shown = [line.split()[0] for line in text.splitlines() if line.startswith("  ") and line.strip()[0] in "ab"]
    assert len(shown) == 2 * 4
    assert len(set(shown)) == 2
    assert "100 [" in text or flights == 1


def test_what_is_left_out_is_in_the_wide_table(make_rows):
    rows = make_rows(("jam_b", "healthy"), ("sliding_mode", "voting_monitor"), 12)
    narrow, wide = text_of(rows), text_of(rows, wide=True)
    assert "--wide" in narrow
    assert "--wide" not in wide
    for head in ("margin", "bias", "changes", "max/limit"):
        assert head not in narrow
        assert head in wide


def test_what_was_not_flown_is_seen_however_narrow_it_is(make_rows):
    names = ("a_detector_with_a_very_long_name_indeed", "a_detector_with_a_very_short_name_indeed")
    lost = {1: ("error", "ValueError: x")}
    assert "20000/20000" not in text_of(make_rows(("jam_a",), names, 50).pipe(_as_many, 400))
    assert "19600/20000" in text_of(make_rows(("jam_a",), names, 50, lost).pipe(_as_many, 400))


def _as_many(rows, times):
    return pd.concat([rows.assign(run=rows["run"] + 1000 * i) for i in range(times)], ignore_index=True)


def test_healthy_sites_declared_come_first(make_rows):
    head = text_of(make_rows(("jam_b",), ("voting_monitor",), 4)).splitlines()[0]
    assert head.index("wrong") < head.index("right")


def test_nothing_flown_and_no_rows(make_rows):
    lost = dict.fromkeys(range(3), ("infeasible", "stall"))
    text = text_of(make_rows(("jam_a",), ("d",), 3, lost))
    assert "0/3" in text
    assert text_of(make_rows((), (), 0)) == "no rows: nothing was flown"
