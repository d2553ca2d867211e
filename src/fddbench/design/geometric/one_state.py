"""Filters of one state: a row of the outputs that the other faults, and what is not measured, do not move."""

import numpy as np

from fddbench.design.geometric.affine import Box
from fddbench.design.geometric.subspaces import TOLERANCE, Matrix, complement, kernel, moved, subspace_sum
from fddbench.design.solver import attempt, modelling

__all__ = ["one_state_row"]


def one_state_row(A: Matrix, C: Matrix, hidden: Matrix, L: Matrix, box: Box) -> Matrix | None:
    """Row eta, (1, n_y), for ``w' = -a w - G y + F u, r = w - eta y``, or None where there is none.

    With ``h = eta C`` it needs ``h hidden = 0`` and ``h A_j ker C = 0`` for every j: then ``h A_j`` is a combination of rows
    of C, and ker h is an unobservability subspace that holds the other faults. Of all such rows of length one it is that with
    the largest ``min |h L(rho)|`` over the box, a convex problem since h L is affine and may not change its sign.

    Parameters
    ----------
    A, L : (n_parameters + 1, n, n), (n_parameters + 1, n, 1) arrays
    C : (n_y, n) matrix
    hidden : (n, k) matrix
        Basis of the directions of all other faults.
    """
    if L.shape[2] != 1:
        return None
    unseen = kernel(C)
    blind = subspace_sum(hidden, *(moved(A_j, unseen) for A_j in A))
    # eta C blind = 0
    across = C @ blind
    free = complement(subspace_sum(np.zeros((len(C), 0)), across / max(float(np.linalg.norm(across, 2)), TOLERANCE)))
    if not free.shape[1]:
        return None
    shown = np.einsum("ij,ajk->aik", free.T @ C, box.normalised(L))[:, :, 0]  # (n_parameters + 1, free)
    size = float(np.abs(shown).max(initial=0.0))
    if size == 0.0:
        return None
    cp = modelling()
    z = cp.Variable(free.shape[1])
    least = (shown[0] / size) @ z - (cp.norm1((shown[1:] / size) @ z) if len(shown) > 1 else 0.0)
    problem = cp.Problem(cp.Maximize(least), [cp.norm(C.T @ free @ z) <= 1.0])
    if attempt(problem, "CLARABEL", "the row of a filter with one state") != "optimal" or problem.value <= TOLERANCE:
        return None
    row = free @ (free.T @ _rounded(free @ np.asarray(z.value, dtype=float)))  # of the rounded one what is free
    return (row / np.linalg.norm(C.T @ row))[np.newaxis]


def _rounded(row: Matrix) -> Matrix:
    """The row without what a solver leaves of zeros."""
    kept: Matrix = np.where(np.abs(row) > 1e-7 * np.abs(row).max(), row, 0.0)
    return kept
