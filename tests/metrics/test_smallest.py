"""Law: the smallest size found in 90 % of flights, against thresholds that are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.metrics.clustered import korn_graubard
from fddbench.metrics.smallest import ABOUT, ABOVE, AT_MOST, LEAST, smallest_found

seeds = st.integers(0, 2**32 - 1)


def drawn(seed, n=200, width=0.05, middle=0.4):
    rng = np.random.default_rng(seed)
    size = rng.uniform(0.0, 1.0, n)
    return size, rng.random(n) < 1.0 / (1.0 + np.exp(-(size - middle) / width))


@settings(max_examples=25)
@given(seeds, st.floats(0.05, 0.6), st.integers(LEAST, 400))
def test_a_sharp_threshold_is_met_from_above_to_a_few_flights(seed, threshold, n):
    size = np.random.default_rng(seed).uniform(0.0, 1.0, n)
    answer = smallest_found(size, size > threshold, np.arange(n))
    larger = np.sort(size[size > threshold])
    if len(larger) < 9:
        assert answer.relation == ABOVE
    elif answer.relation == ABOUT and len(larger) > 14:
        assert np.sort(size)[max(np.sum(size <= threshold) - 4, 0)] <= answer.size <= larger[8]
        assert answer.share.share >= 0.9


@settings(max_examples=25)
@given(seeds, st.integers(LEAST, 150), st.sampled_from([0.25, 3.0, 1024.0]))
def test_order_company_and_unit_change_nothing(seed, n, unit):
    size, found = drawn(seed, n)
    order = np.random.default_rng(seed + 1).permutation(n)
    one = smallest_found(size, found, np.arange(n))
    other = smallest_found(unit * size[order], found[order], np.arange(n)[order])
    assert (one.relation, one.flights, one.found, one.share) == (
        other.relation,
        other.flights,
        other.found,
        other.share,
    )
    assert other.size == pytest.approx(unit * one.size)


@settings(max_examples=25)
@given(seeds, st.integers(LEAST, 150))
def test_a_detector_that_finds_more_never_needs_larger_faults(seed, n):
    size, found = drawn(seed, n)
    more = found | (np.random.default_rng(seed + 1).random(n) < 0.3)
    one, better = (smallest_found(size, each, np.arange(n)) for each in (found, more))
    rank = (AT_MOST, ABOUT, ABOVE)
    assert rank.index(better.relation) <= rank.index(one.relation)
    assert better.relation == ABOVE or one.relation == ABOVE or better.size <= one.size


@settings(max_examples=25)
@given(seeds, st.integers(LEAST, 120))
def test_the_share_of_all_as_large_is_what_the_monotone_estimate_says(seed, n):
    """Isotonic regression by its min-max formula; the decisive group is the last in which it reaches the share."""
    size, found = drawn(seed, n, width=0.15)
    answer = smallest_found(size, found, np.arange(n))
    ranked = found[np.argsort(-size)]
    starts = [0, *range(10, n, 4)]
    cuts = [*starts, n]
    means = [
        min(
            max(ranked[cuts[a] : cuts[b + 1]].mean() for b in range(g, len(starts))) for a in range(g + 1)
        )
        for g in range(len(starts))
    ]  # fmt: skip
    enough = sum(mean >= 0.9 - 1e-12 for mean in means)
    assert answer.relation == {0: ABOVE, len(starts): AT_MOST}.get(enough, ABOUT)
    last = cuts[max(enough, 1)]
    assert answer.share == korn_graubard(ranked[:last], np.arange(last))
    assert answer.size == np.median(-np.sort(-size)[cuts[max(enough, 1) - 1] : last])


def test_beyond_the_sizes_flown_it_says_so():
    size = np.linspace(1.0, 2.0, 60)
    run = np.arange(60)
    assert smallest_found(size, size > 0.0, run).relation == AT_MOST
    nothing = smallest_found(size, size > 5.0, run)
    assert (nothing.relation, nothing.share.share, nothing.found) == (ABOVE, 0.0, 0)
    few = smallest_found(size[: LEAST - 1], size[: LEAST - 1] > 0.0, run[: LEAST - 1])
    assert (few.relation, few.size, few.share, few.flights, few.found) == (None, None, None, LEAST - 1, LEAST - 1)


def test_swept_sizes_stay_together():
    size = np.repeat([1.0, 2.0, 3.0, 4.0], 12)
    found = size > 2.5
    found[0] = True
    answer = smallest_found(size, found, np.arange(48))
    assert (answer.size, answer.share.hits, answer.share.trials) == (3.0, 24, 24)


def test_flights_of_one_run_are_one_witness():
    size, found = drawn(3, 120)
    alone, together = (smallest_found(size, found, run) for run in (np.arange(120), np.arange(120) // 8))
    assert alone.size == together.size
    assert together.share.high - together.share.low > alone.share.high - alone.share.low


@pytest.mark.parametrize(("n", "bias"), [(60, 0.04), (200, 0.02)])
def test_the_promised_bias(n, bias):
    """A share that rises over a tenth of the range: 90 % are found at 0.4 + 0.05 log 9."""
    found = [smallest_found(*drawn(seed, n), np.arange(n)).size for seed in range(150)]
    assert np.median(found) == pytest.approx(0.4 + 0.05 * np.log(9.0), abs=bias)
