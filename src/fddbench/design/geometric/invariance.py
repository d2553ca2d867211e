"""Invariant and unobservability subspaces of affine families A(rho) = A_0 + rho_1 A_1 + ..., Proposition 3 of the paper.

Its equation (A2) stops after one step and leaves C out of S_0; it is not used. What the introduction calls the largest
unobservability subspace is the smallest one that holds L.
"""

import numpy as np
from numpy.typing import ArrayLike

from fddbench.design.geometric.affine import family, numbers
from fddbench.design.geometric.subspaces import (
    Matrix,
    image,
    intersection,
    inverse_image,
    kernel,
    moved,
    subspace_sum,
)

__all__ = ["invariant_subspace", "unobservability_subspace"]


def invariant_subspace(A: ArrayLike, C: ArrayLike, L: ArrayLike) -> Matrix:
    """Smallest parameter-varying (C, A)-invariant subspace W* that holds the columns of L (CAISA).

    ``W_0 = L, W_{k+1} = L + sum_l A_l (W_k ∩ ker C)``: a D(rho) makes ``(A(rho) + D(rho) C) W* ⊆ W*`` for every rho.

    Parameters
    ----------
    A : sequence of (n, n) matrices
        A_0, A_1, ...; one for a system without parameters.
    C : (n_y, n) matrix
    L : (n, m) matrix, or (n,) vector

    Returns
    -------
    (n, k) matrix
        Orthonormal basis.

    Raises
    ------
    DesignError
        Shapes do not fit, or numbers are not finite.

    References
    ----------
    The LPV detection filter paper, Proposition 3; Balas, Bokor, Szabó (2003), Invariant subspaces for LPV systems and their
    applications, IEEE Transactions on Automatic Control 48(11), 2065-2069.
    """
    A, C, L = _read(A, C, L)
    W, hidden = image(L), kernel(C)
    while True:
        unseen = intersection(W, hidden)
        larger = subspace_sum(W, *(moved(A_l, unseen) for A_l in A))
        if larger.shape[1] == W.shape[1]:
            return W
        W = larger


def unobservability_subspace(A: ArrayLike, C: ArrayLike, L: ArrayLike) -> Matrix:
    """Smallest parameter-varying unobservability subspace S* that holds the columns of L (UOSA).

    ``S_0 = W* + ker C, S_{k+1} = W* + (∩_l A_l^-1 S_k) ∩ ker C``: some H and D(rho) make S* the part of the state that
    ``(H C, A(rho) + D(rho) C)`` never shows, so that nothing which enters through L reaches a residual built on it.

    Parameters, returns and errors as `invariant_subspace`.
    """
    A, C, L = _read(A, C, L)
    W, hidden = invariant_subspace(A, C, L), kernel(C)
    S = subspace_sum(W, hidden)
    while True:
        smaller = subspace_sum(W, intersection(hidden, *(inverse_image(A_l, S) for A_l in A)))
        if smaller.shape[1] == S.shape[1]:
            return smaller
        S = smaller


def _read(A: ArrayLike, C: ArrayLike, L: ArrayLike) -> tuple[list[Matrix], Matrix, Matrix]:
    """A, C and L as matrices that go together."""
    members = family("A", A, (None, None))
    n = members.shape[2]
    members = family("A", members, (n, n))
    return list(members), family("C", np.atleast_2d(numbers("C", C)), (None, n), 0)[0], family("L", L, (n, None), 0)[0]
