"""Laws of resampling: rows come through untouched, error estimates bound what they estimate, gaps are found."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.benchmarks.recorded.reading import Series
from fddbench.benchmarks.recorded.resampling import largest_gap, on_clock


def series(time_s, values):
    return Series(time_s=np.asarray(time_s, float), values=np.asarray(values, float), skipped=0, place=str)


@settings(max_examples=20, deadline=None)
@given(begin=st.integers(0, 10**6), n=st.integers(2, 300), step=st.sampled_from([0.01, 0.02, 1 / 250]))
def test_rows_on_the_clock_come_through_to_the_last_bit(begin, n, step):
    values = np.random.default_rng(n).normal(size=n)
    own = series(begin * 1e-3 + np.arange(n) * step, values)
    for between in ("previous", "linear"):
        found = on_clock(own, float(own.time_s[0]), n, step, between)
        assert found.values.tobytes() == values.tobytes()
        assert (found.between, found.rms, found.largest, found.unused) == (0, 0.0, 0.0, 0)


def test_what_is_held_and_what_is_straight():
    own = series([0.0, 0.1, 0.3], [1.0, 2.0, 6.0])
    assert on_clock(own, 0.0, 4, 0.1, "previous").values.tolist() == [1.0, 2.0, 2.0, 6.0]
    np.testing.assert_allclose(on_clock(own, 0.0, 4, 0.1, "linear").values, [1.0, 2.0, 4.0, 6.0])
    held = on_clock(own, 0.05, 2, 0.1, "previous")
    assert held.values.tolist() == [1.0, 2.0]
    assert held.between == 2
    assert held.largest == pytest.approx(1.0)


@pytest.mark.parametrize(("between", "within"), [("previous", (0.9, 1.1)), ("linear", (0.7, 1.5))])
def test_the_estimated_error_is_that_of_a_known_signal(between, within):
    time_s = np.arange(0, 10, 0.05)
    own = series(time_s, np.sin(3.0 * time_s))
    found = on_clock(own, 0.0, 900, 0.011, between)
    true = np.sin(3.0 * np.arange(900) * 0.011)
    rms = np.sqrt(np.mean((found.values - true)[np.abs(np.arange(900) * 0.011 / 0.05 % 1) > 1e-9] ** 2))
    assert within[0] < found.rms / rms < 3.0 * within[1]


def test_rows_that_no_sample_shows_are_counted():
    assert on_clock(series(np.arange(0, 1.001, 0.001), np.zeros(1001)), 0.0, 101, 0.01, "previous").unused == 900


def test_the_largest_gap_is_that_of_the_piece_that_is_flown():
    own = series([0.0, 0.1, 0.2, 0.9, 1.0, 1.1, 3.0], np.zeros(7))
    assert largest_gap(own, 0.0, 1.1) == pytest.approx((0.7, 3))
    assert largest_gap(own, 0.95, 1.05)[0] == pytest.approx(0.1)
    assert largest_gap(own, 0.5, 0.8)[0] == pytest.approx(0.7)
    assert largest_gap(own, 1.0, 2.0)[0] == pytest.approx(1.9)
