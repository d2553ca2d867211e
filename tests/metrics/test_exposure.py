"""False alarms per hour: the printed table, and what stays without a rate or an interval."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.errors import FddbenchError
from fddbench.metrics.exposure import alarm_rate
from fddbench.metrics.intervals import poisson_rate

THREE = [1.0] * 3 + [60.0] * 7


@pytest.mark.parametrize(
    ("alarms", "time_s", "points", "counts", "effect", "interval", "plain"),
    [
        ([1] * 20, [1.0] * 20, 1, (20, 20.0, 3600.0), 1.0, (2199, 5560), (2199, 5560)),
        ([1] * 3 + [0] * 7, THREE, 1, (3, 423.0, 25.53), 1.5649, (2.89, 94.46), (5.27, 74.62)),
        ([1] * 3 + [0] * 7, THREE, 4, (12, 1692.0, 25.53), 6.2595, (1.92, 107.78), (13.19, 44.60)),
        ([0] * 10, [60.0] * 10, 4, (0, 2400.0, 0.0), 4.0, (0.0, 27.68), (0.0, 5.53)),
    ],
)
def test_printed_rates(alarms, time_s, points, counts, effect, interval, plain):
    runs = np.tile(np.arange(len(alarms)), points)
    rate = alarm_rate(np.tile(alarms, points), np.tile(time_s, points), runs)
    digits = 0 if interval[0] > 1000 else 2
    assert (rate.alarms, round(rate.exposure_h * 3600.0, 6), round(rate.per_hour, 2)) == counts
    assert round(rate.design_effect, 4) == effect
    assert (round(rate.low, digits), round(rate.high, digits)) == interval
    assert tuple(round(float(end), digits) for end in poisson_rate(rate.alarms, rate.exposure_h)) == plain
    assert (rate.runs, rate.flights) == (len(alarms), points * len(alarms))


def test_the_share_of_flights_stands_beside_the_rate():
    rate = alarm_rate([1] * 3 + [0] * 7, THREE, range(10))
    assert (rate.share.hits, rate.share.trials, rate.share.share) == (3, 10, 0.3)
    assert (round(rate.share.low, 4), round(rate.share.high, 4)) == (0.0667, 0.6525)


def test_without_exposure_a_count_and_no_rate():
    rate = alarm_rate([1] * 5, [0.0] * 5, range(5))
    assert (rate.alarms, rate.flights, rate.exposure_h) == (5, 5, 0.0)
    assert (rate.per_hour, rate.low, rate.high, rate.design_effect) == (None,) * 4
    assert rate.share.share == 1.0


def test_one_run_has_a_rate_and_no_interval_and_no_flight_nothing():
    one = alarm_rate([1, 0], [900.0, 900.0], ["a", "a"])
    assert (one.per_hour, one.low, one.high) == (2.0, None, None)
    none = alarm_rate([], [], [])
    assert (none.alarms, none.flights, none.per_hour, none.low, none.share.share) == (0, 0, None, None, None)


@given(st.lists(st.tuples(st.booleans(), st.integers(1, 6000), st.integers(0, 9)), min_size=1, max_size=60))
def test_the_rate_is_inside_and_never_narrower_than_independent_flights(flights):
    alarms, samples, runs = (np.array(column) for column in zip(*flights, strict=True))
    rate = alarm_rate(alarms, samples / 100.0, runs)
    if rate.low is None:
        assert rate.runs == 1
        return
    low, high = poisson_rate(rate.alarms, rate.exposure_h)
    assert rate.low <= low * (1 + 1e-12)
    assert rate.high >= high * (1 - 1e-12)
    assert rate.low <= rate.per_hour <= rate.high


@pytest.mark.parametrize(
    ("alarms", "time_s", "message"),
    [
        ([2, 0], [1.0, 1.0], "need alarms of 0 or 1"),
        ([1, float("nan")], [1.0, 1.0], "need alarms of 0 or 1"),
        ([1, 0], [1.0, -1.0], "need a time >= 0"),
        ([1, 0], [1.0, float("nan")], "need a time >= 0"),
        ([1, 0], [1.0], "one entry a row in each"),
    ],
)
def test_impossible_flights_are_refused(alarms, time_s, message):
    with pytest.raises(FddbenchError, match=message):
        alarm_rate(alarms, time_s, range(len(alarms)))


@pytest.mark.parametrize(("alarming", "effect"), [(0, 4.0), (1, 4.0), (2, 4.0), (3, 1.0)])
def test_alarms_in_fewer_than_three_runs_know_no_spread(alarming, effect):
    """One of the four flights of a run alarms at its end: only three such runs tell that runs alarm independently."""
    runs, flight = np.repeat(np.arange(10), 4), np.tile(np.arange(4), 10)
    rate = alarm_rate((flight == 0) & (runs < alarming), [60.0] * 40, runs)
    assert rate.design_effect == effect
    assert rate.alarms == alarming
