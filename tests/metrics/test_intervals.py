import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, poisson

from fddbench.errors import FddbenchError
from fddbench.metrics.intervals import clopper_pearson, poisson_rate

confidences = st.sampled_from([0.5, 0.9, 0.95, 0.99])


@given(st.integers(1, 80), st.floats(0, 1, allow_subnormal=False).map(lambda x: round(x, 9)), confidences)
def test_share_is_covered_at_least_as_often_as_promised(trials, share, confidence):
    k = np.arange(trials + 1)
    low, high = clopper_pearson(k, trials, confidence)
    covered = (low <= share) & (share <= high)
    assert binom.pmf(k, trials, share)[covered].sum() >= confidence - 1e-9


@given(st.floats(0, 40), st.floats(0.01, 1e4), confidences)
def test_rate_is_covered_at_least_as_often_as_promised(mean, hours, confidence):
    k = np.arange(400)
    low, high = poisson_rate(k, hours, confidence)
    covered = (low <= mean / hours * (1 + 1e-12)) & (mean / hours * (1 - 1e-12) <= high)
    assert poisson.pmf(k, mean)[covered].sum() >= confidence - 1e-9


@given(st.integers(1, 2000), confidences)
def test_interval_holds_the_share_grows_with_hits_and_is_symmetric(trials, confidence):
    k = np.arange(trials + 1)
    low, high = clopper_pearson(k, trials, confidence)
    assert np.all((low >= 0) & (low <= k / trials) & (k / trials <= high) & (high <= 1))
    assert np.all(np.diff(low) > 0)
    assert np.all(np.diff(high) > 0)
    np.testing.assert_allclose(low, 1.0 - high[::-1], atol=1e-12)


@given(st.integers(0, 50), st.integers(51, 200))
def test_more_confidence_is_wider(hits, trials):
    narrow, wide = clopper_pearson(hits, trials, 0.9), clopper_pearson(hits, trials, 0.99)
    assert wide[0] <= narrow[0]
    assert narrow[1] <= wide[1]


@given(st.integers(0, 500), st.floats(1e-3, 1e5))
def test_rate_interval_holds_the_rate_and_scales_with_hours(events, hours):
    low, high = poisson_rate(events, hours)
    assert low <= events / hours <= high
    np.testing.assert_allclose((low * hours, high * hours), poisson_rate(events, 1.0))


def test_literature_values():
    np.testing.assert_allclose(clopper_pearson(10, 100), (0.0490047, 0.1762226), atol=1e-6)
    np.testing.assert_allclose(poisson_rate(10, 1.0), (4.7954, 18.3904), atol=1e-4)


@pytest.mark.parametrize(("hits", "trials"), [(-1, 10), (11, 10), (0, 0), ([1, 5], [10, 4]), (float("nan"), 3)])
def test_impossible_counts_are_refused(hits, trials):
    with pytest.raises(FddbenchError, match="need 0 <= hits <= trials and trials >= 1, got hits="):
        clopper_pearson(hits, trials)


@pytest.mark.parametrize(("events", "hours"), [(-1, 1.0), (0, 0.0), (1, float("inf"))])
def test_rates_without_exposure_are_refused(events, hours):
    with pytest.raises(FddbenchError, match="need events >= 0 and hours > 0, got events="):
        poisson_rate(events, hours)


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_confidence_in_percent_is_refused(confidence):
    with pytest.raises(FddbenchError, match="write 95 % as 0.95"):
        clopper_pearson(1, 2, confidence)
