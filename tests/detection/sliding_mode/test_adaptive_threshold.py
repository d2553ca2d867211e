"""The adaptive threshold against the exact solution of eq (38)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode.adaptive_threshold import AdaptiveThreshold, ThresholdState

deflections = st.lists(st.floats(-25.0, 25.0), min_size=13, max_size=13)


def threshold(sample_s=0.01, floor=0.25):
    return AdaptiveThreshold(
        pole_1_s=0.6, gain=1.2, roll_surface_scale=12.0, rudder_scale=2.0, floor_deg_s=floor, sample_s=sample_s
    )


def stepped(block, level, u):
    """Level at the next sample, and the threshold at this one."""
    after, shown = block.step(ThresholdState(level_deg_s=level), Nothing(), Nothing(), u)
    return after.level_deg_s, shown


def driving(u):
    """Right-hand side of eq (38) without the pole."""
    return 1.2 * max(np.abs(u[1:]).max() / 12.0, abs(u[0]) / 2.0)


def integrated(level, u, sample_s):
    """Eq (38) over one sample by an integrator."""
    force = driving(u)
    solved = solve_ivp(lambda t, x: -0.6 * x + force, (0.0, sample_s), [level], rtol=1e-10, atol=1e-12)
    return solved.y[0, -1]


@settings(max_examples=10)
@given(st.lists(deflections, min_size=1, max_size=4), st.sampled_from((0.01, 0.02, 0.5)))
def test_solves_equation_38_for_surfaces_held_over_the_sample(held, sample_s):
    block, level, exact = threshold(sample_s), np.zeros(1), 0.0
    for values in held:
        u = np.array(values)
        level, shown = stepped(block, level, u[:, np.newaxis])
        assert shown[0] == pytest.approx(max(exact, 0.25), rel=1e-7)
        exact = integrated(exact, u, sample_s)
        assert level[0] == pytest.approx(exact, rel=1e-7, abs=1e-10)


@given(deflections)
def test_settles_at_twice_the_scaled_deflection(values):
    u, level = np.array(values)[:, np.newaxis], np.zeros(1)
    for _ in range(200):
        level, _ = stepped(threshold(0.5), level, u)
    assert level[0] == pytest.approx(driving(u[:, 0]) / 0.6, rel=1e-12)


@given(deflections, st.integers(1, 30))
def test_n_small_steps_are_one_large_step(values, n):
    u = np.array(values)[:, np.newaxis]
    small, (large, _) = np.full(1, 0.7), stepped(threshold(0.01 * n), np.full(1, 0.7), u)
    for _ in range(n):
        small, _ = stepped(threshold(0.01), small, u)
    np.testing.assert_allclose(small, large, rtol=1e-12)


@given(st.floats(0.0, 5.0), deflections)
def test_never_below_the_floor(level, values):
    _, shown = stepped(threshold(), np.array([level]), np.array(values)[:, np.newaxis])
    assert shown[0] == max(level, 0.25)


@pytest.mark.parametrize(("surface", "scale"), [(0, 2.0), (1, 12.0), (4, 12.0), (5, 12.0), (12, 12.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_surface_opens_it_by_its_own_scale(surface, scale, sign):
    u = np.zeros((13, 1))
    u[surface] = 6.0 * sign
    level, _ = stepped(threshold(), np.zeros(1), u)
    assert level[0] == pytest.approx(1.2 * 6.0 / scale * (1 - np.exp(-0.006)) / 0.6, rel=1e-12)
