"""Arithmetic of subspaces by singular values: sums, intersections, images and inverse images, with a stated tolerance.

A subspace of R^n is an (n, k) matrix whose k columns are an orthonormal basis; k may be zero. What decides a rank is a
singular value beside the largest one (of a matrix), or beside one (of orthonormal bases put side by side): below `TOLERANCE`
it counts as zero. Two lines 1e-3 rad apart are two lines; two lines 1e-10 rad apart are one.

References
----------
Golub, Van Loan (2013), Matrix Computations, 4th edition, sections 5.5 and 6.4.
"""

import numpy as np
import numpy.typing as npt

__all__ = [
    "TOLERANCE", "Matrix", "complement", "contains", "image", "intersection", "inverse_image", "kernel", "moved",
    "sine", "subspace_sum",
]  # fmt: skip

Matrix = npt.NDArray[np.float64]

TOLERANCE = 1e-9
"""Singular values below it, relative to one or to the largest, are zero [-]."""


def image(M: Matrix) -> Matrix:
    """Span of the columns of M, (n, k); a column counts by its direction, whatever its length and unit.

    >>> image(np.array([[1e-7, 0.0], [0.0, 0.0]])).shape
    (2, 1)
    """
    lengths = np.linalg.norm(M, axis=0)
    return _range(M[:, lengths > 0.0] / lengths[lengths > 0.0])


def kernel(M: Matrix) -> Matrix:
    """Vectors that M takes to zero, (n_columns, k); its rows count by their direction."""
    return complement(image(M.T))


def complement(S: Matrix) -> Matrix:
    """Orthogonal complement, (n, n - k)."""
    n, k = S.shape
    return _signed(np.linalg.svd(S, full_matrices=True)[0][:, k:]) if k else np.eye(n)


def subspace_sum(*subspaces: Matrix) -> Matrix:
    """``S1 + S2 + ...``, the smallest subspace that holds all."""
    return _range(np.hstack(subspaces))


def intersection(*subspaces: Matrix) -> Matrix:
    """``S1 ∩ S2 ∩ ...``, the complement of the sum of the complements."""
    return complement(subspace_sum(*(complement(S) for S in subspaces)))


def moved(A: Matrix, S: Matrix) -> Matrix:
    """``A S``, all A x with x in S; what is small beside the norm of A is none."""
    size = np.linalg.norm(A, 2)
    return _range(A @ S / size) if size > 0.0 else np.zeros((len(A), 0))


def inverse_image(A: Matrix, S: Matrix) -> Matrix:
    """``A^-1 S``, all x with A x in S: the kernel of ``S⊥' A`` (Proposition A1); A need not be regular."""
    rows = complement(S).T @ A
    size = np.linalg.norm(A, 2)
    return complement(_range(rows.T / size)) if size > 0.0 else np.eye(A.shape[1])


def contains(S: Matrix, T: Matrix) -> bool:
    """Whether S holds T."""
    return not T.shape[1] or bool(np.linalg.norm(T - S @ (S.T @ T), 2) <= np.sqrt(TOLERANCE))


def sine(S: Matrix, L: Matrix) -> float:
    """Sine of the smallest angle between S and the span of the columns of L [-]; 0 where they share a direction.

    L has independent columns, (n, m), that need not be orthonormal; a column counts by its direction.
    """
    directions = L / np.linalg.norm(L, axis=0)
    outside = complement(S).T @ np.linalg.qr(directions)[0]
    if outside.shape[0] < outside.shape[1]:
        return 0.0
    return float(np.linalg.svd(outside, compute_uv=False)[-1])


def _range(M: Matrix) -> Matrix:
    """Span of columns of length about one."""
    if not M.shape[1]:
        return np.zeros((len(M), 0))
    U, s, _ = np.linalg.svd(M, full_matrices=False)
    return _signed(U[:, s > TOLERANCE])


def _signed(basis: Matrix) -> Matrix:
    """The basis with the largest number of each vector positive: the same design on every LAPACK, for simple cases."""
    if not basis.size:
        return basis
    largest = basis[np.argmax(np.abs(basis) > 0.999 * np.abs(basis).max(axis=0), axis=0), np.arange(basis.shape[1])]
    signed: Matrix = basis * np.where(largest < 0.0, -1.0, 1.0) + 0.0  # no -0
    return signed
