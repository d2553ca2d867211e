"""The search for a bell curve: its gradients are those of the formula, written a second time as differences."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.special import ndtr

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
