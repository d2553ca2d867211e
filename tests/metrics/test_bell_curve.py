"""The search for a bell curve: its gradients are those of the formula, written a second time as differences."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from fddbench.metrics import bell_curve
from fddbench.metrics.bell_curve import Flights

_STEP = 1e-6


def flights(seed, *, n=80, s=0.3, floor=0.1, ceiling=0.95):
    """Of a known curve whose middle is 0, over the logarithm of the size."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1.2, 1.2, n)
    return Flights(x, (rng.random(n) < floor + (ceiling - floor) * ndtr(x / s)).astype(float))


@pytest.fixture
def looked_at(monkeypatch):
    """Gradients where searches begin, each with that by central differences."""
    found, minimize = [], bell_curve.minimize

    def search(cost, begin, **how):
        z = np.asarray(begin, dtype=float)
        steps = _STEP * np.eye(len(z))
        found.append((cost(z)[1], [(cost(z + step)[0] - cost(z - step)[0]) / (2.0 * _STEP) for step in steps]))
        return minimize(cost, begin, **how)

    monkeypatch.setattr(bell_curve, "minimize", search)
    return found


@pytest.mark.parametrize("s", [0.1, 0.3, 1.0])
def test_gradients_are_those_of_the_likelihood(looked_at, s):
    """Of all four kinds of curve, in the search for the best and in that along one size at 90 %."""
    fit = bell_curve.chosen(flights(1, s=s))
    assert {len(slopes) for slopes, _ in looked_at} == {2, 3, 4}
    for floored, capped in product([False, True], repeat=2):
        bell_curve.profile(replace(fit, floored=floored, capped=capped), 0.5)
    assert {len(slopes) for slopes, _ in looked_at} == {1, 2, 3, 4}
    for slopes, expected in looked_at:
        np.testing.assert_allclose(slopes, expected, rtol=1e-4, atol=1e-4)  # 1 - p is rounded where p is near 1
        assert np.abs(slopes).max() > 1e-3  # no beginning is an end


def test_a_steep_step_among_many_sizes_is_found():
    """Without the beginning at the best step the flights are said to want neither a floor nor a ceiling."""
    rng = np.random.default_rng(17)
    x = rng.uniform(-1.2, 1.2, 300)
    fit = bell_curve.chosen(Flights(x, (rng.random(300) < np.where(x > 0.0, 0.5, 0.3)).astype(float)))
    assert (fit.floored, fit.capped) == (True, True)
    assert fit.m == pytest.approx(0.0, abs=0.05)
    assert fit.s < 0.05


@pytest.mark.parametrize(
    "found", [np.zeros(30), np.ones(30), np.repeat([1.0, 0.0], 15)], ids=["none", "all", "the small"]
)
def test_flights_that_want_no_curve_have_one_all_the_same(found):
    fit = bell_curve.chosen(Flights(np.linspace(-1.0, 1.0, 30), found))
    assert np.isfinite([fit.m, fit.s, fit.floor, fit.ceiling, fit.log_likelihood]).all()


@pytest.mark.parametrize("seed", [5, 12, 33])
def test_no_curve_through_a_size_at_90_percent_is_likelier_than_its_profile(seed):
    """Without the beginnings just above 90 % it is, by 1.1, 3.6 and 0.9: the upper end of that size was too small."""
    rng = np.random.default_rng(seed)
    x = rng.choice(np.log(np.geomspace(0.3, 3.0, 6)), 120)
    own = Flights(x, (rng.random(120) < 0.1 + 0.85 * ndtr((x + 0.5) / 0.1)).astype(float))
    fit = bell_curve.chosen(own)
    assert (fit.floored, fit.capped) == (True, True)
    for beyond in (0.15, 0.3):
        x90 = np.log(fit.size_at(0.9)) + beyond * own.span
        most = bell_curve.profile(fit, x90)
        for s, floor, ceiling in product(np.geomspace(0.02, 1.0, 12), (0.05, 0.1, 0.15, 0.2), (0.9001, 0.92, 0.95)):
            u = (own.x - x90) / s + ndtri((0.9 - floor) / (ceiling - floor))
            assert own.log_likelihood(floor + (ceiling - floor) * ndtr(u)) <= most + 1e-6
