"""The choice among hypotheses: one faulty, two alike, two against each other, and nobody while all agree."""

import numpy as np
import pytest

from fddbench.blocks.layout import Nothing
from fddbench.detection.decision import Nearest, NearestGains
from fddbench.interfaces import Bus

BUS = Bus(sample_s=0.01, sites=(), signals={})
GAINS = NearestGains(gate_deg_s=0.1, gate_lag_s=0.05, clear_ratio=0.5, confirm_one_s=1.0, confirm_two_s=0.1)


def declared_at(errors, *, model_error=0.0, n=300):
    """Sample of the first declaration (None: none) and what is declared at last; sensors err from sample 50 on."""
    nearest = Nearest.of(GAINS, BUS, 3)
    x, first = nearest.states.spread(nearest.start(Nothing()), 1), None
    noise = 0.01 * np.random.default_rng(4).standard_normal((n, 3, 1))
    for k in range(n):
        r = noise[k] + (np.array(errors)[:, np.newaxis] if k >= 50 else 0.0)
        x, decision = nearest.step(x, Nothing(), Nothing(), r, np.abs(r - model_error))
        if first is None and decision.declared.any():
            first = k
    return first, decision.declared[:, 0].tolist()


@pytest.mark.parametrize(
    ("errors", "declared", "first"),
    [
        ((0.0, 0.5, 0.0), [0.0, 1.0, 0.0], 151),
        ((0.5, 0.0, 0.5), [1.0, 0.0, 1.0], 61),
        ((1.0, -1.0, 0.0), [1.0, 1.0, 0.0], 60),
    ],  # the lag of the gate takes a sample where the fault is hardly twice the gate
)
def test_whoever_differs_from_the_one_near_the_model_is_declared_when_it_has_stood(errors, declared, first):
    assert declared_at(errors) == (first, declared)
    assert declared_at(errors, model_error=0.1) == (first, declared)


def test_a_model_error_alone_accuses_nobody():
    assert declared_at((0.0, 0.0, 0.0), model_error=5.0) == (None, [0.0, 0.0, 0.0])


def test_it_waits_while_the_nearest_is_hardly_nearer():
    assert declared_at((0.5, 0.0, 0.0), model_error=0.2) == (None, [0.0, 0.0, 0.0])


def test_what_is_declared_stays_declared():
    nearest = Nearest.of(GAINS, BUS, 3)
    x = nearest.states.spread(nearest.start(Nothing()), 1)
    r = np.array([[1.0], [0.0], [0.0]])
    for _ in range(120):
        x, decision = nearest.step(x, Nothing(), Nothing(), r, np.abs(r))
    assert decision.declared[:, 0].tolist() == [1.0, 0.0, 0.0]
    for _ in range(120):  # now the model speaks for the first one
        x, decision = nearest.step(x, Nothing(), Nothing(), r, np.abs(r - 1.0))
    assert decision.declared[:, 0].tolist() == [1.0, 0.0, 0.0]
    r = np.array([[1.0], [2.0], [0.0]])  # a second fault
    for _ in range(120):
        x, decision = nearest.step(x, Nothing(), Nothing(), r, np.abs(r))
    assert decision.declared[:, 0].tolist() == [1.0, 1.0, 0.0]
