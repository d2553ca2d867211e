"""The sentences at the top of the page: what they count, what they pool, and that the dangerous event is first."""

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.clustered import korn_graubard
from fddbench.reporting.headlines import findings, flown_sentence


def said(rows, **more):
    return dict(findings(rows, summarize_alarms(rows), **more))


def test_scenarios_of_one_run_are_pooled_by_run(make_rows):
    rows = make_rows(("jam_a", "jam_b", "nrz_b"), ("voting_monitor",), 20)
    found = said(rows)
    assert next(iter(found)) == "Healthy sites declared"
    ends = korn_graubard([2] * 20, range(20), trials=3)
    text = f"({100 * ends.share:.1f} %; {100 * ends.low:.1f} … {100 * ends.high:.1f}; pools 3 scenarios)"
    assert found["Healthy sites declared"] == [f"voting_monitor 40 of 60 decided faulty flights {text}"]


def test_false_alarms_are_those_of_distinct_flights(make_rows):
    rows = make_rows(("jam_a", "jam_b", "healthy"), ("d",), 10)
    (text,) = said(rows)["False alarms"]
    assert text.startswith("d in 0 of 10 distinct flights (0 %; 0 … 30.8), 0.167 healthy hours")


def test_no_share_where_nothing_is_decided_and_undecided_ones_beside_it(make_rows):
    rows = make_rows(("jam_a",), ("d",), 4)
    rows["outcome"] = ["undecided"] * 4
    assert said(rows)["Right: found in time"] == ["d none of 4 faulty flights decided, 4 more undecided"]
    rows["outcome"] = ["right"] * 3 + ["undecided"]
    assert said(rows)["Right: found in time"][0].endswith(
        "of 3 decided faulty flights (100 %; 29.2 … 100), 1 more undecided"
    )


def test_what_was_tuned_here_is_marked_and_an_empty_table_says_so(make_rows):
    rows = make_rows(("jam_a",), ("d",), 4)
    assert said(rows, in_sample=["d"])["Right: found in time"][0].startswith("d (in sample) ")
    assert flown_sentence(make_rows((), (), 0)) == "No flight: the table of results is empty."
