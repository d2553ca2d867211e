"""Bets on bounded numbers: no capital is expected where the hypothesis holds, whatever the numbers are."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.metrics.anytime import bets, edge, first_crossing, log_capital, numbers_needed
from fddbench.metrics.evidence import Rate, Share, aircraft_needed, ends, known_at

INSIDE = st.floats(0.001, 0.999)


@given(st.lists(st.tuples(INSIDE, INSIDE, INSIDE), min_size=1, max_size=5), INSIDE)
@settings(max_examples=60)
def test_no_capital_is_expected_of_any_two_points(steps, mean):
    """Each number is one of two of mean `mean` or less, other ones in every step."""
    gains, chances = [], []
    for low, high, less in steps:
        a, b = mean * low, mean + (1.0 - mean) * high  # the two points, on either side of the mean
        p = less * (mean - a) / (b - a)  # of the upper one: at most what gives the mean
        gains.append(((a - mean) / mean, (b - mean) / mean))
        chances.append((1.0 - p, p))
    expected = sum(
        np.prod([chances[i][k] for i, k in enumerate(way)])
        * np.exp(log_capital(np.array([gains[i][k] for i, k in enumerate(way)]), bets(mean))[-1])
        for way in product((0, 1), repeat=len(steps))
    )
    assert expected <= 1.0 + 1e-9


@given(st.floats(0.0001, 0.9999))
def test_bets_are_shares_of_the_capital(mean):
    assert np.all((bets(mean) > 0.0) & (bets(mean) < 1.0))


@given(
    st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(0, 9)), min_size=2, max_size=6),
    st.lists(st.floats(0.01, 1.0), min_size=6, max_size=6),
    st.booleans(),
)
def test_gains_of_a_share_are_none_at_its_own_value(counts, weights, more):
    """Of any distribution over (hits, decided, neither): at the ratio of its means the gain is none on average."""
    hits, others, neither = np.array(counts, dtype=float).T
    decided, rows = hits + others, int((hits + others + neither).max()) or 1
    chance = np.array(weights[: len(counts)]) / sum(weights[: len(counts)])
    if not 0.0 < chance @ hits < chance @ decided:
        return
    limit = (chance @ hits) / (chance @ decided)
    gains = Share(hits=hits, decided=decided, failed=np.zeros(len(hits)), rows=rows).gains(limit, more=more)
    assert gains.min() >= -1.0 - 1e-12
    assert chance @ gains == pytest.approx(0.0, abs=1e-9)


@given(
    st.lists(st.tuples(st.integers(0, 4), st.floats(0.0, 1.0)), min_size=2, max_size=6),
    st.lists(st.floats(0.01, 1.0), min_size=6, max_size=6),
    st.booleans(),
)
def test_gains_of_a_rate_are_none_at_its_own_value(counts, weights, more):
    alarms, hours = np.array(counts, dtype=float).T
    chance = np.array(weights[: len(counts)]) / sum(weights[: len(counts)])
    if chance @ alarms <= 0.0 or chance @ hours <= 1e-6:
        return
    limit, none = (chance @ alarms) / (chance @ hours), np.zeros(len(alarms))
    of = Rate(alarms=alarms, hours=hours, failed=none, failed_hours=none, flights=4, most_hours=1.0)
    gains = of.gains(limit, more=more)
    assert gains.min() >= -1.0 - 1e-9
    assert chance @ gains == pytest.approx(0.0, abs=1e-9 * max(1.0, limit))


def nine(hits, failed=0.0):
    hits = np.asarray(hits, dtype=float)
    return Share(hits=hits, decided=np.full(len(hits), 9.0), failed=np.full(len(hits), failed), rows=9)


@given(st.lists(st.integers(0, 9), min_size=1, max_size=80), st.sampled_from([0.5, 0.9, 0.98]), st.booleans())
def test_what_is_known_stays_known_and_the_interval_says_the_same(hits, limit, more):
    known = [known_at(nine(hits[:n]), limit, 0.95, more=more) for n in range(1, len(hits) + 1)]
    first = next((at for at in known if at is not None), None)
    assert all(at == first for at in known[(first or len(known)) - 1 :])
    low, high = ends(nine(hits), limit, 0.95)
    assert (low >= limit - 1e-8 if more else high <= limit + 1e-8) == (first is not None)


def test_what_failed_counts_against_either_side():
    whole, some = nine([9] * 60), nine([8] * 60, failed=1.0)
    some = Share(hits=some.hits, decided=some.hits, failed=some.failed, rows=9)
    assert known_at(whole, 0.9, 0.95, more=True)
    assert known_at(some, 0.9, 0.95, more=True) is None
    assert known_at(some, 0.9, 0.95, more=False) is None


@pytest.mark.parametrize("right", [9, 8, 5])
def test_what_a_decision_takes_is_what_it_took(right):
    """Aircraft that are all alike: a forecast from ten of them is the number after which it was known."""
    side = right == 9
    at = known_at(nine([right] * 500), 0.95, 0.95, more=side)
    assert at is not None
    assert aircraft_needed(nine([right] * 10), 0.95, 0.95) == at


def test_nothing_is_known_of_nothing_and_on_the_limit_never():
    assert first_crossing(np.array([]), bets(0.98), 0.95) is None
    assert numbers_needed(np.array([]), bets(0.98), 0.95) is None
    assert numbers_needed(np.array([0.1, -0.1] * 50), bets(0.98), 0.95) is None
    assert ends(nine([]), 0.98, 0.95) == (0.0, 1.0)


def test_an_edge_is_found():
    assert edge(lambda at: at <= 0.7) == pytest.approx(0.7, abs=1e-8)
    assert edge(lambda at: False) == 0.0


def test_no_alarm_bounds_a_rate_as_the_exposure_does():
    """100 aircraft of an hour without an alarm: the exact one-sided bound is 0.03 per hour, at any look it is wider."""
    none = np.zeros(100)
    of = Rate(alarms=none, hours=none + 1.0, failed=none, failed_hours=none, flights=1, most_hours=1.0)
    low, high = ends(of, 0.1, 0.95)
    assert low == 0.0
    assert 0.03 < high < 0.06
    assert known_at(of, 0.1, 0.95, more=False) is not None


@pytest.mark.slow
def test_false_passes_and_power_as_promised():
    """Nine scenarios, rho 0.05 and 0.5, on the limit at most 5 % pass at any of 1500 looks; 99 % against 98 %: 90 % pass."""
    from tests.bench.requirements import CASES, rates, shares

    rng, n = np.random.default_rng(4), 1500
    for scenarios, rho, how in CASES:
        given = {"scenarios": scenarios, "rho": rho, "how": how}
        false = np.mean(np.isfinite(list(shares(rng, n, truth=0.98, **given))))
        failed = np.mean(np.isfinite(list(shares(rng, n, truth=0.98, more=False, **given))))
        passed = np.mean(np.isfinite(list(shares(rng, n, truth=0.99, **given))))
        assert max(false, failed) <= 0.05
        assert passed >= (0.89 if scenarios == 9 else 0.7)
    for how in ("constant", "at once", "half", "alike"):
        for limit in (1.0, 20.0):
            for more in (False, True):
                found = list(rates(rng, n, per_hour=limit, limit=limit, how=how, more=more))
                assert np.mean(np.isfinite(found)) <= 0.065  # at most 5 %, and the chance of 1500
