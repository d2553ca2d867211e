"""Cumulative incidence: counts of all flights, competing outcomes stay in n, and the bands are those of shares by run."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.metrics.clustered import korn_graubard
from fddbench.metrics.incidence import MOST_TIMES, incidence

FLIGHT = st.tuples(
    st.sampled_from(["right", "late", "wrong_site", "missed", "undecided", "false_alarm"]),
    st.integers(0, 40), st.integers(0, 40), st.integers(41, 60), st.integers(0, 4),
)  # fmt: skip


def of(flights, **more):
    outcome, found, wrong, seen, run = (np.array(column) for column in zip(*flights, strict=True))
    return incidence(
        outcome.astype(object), found_s=np.where(np.isin(outcome, ["right", "late", "wrong_site"]), found / 10.0, np.nan),
        wrong_s=np.where(outcome == "wrong_site", wrong / 10.0, np.nan), seen_s=seen / 10.0, run=run, **more,
    )  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(st.lists(FLIGHT, min_size=1, max_size=30))
def test_curves_count_every_flight_and_never_fall(flights):
    own = of(flights)
    outcome = np.array([flight[0] for flight in flights])
    found = np.array([flight[1] / 10.0 for flight in flights])
    wrong = np.array([flight[2] / 10.0 for flight in flights])
    for i, t in enumerate(own.time_s):
        assert own.found[i] == np.sum(np.isin(outcome, ["right", "late"]) & (found <= t))
        assert own.wrong[i] == np.sum((outcome == "wrong_site") & (wrong <= t))
    assert np.all(np.diff(own.time_s) > 0)
    assert own.alarmed == np.sum(outcome == "false_alarm")
    if len(own.time_s):
        assert own.found[-1] + own.wrong[-1] + own.alarmed <= own.flights == len(flights)


@settings(max_examples=30, deadline=None)
@given(st.lists(FLIGHT, min_size=2, max_size=30))
def test_bands_are_intervals_of_shares_by_run(flights):
    own = of(flights)
    runs = [flight[4] for flight in flights]
    found = np.array([flight[1] / 10.0 if flight[0] in ("right", "late") else np.inf for flight in flights])
    for i, t in enumerate(own.time_s):
        pooled = korn_graubard(found <= t, runs)
        ends = [np.nan if end is None else end for end in (pooled.low, pooled.high)]
        np.testing.assert_allclose([own.low[i], own.high[i]], ends)


def test_a_wrong_verdict_stays_in_n_and_an_open_flight_ends_the_curve():
    flights = [("right", 1, 0, 50, 0), ("wrong_site", 9, 2, 50, 1), ("undecided", 0, 0, 45, 2), ("missed", 0, 0, 60, 3)]
    own = of(flights)
    assert own.end_s == 4.5
    assert own.found[-1] / own.flights == 0.25  # Kaplan and Meier would say 1/3 with the wrong one censored
    assert of(flights[:2]).end_s == 5.0


def test_few_times_are_kept_and_the_last_is_among_them():
    own = of([("right", i, 0, 60, i) for i in range(1, 40)])
    assert len(own.time_s) == MOST_TIMES
    assert (own.time_s[-1], own.found[-1]) == (3.9, 39)


@pytest.mark.parametrize("run", [0, 7])
def test_a_single_run_has_no_band(run):
    own = of([("right", 1, 0, 50, run)] * 3)
    assert np.isnan(own.low).all()
    assert np.isnan(own.high).all()
