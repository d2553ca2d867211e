"""What goes with failure: parts hold every flight once, chance is 0, and what decides is 1."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.metrics.association import associations, cramers_v, parted

COUNTS = st.lists(st.tuples(st.integers(0, 30), st.integers(0, 30)), min_size=1, max_size=6)


@given(st.lists(st.none() | st.floats(-1e6, 1e6), min_size=1, max_size=60))
def test_parts_hold_every_known_value_between_their_ends(values):
    numbers = np.array([np.nan if v is None else v for v in values])
    own = parted(numbers)
    known = ~np.isnan(numbers)
    if own is None:
        assert len(np.unique(numbers[known])) < 2
        return
    assert np.array_equal(own.place >= 0, known)
    assert np.all(own.low[own.place[known]] <= numbers[known])
    assert np.all(numbers[known] <= own.high[own.place[known]])
    assert len(own.low) <= 6


@given(COUNTS)
def test_association_lies_between_chance_and_certainty(counts):
    n = np.array([a + b for a, b in counts])
    k = np.array([a for a, _ in counts])
    assert 0.0 <= cramers_v(k, n) <= 1.0
    assert cramers_v(k, n) == pytest.approx(cramers_v(n - k, n))


def test_what_decides_ranks_first_and_chance_is_left_out():
    rng = np.random.default_rng(5)
    gust, mass = np.repeat([0.0, 1.0, 2.0, 3.0], 25), rng.random(100)
    failed = gust > 0.0
    found = associations({"mass": parted(mass), "gust": parted(gust)}, failed, np.arange(100))
    assert found[0].name == "gust"
    assert found[0].v > 0.98
    assert (found[0].failed.tolist(), found[0].flights.tolist()) == ([0, 25, 25, 25], [25] * 4)
    assert np.all(found[0].low <= found[0].failed / found[0].flights)
    assert np.all(found[0].high >= found[0].failed / found[0].flights)
    even = np.arange(100) % 2 == 0
    assert associations({"gust": parted(gust)}, np.concatenate([even[:50], even[:50]]), np.arange(100)) == []


def test_where_all_or_none_fail_nothing_goes_with_it():
    parts = {"a": parted(np.arange(8.0))}
    for failed in (np.zeros(8, dtype=bool), np.ones(8, dtype=bool)):
        assert associations(parts, failed, np.arange(8)) == []
