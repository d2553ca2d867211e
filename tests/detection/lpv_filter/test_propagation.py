"""One sample of a filter against the matrix exponential, and the course of outputs against a linear plant."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.linalg import expm

from fddbench.blocks.linear import column
from fddbench.detection.lpv_filter.course import course
from fddbench.detection.lpv_filter.propagation import POWERS, Constant, Varying, rest_of_series

T = 0.02
numbers = st.floats(-3.0, 3.0)
matrices = arrays(float, (2, 2), elements=numbers)
driven = arrays(float, (3, 2), elements=numbers)


def exact(N, w, a):
    """State after T of ``w' = N w + a_0 + a_1 s + a_2 s^2``, s = t / T, from one exponential with a clock inside."""
    n = len(N)
    big = np.zeros((n + 3, n + 3))
    big[:n, :n], big[:n, n:] = N, a.T
    big[n + 1, n], big[n + 2, n + 1] = 1.0 / T, 2.0 / T  # 1, s, s^2
    return (expm(big * T) @ np.concatenate([w, [1.0, 0.0, 0.0]]))[:n]


@given(matrices, arrays(float, 2, elements=numbers), driven)
@settings(max_examples=30, deadline=None)
def test_a_constant_matrix_is_propagated_exactly(N, w, a):
    found = Constant(N, T).step(column(w), tuple(column(row) for row in a))
    np.testing.assert_allclose(found[:, 0], exact(N, w, a), rtol=0.0, atol=1e-13)


@given(matrices, arrays(float, 2, elements=numbers), driven, st.floats(1.0, 60.0))
@settings(max_examples=30, deadline=None)
def test_the_series_is_as_near_as_it_says(N, w, a, fast):
    found = Varying(T).step(column(fast * N), column(w), tuple(column(row) for row in a))
    allowed = rest_of_series(float(np.linalg.norm(fast * N, 2)) * T) * (np.abs(w).sum() + T * np.abs(a).sum())
    np.testing.assert_allclose(found[:, 0], exact(fast * N, w, a), rtol=1e-13, atol=allowed + 1e-12)


def test_what_the_series_leaves_out():
    assert rest_of_series(0.1) < 1e-14
    assert rest_of_series(1.0) == pytest.approx(2.0 / np.prod(np.arange(1.0, POWERS + 2.0)))


def test_outputs_of_a_plant_with_held_inputs_bend_as_they_are_taken_to():
    """Mean over a sample of the course, against that of the exact response; a straight line is 1e4 times worse."""
    A, b = np.array([[-0.7, 1.0], [-2.0, -0.8]]), np.array([0.3, -1.0])
    t = np.linspace(0.0, T, 2001)
    held = np.linalg.solve(A, b)
    x = np.array([expm(A * s) @ (np.array([0.1, -0.2]) + held) - held for s in t])
    bent = course((column(x[0]), column(x[-1])), (column([0.0]), column([1.0])), [], bend=column([A]),
                  smooth=np.array([1.0]), sample_s=T)  # fmt: skip
    mean = bent.y[0] + bent.y[1] / 2.0 + bent.y[2] / 3.0
    truth = np.trapezoid(x, t, axis=0) / T
    assert np.abs(mean[:, 0] - truth).max() < 2e-9
    assert np.abs(0.5 * (x[0] + x[-1]) - truth).max() > 1e-5
    np.testing.assert_allclose(sum(bent.y)[:, 0], x[-1])
    assert bent.u[1].ravel() == pytest.approx([1.0])
