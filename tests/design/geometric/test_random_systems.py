"""Laws of the subspace algorithms on random affine systems; minimality against two algorithms that share no line with them."""

from functools import reduce

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.design.geometric.rational import null_rows, product, rational, reduced, transposed

from fddbench.design.geometric import (
    complement,
    contains,
    image,
    intersection,
    invariant_subspace,
    inverse_image,
    kernel,
    residual_generator,
    subspace_sum,
    unobservability_subspace,
)
from fddbench.errors import DesignError

small = st.integers(-2, 2)


@st.composite
def systems(draw, most_parameters=2):
    """Sparse integer matrices, where subspaces of every dimension occur: A family, C of full rank, L."""
    n = draw(st.integers(2, 4))
    matrix = lambda rows, columns: np.array(  # noqa: E731
        draw(st.lists(st.lists(small, min_size=columns, max_size=columns), min_size=rows, max_size=rows)), dtype=float
    )
    A = np.stack([matrix(n, n) for _ in range(1 + draw(st.integers(0, most_parameters)))])
    C = matrix(draw(st.integers(1, n)), n)
    C = C[reduced(rational(C.T))[1]]
    L = matrix(n, 1)
    return (A, C if len(C) else np.eye(n)[:1], L if L.any() else np.eye(n)[:, :1])


@given(systems())
@settings(max_examples=40, deadline=None)
def test_invariance_and_the_hidden_part(system):
    A, C, L = system
    W, S = invariant_subspace(A, C, L), unobservability_subspace(A, C, L)
    assert contains(W, image(L))
    assert contains(S, W)
    seen = intersection(W, kernel(C))
    assert all(contains(W, image(A_j @ seen)) for A_j in A if (A_j @ seen).any())
    # S is all that (H C, A_j + D_j C) never shows
    P, H = complement(S).T, complement(subspace_sum(kernel(C), S)).T @ np.linalg.pinv(C)
    D = [-np.linalg.pinv(P) @ (P @ A_j @ S) @ np.linalg.pinv(C @ S, rcond=1e-9) for A_j in A]
    hidden = kernel(H @ C) if len(H) else np.eye(len(S))
    closed = [A_j + D_j @ C for A_j, D_j in zip(A, D, strict=True)]
    for _ in range(len(S) + 1):
        hidden = intersection(hidden, *(inverse_image(A_j, hidden) for A_j in closed))
    assert contains(hidden, S)
    assert contains(S, hidden)


def exact(A, C, L):
    """Rows that vanish on S*, by the dual recursion in rational numbers: what a residual may be built on.

    ``V_0 = W*^⊥ ∩ im C', V_{k+1} = W*^⊥ ∩ (im C' + sum_l A_l' V_k)`` with W* from vectors of its own.
    """
    n, A, C, L = len(L), [rational(A_j) for A_j in A], rational(C), rational(L.T)
    W = reduced(L)[0]
    while True:
        seen = product(C, transposed(W))
        unseen = [product([z], W)[0] for z in null_rows(seen, len(W))]
        larger = reduced([*L, *(product([x], transposed(A_j))[0] for A_j in A for x in unseen)])[0]
        if len(larger) == len(W):
            break
        W = larger

    def zero_on_W(rows):
        return [product([z], rows)[0] for z in null_rows(transposed(product(rows, transposed(W))), len(rows))]

    V = zero_on_W(C)
    for _ in range(n + 1):
        V = zero_on_W(reduced([*C, *(row for A_j in A for row in (product(V, A_j) if V else []))])[0])
    return np.array([[float(value) for value in row] for row in V]).reshape(-1, n)


@given(systems())
@settings(max_examples=25, deadline=None)
def test_it_is_the_smallest_one_by_exact_arithmetic_on_the_dual(system):
    A, C, L = system
    S = unobservability_subspace(A, C, L)
    rows = exact(A, C, L)
    assert S.shape[1] == len(L) - len(rows)
    np.testing.assert_allclose(rows @ S, 0.0, atol=1e-7 * max(1.0, np.abs(rows).max(initial=0.0)))


@given(systems(most_parameters=0))
@settings(max_examples=25, deadline=None)
def test_without_parameters_it_is_what_no_filter_in_the_frequency_domain_can_tell_from_the_fault(system):
    A, C, L = system
    n, parts = A.shape[1], []
    for s in np.linspace(7.3, 19.7, 2 * n + 1):  # off the spectrum; enough points for rational functions of this degree
        G = C @ np.linalg.inv(s * np.eye(n) - A[0])
        parts.append(kernel((complement(image(G @ L)).T @ G) if (G @ L).any() else G))
    assert unobservability_subspace(A, C, L).shape[1] == reduce(lambda S, T: intersection(S, T), parts).shape[1]


@given(systems(), st.integers(0, 3))
@settings(max_examples=20, deadline=None)
def test_whoever_gets_a_filter_gets_one_that_decouples(system, column):
    A, C, L = system
    other = np.eye(len(L))[:, [column % len(L)]]
    box = [[-0.5, 0.5]] * (len(A) - 1) or None
    try:
        bank = residual_generator(A, np.eye(len(L)), C, {"a": L, "b": other}, box=box, decay=0.1)
    except DesignError as error:
        assert "isolate" in str(error) or "seen" in str(error) or "quadratically" in str(error)  # noqa: PT017
        return
    for name, direction in (("b", L), ("a", other)):
        found = bank[name]
        assert found.identity_error < 1e-8
        np.testing.assert_allclose(found.P @ direction, 0.0, atol=1e-8)
        assert np.linalg.norm(found.steady_gain(np.zeros(len(A) - 1))) > 1e-9


def test_a_fault_that_cannot_be_told_is_refused_by_name():
    A, C = np.array([[-1.0, 0.0, 0.0], [1.0, -2.0, 0.0], [0.0, 1.0, -3.0]]), np.array([[0.0, 0.0, 1.0]])
    faults = {"pump": [1.0, 0.0, 0.0], "valve": [0.0, 1.0, 0.0]}
    with pytest.raises(DesignError, match="fault 'pump' cannot be isolated from 'valve': .* Measure more outputs"):
        residual_generator(A, np.eye(3), C, faults)
    with pytest.raises(DesignError, match="fault 'pump' cannot be seen at all"):
        residual_generator(np.diag([-1.0, -2.0]), np.eye(2), [[0.0, 1.0]], {"pump": [1.0, 0.0], "valve": [0.0, 1.0]})


def test_two_that_hide_a_third_only_together_are_named_together():
    faults = {"a": [1.0, 1.0, 0.0], "b": [1.0, 0.0, 0.0], "c": [0.0, 1.0, 0.0]}
    with pytest.raises(DesignError, match="fault 'a' cannot be isolated from 'b' and 'c' together"):
        residual_generator(-np.eye(3), np.eye(3), np.eye(3), faults)


@pytest.mark.parametrize("angle", [1e-3, 1e-6])
def test_a_barely_solvable_pair_is_solved_with_its_condition_number_said(angle):
    A, C = np.array([[-1.0, 2.0], [0.3, -2.0]]), np.eye(2)
    faults = {"a": [1.0, 0.0], "b": [np.cos(angle), np.sin(angle)]}
    bank = residual_generator(A, np.eye(2), C, faults, decay=1.0)
    for found in bank.values():
        assert found.solvability.condition_number == pytest.approx(1.0 / np.sin(angle), rel=1e-6)
        assert found.solvability.smallest_angle_deg == pytest.approx(np.rad2deg(angle), rel=1e-6)
        assert abs(found.steady_gain(np.zeros(0))[0, 0]) == pytest.approx(np.sin(angle), rel=1e-6)
        assert found.identity_error < 1e-12
    with pytest.raises(DesignError, match="'a' cannot be isolated from 'b'"):
        residual_generator(A, np.eye(2), C, {"a": [1.0, 0.0], "b": [1.0, 1e-11]})


def test_pointwise_and_sum_conditions_differ_where_directions_turn_with_rho():
    """Thrust enters alpha' through 1/V: its span holds the elevator's first part, yet at no rho they are parallel."""
    A = np.zeros((2, 2, 2))
    A[0] = -np.eye(2)
    turning = np.array([[[0.0], [1.0]], [[1.0], [0.0]]])  # (rho, 1)
    free = residual_generator(A, np.eye(2), np.eye(2), {"a": turning, "b": [1.0, 0.0]}, box=[[1.0, 2.0]], watch=["a"])
    assert not free["a"].solvability.sum_condition
    assert free["a"].solvability.condition_number == pytest.approx(np.sqrt(5.0))
    crossing = np.array([[[1.0], [0.0]], [[0.0], [1.0]]])  # (1, rho): parallel to b at rho = 0
    with pytest.raises(DesignError, match=r"'a' cannot be isolated from 'b': .* at rho = \[0.0\]"):
        residual_generator(A, np.eye(2), np.eye(2), {"a": crossing, "b": [1.0, 0.0]}, box=[[-1.0, 3.0]], watch=["a"])


def test_one_state_where_a_row_of_the_outputs_allows_it():
    A = np.array([[-1.0, 2.0, 0.0], [0.3, -2.0, 1.0], [0.0, 0.5, -1.0]])
    faults = {"a": [1.0, 0.2, 0.0], "b": [0.0, 1.0, 0.0]}
    bank = residual_generator(A, np.eye(3), np.eye(3), faults, decay=2.0, one_state=True)
    for found in bank.values():
        assert found.order == 1
        assert found.N[0, 0, 0] == pytest.approx(-2.0)
        assert found.identity_error < 1e-12
    np.testing.assert_allclose(bank["a"].H, [[1.0, 0.0, 0.0]], atol=1e-7)
    # with the third state unmeasured its way into a row is one that the row must not have
    two = residual_generator(A, np.eye(3), np.eye(3)[:2], faults, decay=2.0, one_state=True)
    assert two["a"].order == 1
    assert two["b"].order == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"box": None}, "no box says in which range"),
        ({"box": [[1.0, 0.0]]}, "with low < high"),
        ({"C": [[1.0, 0.0], [2.0, 0.0]]}, "outputs say the same"),
        ({"faults": {"a": [1.0, 0.0, 0.0]}}, "the direction of fault 'a' has shape .3,., needs .2, 2, any."),
        ({"faults": {"a": [0.0, 0.0]}}, "fault 'a' has no direction"),
        ({"watch": ["b"]}, "no fault is called 'b'; known: a"),
        ({"decay": 0.0}, "decay is a rate"),
        ({"C": [[1.0, 0.0]], "decay": 50.0, "A": [[[-1, 0], [0, -1]], [[0, 1], [0, 0]]], "faults": {"a": [1.0, 1.0]}}, "quad"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_said(change, message):
    given = {"A": np.array([-np.eye(2), np.eye(2)]), "C": np.eye(2), "faults": {"a": [1.0, 0.0]}, "box": [[-0.5, 0.5]]}
    given |= change
    with pytest.raises(DesignError, match=message):
        residual_generator(given.pop("A"), np.eye(2), given.pop("C"), given.pop("faults"), **given)
