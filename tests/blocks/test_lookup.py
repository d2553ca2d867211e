"""Laws of tables: what they hold, at the border and beyond, cheap, and the same bits everywhere."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.accounting import cost
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.blocks.program import trace
from fddbench.errors import DesignError

BEYOND = (-np.inf, np.inf, np.nan, -1e300, 1e300, 0.0, -0.0)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.integers(-1000, 1000), min_size=2, max_size=100, unique=True), st.integers(0, 2**32 - 1))
def test_is_numpy_s_interpolation(knots: list[int], seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, values = np.sort(np.array(knots, dtype=float)), rng.normal(size=len(knots))
    at = np.concatenate([x, rng.uniform(-1100.0, 1100.0, 50)])
    grid = Grid(x)
    np.testing.assert_allclose(Lookup(values, grid)(grid.find(at)), np.interp(at, x, values), atol=1e-12)


def test_knots_are_met_and_the_border_is_held() -> None:
    alpha, mach = Grid([-5.0, 0.0, 20.0]), Grid([0.2, 0.9])
    table = Lookup(values := np.arange(6.0).reshape(3, 2), alpha, mach)
    for i, a in enumerate([-5.0, 0.0, 20.0]):
        for j, m in enumerate([0.2, 0.9]):
            assert table(alpha.find(np.array([a])), mach.find(np.array([m])))[0] == values[i, j]
    outside = table(alpha.find(np.array([-99.0, 99.0, np.inf])), mach.find(np.array([0.0, 7.0, -np.inf])))
    np.testing.assert_array_equal(outside, [0.0, 5.0, 4.0])
    assert np.isnan(table(alpha.find(np.array([np.nan])), mach.find(np.array([0.5]))))[0]


def test_a_plane_is_met_everywhere() -> None:
    x, y = Grid([0.0, 1.0, 5.0, 6.0]), Grid([-1.0, 2.0, 3.0])
    plane = Lookup(2.0 * x.knots[:, np.newaxis] - 3.0 * y.knots, x, y)
    u, v = np.random.default_rng(0).uniform(0.0, 3.0, (2, 100))
    np.testing.assert_allclose(plane(x.find(u), y.find(v)), 2.0 * u - 3.0 * v, atol=1e-13)


@pytest.mark.parametrize("knots", [[0.0], [0.0, 0.0], [1.0, 0.0], [0.0, np.nan], [0.0, np.inf], [[0.0, 1.0]]])
def test_breakpoints_that_are_none(knots: Any) -> None:
    with pytest.raises(DesignError, match="rising order"):
        Grid(knots)


def test_values_of_another_shape() -> None:
    with pytest.raises(DesignError, match=r"axes of \[2, 3\] breakpoints has values of shape \(3, 2\)"):
        Lookup(np.zeros((3, 2)), Grid([0, 1]), Grid([0, 1, 2]))


def test_places_that_are_missing() -> None:
    grid = Grid([0.0, 1.0])
    with pytest.raises(DesignError, match="over 2 axes needs as many places, got 1"):
        Lookup(np.zeros((2, 2)), grid, grid)(grid.find(np.zeros(1)))


def _aerodynamics(n_tables: int, n_x: int = 20, n_y: int = 19) -> Any:
    """Step with many tables over the same axes."""
    rng = np.random.default_rng(1)
    alpha, mach = Grid(np.sort(rng.uniform(-10.0, 30.0, n_x))), Grid(np.sort(rng.uniform(0.2, 0.9, n_y)))
    tables = [Lookup(rng.normal(size=(n_x, n_y)), alpha, mach) for _ in range(n_tables)]

    def step(state: Any) -> dict[str, Any]:
        places = alpha.find(state[0]), mach.find(state[1])
        return {"state": state, "y": np.stack([table(*places) for table in tables])}

    return step


def _points(n: int) -> Any:
    rng = np.random.default_rng(2)
    points = np.stack([rng.uniform(-20.0, 40.0, n), rng.uniform(0.0, 1.1, n)])
    points[:, :7] = BEYOND
    points[0, 7:14] = BEYOND
    return points


@pytest.mark.parametrize("shape", [(20, 19), (2, 2), (150, 3)])
def test_the_same_bits_everywhere(where: Any, once: Any, same: Any, shape: tuple[int, int]) -> None:
    step, points = _aerodynamics(5, *shape), _points(203)
    eager, program = step(points)["y"], trace(step, state=2)
    assert same(once(program, points, **where), eager)
    assert same(once(program, points, backend="numpy"), eager)
    assert same(step(points[:, 9:10])["y"], eager[:, 9:10])


def test_tables_share_the_search() -> None:
    program = trace(_aerodynamics(24), state=2)
    assert (program.counts["locate"], program.counts["gather"], program.counts["div"]) == (2, 24 * 4 + 4, 2)
    assert len(program.nodes) <= 375
    one, many = (cost(trace(_aerodynamics(n), state=2)) for n in (1, 24))
    assert (many.flops - one.flops) == 23 * 13
    assert many.table_bytes - one.table_bytes == 8 * 23 * 380
