"""Actuators: exact for a held command, and never beyond a limit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from fddbench.blocks.layout import Nothing
from fddbench.flight.actuators import Actuators, ActuatorState

sample_times = st.sampled_from((0.001, 0.005, 0.01, 0.02, 0.04))
angles = st.floats(-60.0, 60.0)


def actuators(sample_s, rate=40.0):
    return Actuators(bandwidth_rad_s=14.0, rate_deg_s=np.array([[rate]]), sample_s=sample_s)


def moved(surface, y, *inputs):
    """Positions at the next sample of surfaces at y; what is shown is where they stand now."""
    after, shown = surface.step(ActuatorState(position_deg=y), Nothing(), Nothing(), *inputs)
    assert shown is y
    return after.position_deg


def one(value):
    return np.array([[float(value)]])


@given(sample_times, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.integers(1, 20))
def test_exact_for_a_held_command(sample_s, start, command, steps):
    """The same as the matrix exponential of ``[y; u]' = [[-w, w], [0, 0]] [y; u]``, whatever the sample time."""
    surface, y = actuators(sample_s, rate=1e9), one(start)
    for _ in range(steps):
        y = moved(surface, y, one(command), one(-99), one(99))
    exact = expm(np.array([[-14.0, 14.0], [0.0, 0.0]]) * sample_s * steps) @ [start, command]
    assert y[0, 0] == pytest.approx(exact[0], abs=1e-12)


@given(st.lists(angles, min_size=1, max_size=30), sample_times, st.floats(5.0, 50.0), st.floats(0.0, 30.0))
def test_never_beyond_rate_or_travel(commands, sample_s, rate, travel):
    surface, y = actuators(sample_s, rate), one(0.0)
    for command in commands:
        after = moved(surface, y, one(command), one(-travel / 3), one(travel))
        assert abs(after[0, 0] - y[0, 0]) <= rate * sample_s * (1 + 1e-12) + 1e-14
        assert -travel / 3 <= after[0, 0] <= travel
        y = after


@given(angles, st.floats(-20.0, 20.0), sample_times)
def test_approaches_the_reachable_command_and_never_passes_it(command, start, sample_s):
    surface, y = actuators(sample_s), one(start)
    goal = min(max(command, -25.0), 25.0)
    for _ in range(5):
        after = moved(surface, y, one(command), one(-25), one(25))[0, 0]
        assert min(y[0, 0], goal) - 1e-12 <= after <= max(y[0, 0], goal) + 1e-12
        assert abs(after - goal) <= abs(y[0, 0] - goal)
        y = one(after)


def test_rate_limited_step_against_an_integrator():
    """A 20 deg step at 10 deg/s: rate limited first, first order at the end."""
    sample_s = 0.001
    surface, y, found = actuators(sample_s, rate=10.0), one(0.0), [0.0]
    for _ in range(3000):
        y = moved(surface, y, one(20.0), one(-25), one(25))
        found.append(y[0, 0])
    exact = solve_ivp(
        lambda t, x: np.clip(14.0 * (20.0 - x), -10.0, 10.0), (0.0, 3.0), [0.0], rtol=1e-9, atol=1e-9, max_step=0.01,
        t_eval=np.arange(3001) * sample_s,
    )  # fmt: skip
    np.testing.assert_allclose(found, exact.y[0], atol=0.01)


def test_every_surface_has_its_own_limits_and_every_case_its_own_bits():
    surface = Actuators(bandwidth_rad_s=14.0, rate_deg_s=np.array([[40.0], [20.0]]), sample_s=0.01)
    y, u = np.zeros((2, 3)), np.array([[30.0, 1.0, -30.0], [30.0, -1.0, 0.3]])
    low, high = np.array([[-0.3], [0.0]]) * np.ones(3), np.full((2, 3), 25.0)
    together = moved(surface, y, u, low, high)
    assert together[:, 0].tolist() == pytest.approx([0.4, 0.2])
    assert together[1, 1] == 0.0
    assert together[0, 2] == pytest.approx(-0.3 * (1 - np.exp(-0.14)))  # the command is limited to the travel first
    alone = np.concatenate([moved(surface, y[:, [i]], u[:, [i]], low[:, [i]], high[:, [i]]) for i in range(3)], axis=1)
    assert together.tobytes() == alone.tobytes()


def test_begins_at_zero_with_a_state_for_each_surface():
    surface = Actuators(bandwidth_rad_s=14.0, rate_deg_s=np.full((13, 1), 40.0), sample_s=0.01)
    begun = surface.states.spread(surface.start(Nothing()), 2)
    assert begun.position_deg.shape == (13, 2)
    assert not begun.position_deg.any()
