"""Laws of the small solve: it solves, with pivots, to the same bits everywhere."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.program import trace
from fddbench.blocks.solve import solve


@settings(max_examples=30, deadline=None)
@given(n=st.integers(1, 7), seed=st.integers(0, 2**32 - 1))
def test_as_accurate_as_lapack(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(n, n, 20)), rng.normal(size=(n, 20))
    x = solve(A, b)
    theirs = np.stack([np.linalg.solve(A[:, :, i], b[:, i]) for i in range(20)], axis=-1)
    ours, lapack = (np.abs(np.einsum("ijk,jk->ik", A, y) - b).max(axis=0) for y in (x, theirs))
    size = np.abs(A).max(axis=(0, 1)) * np.abs(x).max(axis=0)
    assert np.all(ours < 8.0 * n * 2.2e-16 * np.maximum(size, 1.0) + 8.0 * lapack)


def test_a_vanishing_diagonal_needs_pivots() -> None:
    A = np.array([[0.0, 1.0, 0.0], [1e-20, 0.0, 3.0], [2.0, 0.0, 1e-20]])
    x = np.array([1.0, -2.0, 5.0])
    found = solve(A[:, :, np.newaxis], (A @ x)[:, np.newaxis])
    np.testing.assert_allclose(found[:, 0], x, rtol=1e-15)


def test_a_singular_matrix_harms_no_other_case() -> None:
    A = np.stack([np.eye(3), np.zeros((3, 3)), 2.0 * np.eye(3)], axis=-1)
    found = solve(A, np.ones((3, 3)))
    assert not np.isfinite(found[:, 1]).any()
    np.testing.assert_array_equal(found[:, [0, 2]], [[1.0, 0.5]] * 3)


def test_one_matrix_for_all_cases_and_the_inputs_are_left_alone() -> None:
    A, b = np.array([[1.0, 2.0], [3.0, 4.0]])[:, :, np.newaxis], np.arange(10.0).reshape(2, 5)
    kept = A.copy(), b.copy()
    assert solve(A, b).shape == (2, 5)
    np.testing.assert_array_equal(A, kept[0])
    np.testing.assert_array_equal(b, kept[1])


@pytest.mark.parametrize("n", [1, 3, 5])
def test_the_same_bits_everywhere_and_in_any_company(where: Any, once: Any, same: Any, n: int) -> None:
    def step(state: Any) -> dict[str, Any]:
        return {"state": state, "y": solve(state[: n * n].reshape(n, n, -1), state[n * n :])}

    state = np.random.default_rng(n).normal(size=(n * (n + 1), 67))
    state[:, 5], state[: n * n, 6] = np.nan, 0.0
    eager = step(state)["y"]
    program = trace(step, state=len(state))
    assert same(once(program, state, **where), eager)
    assert same(once(program, state, backend="numpy"), eager)
    assert same(step(state[:, 3:4])["y"], eager[:, 3:4])
