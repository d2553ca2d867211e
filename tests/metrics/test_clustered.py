"""Pooled shares: the printed table, what they fall back to, and how often they hold the truth."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import betabinom, binom

from fddbench.errors import FddbenchError
from fddbench.metrics.clustered import counts_by_run, korn_graubard, pooled_intervals
from fddbench.metrics.intervals import beta_interval, clopper_pearson

NINE = [9] * 25


def _ends(pooled, digits=4):
    return None if pooled.low is None else (round(pooled.low, digits), round(pooled.high, digits))


@pytest.mark.parametrize(
    ("hits", "trials", "expected"),
    [(0, 200, (0.0, 0.0183)), (3, 200, (0.0031, 0.0432)), (98, 100, (0.9296, 0.9976))],
)
def test_exact_share(hits, trials, expected):
    assert tuple(round(float(end), 4) for end in clopper_pearson(hits, trials)) == expected


@pytest.mark.parametrize(
    ("hits", "rows", "share", "effective", "interval"),
    [
        ([9, 5, 1] + [0] * 22, NINE, 0.0667, 30.857, (0.0074, 0.2279)),
        ([0] * 25, NINE, 0.0, 25.0, (0.0, 0.1494)),
        ([9] * 25, NINE, 1.0, 25.0, (0.8506, 1.0)),
        ([9] + [0] * 24, NINE, 0.04, 24.0, (0.0006, 0.2211)),
        ([1] * 25, NINE, 0.1111, 225.0, (0.0716, 0.1623)),
        ([3, 0, 9, 2], [9, 9, 9, 5], 0.4375, 4.495, (0.0049, 0.9839)),
    ],
)
def test_pooled_share(hits, rows, share, effective, interval):
    pooled = korn_graubard(hits, np.arange(len(hits)), trials=rows)
    assert (round(pooled.share, 4), round(pooled.effective_trials, 3)) == (share, effective)
    assert _ends(pooled) == interval


def _rows(hits, trials, seed=0):
    """The same counts as one entry a row, shuffled: (hits, runs)."""
    runs = np.repeat(np.arange(len(hits)), trials)
    hit = np.concatenate([np.arange(n) < y for y, n in zip(hits, trials, strict=True)])
    order = np.random.default_rng(seed).permutation(len(runs))
    return hit[order], runs[order]


@given(
    st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)).map(sorted), min_size=1, max_size=30), st.integers(0, 9)
)
def test_rows_in_any_order_and_sums_say_the_same(counts, seed):
    hits, trials = zip(*counts, strict=True)
    by_row = korn_graubard(*_rows(hits, trials, seed))
    by_run = korn_graubard(hits, [f"run {g}" for g in range(len(hits))], trials=trials)
    assert (by_row.hits, by_row.trials, by_row.runs) == (by_run.hits, by_run.trials, by_run.runs)
    assert _ends(by_row, 12) == _ends(by_run, 12)


@given(st.integers(2, 300), st.data())
def test_one_row_in_every_run_is_the_exact_share(trials, data):
    hits = data.draw(st.integers(0, trials))
    pooled = korn_graubard(np.arange(trials) < hits, np.arange(trials))
    np.testing.assert_allclose((pooled.low, pooled.high), clopper_pearson(hits, trials), rtol=1e-12)


@given(st.lists(st.integers(0, 9), min_size=2, max_size=40))
def test_misses_mirror_hits_and_the_share_is_inside(hits):
    runs, nine = np.arange(len(hits)), [9] * len(hits)
    pooled, mirrored = (korn_graubard(y, runs, trials=nine) for y in (np.array(hits), 9 - np.array(hits)))
    np.testing.assert_allclose((pooled.low, pooled.high), (1 - mirrored.high, 1 - mirrored.low), atol=1e-9)
    assert 0 <= pooled.low <= pooled.share <= pooled.high <= 1


@given(st.lists(st.integers(0, 1), min_size=4, max_size=40), st.integers(2, 9))
def test_rows_that_repeat_their_run_add_nothing(hits, copies):
    """Copies of a row only bring in the quantile of more rows, never more aircraft."""
    runs = np.arange(len(hits))
    pooled = korn_graubard(np.repeat(hits, copies), np.repeat(runs, copies))
    assert pooled.effective_trials <= len(hits) + 1e-9


def test_one_run_has_no_interval_and_no_row_no_share():
    one = korn_graubard([1, 0, 1], [7, 7, 7])
    assert (one.share, one.low, one.high, one.runs) == (2 / 3, None, None, 1)
    none = korn_graubard([], [])
    assert (none.share, none.trials, none.runs, none.low) == (None, 0, 0, None)
    assert korn_graubard([0, 1], [1, 2], trials=[0, 2]).runs == 1  # a run without a decided row is none


def test_two_runs_that_differ_say_next_to_nothing():
    low, high = _ends(korn_graubard([9, 0], [0, 1], trials=9))
    assert low < 0.001
    assert high > 0.999


def test_real_numbers_below_one_have_an_interval():
    """x* of n* is seldom whole, and less than one trial is left of two runs."""
    assert beta_interval(0.5, 10.0)[0] < beta_interval(1.0, 10.0)[0]
    low, high = beta_interval(0.05, 0.08)
    assert 0.0 < low < 0.05 / 0.08 < high <= 1.0


@pytest.mark.parametrize(
    ("hits", "runs", "trials", "message"),
    [
        ([1, 2], [0, 1], None, "0 <= hits <= trials"),
        ([1, -1], [0, 1], 3, "0 <= hits <= trials"),
        ([1, float("nan")], [0, 1], 3, "0 <= hits <= trials"),
        ([1, 1], [0, 1, 2], None, r"one entry a row in each, got the shapes \{'runs': \(3,\), 'hits': \(2,\)"),
        ([1, 1], [0, None], None, "need a run for every row, 1 of 2 have none"),
    ],
)
def test_impossible_rows_are_refused(hits, runs, trials, message):
    with pytest.raises(FddbenchError, match=message):
        korn_graubard(hits, runs, trials=trials)


# --- coverage: 25 aircraft, nine scenarios each, every row with the same probability; rho is the correlation of two rows
# of one aircraft (1: all nine fail together). The share of campaigns whose interval holds the truth, at least 95 %.

RUNS, ROWS, CAMPAIGNS = 25, 9, 2000


def _campaigns(share, rho, rng):
    """Hits of each run, (CAMPAIGNS, RUNS)."""
    if rho == 1.0:
        return ROWS * rng.binomial(1, share, (CAMPAIGNS, RUNS))
    if rho == 0.0:
        return rng.binomial(ROWS, share, (CAMPAIGNS, RUNS))
    size = (1.0 - rho) / rho
    return rng.binomial(ROWS, rng.beta(size * share, size * (1.0 - share), (CAMPAIGNS, RUNS)))


def _covered(share, rho):
    rng = np.random.default_rng([8, round(1000 * share), round(10 * rho)])
    campaigns, times = np.unique(np.sort(_campaigns(share, rho, rng), axis=1), axis=0, return_counts=True)
    inside = [
        pooled.low <= share <= pooled.high
        for pooled in (korn_graubard(hits, np.arange(RUNS), trials=ROWS) for hits in campaigns)
    ]
    return times[inside].sum() / CAMPAIGNS


@pytest.mark.parametrize("rho", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("share", [0.005, 0.02, 0.2])
def test_pooled_interval_holds_the_truth_as_often_as_promised(share, rho):
    # three standard errors of 2000 campaigns are 1.5 %
    assert _covered(share, rho) > 0.95 - 0.015


@pytest.mark.parametrize(("level", "aircraft"), [(-4.0, 2.0), (0.0, 1.0), (3.0, 2.0)])
def test_nine_scenarios_of_different_difficulty_and_aircraft_that_differ(level, aircraft):
    """Logit of a row: that of its scenario, from two below the level to two above it, and that of its aircraft."""
    rng = np.random.default_rng([9, round(level + 10)])
    scenarios = level + np.linspace(-2.0, 2.0, ROWS)

    def hits(campaigns, runs):
        logit = scenarios + aircraft * rng.normal(size=(campaigns, runs, 1))
        return rng.random(logit.shape) < 1.0 / (1.0 + np.exp(-logit))

    truth = float(hits(1, 200_000).mean())
    pooled = [korn_graubard(y, np.arange(RUNS), trials=ROWS) for y in hits(CAMPAIGNS, RUNS).sum(axis=2)]
    assert np.mean([one.low <= truth <= one.high for one in pooled]) > 0.95 - 0.015


def test_that_simulation_sees_what_the_plain_interval_gets_wrong():
    """Nine rows that fail together: 225 rows as if independent hold the truth in a third of the campaigns."""
    y = np.arange(RUNS + 1)
    low, high = clopper_pearson(ROWS * y, ROWS * RUNS)
    held = binom.pmf(y, RUNS, 0.02)[(low <= 0.02) & (high >= 0.02)].sum()
    assert held < 0.5
    assert betabinom.pmf(0, ROWS, 0.02, 0.98) > 0.9  # at correlation 0.5 most runs have no hit


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=2, max_size=2), min_size=1, max_size=8)
)
def test_many_shares_at_once_have_the_intervals_of_each(table):
    hits = np.array([[min(k, n) for k, n in row] for row in table], dtype=float)
    trials = np.array([[n for _, n in row] for row in table], dtype=float)
    low, high = pooled_intervals(hits, trials)
    for j in range(2):
        own = korn_graubard(hits[:, j].astype(int), range(len(table)), trials=trials[:, j].astype(int))
        ends = [np.nan if end is None else end for end in (own.low, own.high)]
        np.testing.assert_allclose([low[j], high[j]], ends)


def test_counts_by_run_give_each_place_the_interval_of_its_own_rows():
    rng = np.random.default_rng(3)
    place, hit, run = rng.integers(-1, 3, 80), rng.random(80) < 0.4, rng.integers(0, 9, 80) * 10
    low, high = pooled_intervals(*counts_by_run(place, hit, run, 3))
    for i in range(3):
        own = korn_graubard(hit[place == i], run[place == i])
        np.testing.assert_allclose([low[i], high[i]], [own.low, own.high])
