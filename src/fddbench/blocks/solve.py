"""Small systems of linear equations, one for each case, with pivots: the same bits wherever and beside whom it is solved.

LAPACK chooses its kernels by processor and shape. Here the pivot is found by exchanging rows with `where`, so there is no index
that depends on data and a step may solve too.
"""

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["solve"]


def solve(A: Rows, b: Rows) -> Rows:
    """Solution x of ``A x = b``, (n, n_cases), by Gauss' elimination with partial pivoting.

    For matrices near the unit matrix `fddbench.blocks.tustin.inverse` does without the exchanges. Cost: about ``n^3``
    selections and ``2 n^3 / 3`` operations.

    Parameters
    ----------
    A : (n, n, n_cases or 1) rows
        Not finite in the solution of a case where it is singular.
    b : (n, n_cases or 1) rows
        Right-hand side.

    References
    ----------
    Golub, Van Loan (2013), Matrix Computations, 4th edition, section 3.4.

    Examples
    --------
    >>> A = np.array([[[0.0], [2.0]], [[4.0], [1.0]]])
    >>> solve(A, np.array([[2.0], [5.0]])).ravel()
    array([1., 1.])
    """
    n = len(A)
    rows = [[*(A[i, j] for j in range(n)), b[i]] for i in range(n)]
    with np.errstate(all="ignore"):  # a singular matrix shows as a solution that is not finite
        for k in range(n):
            _eliminate(rows, k)
        return np.stack(np.broadcast_arrays(*_back(rows)))


def _eliminate(rows: list[list[Rows]], k: int) -> None:
    """Bring the largest number of column k to its diagonal, and make those below it zero."""
    for i in range(k + 1, len(rows)):
        larger: Rows = np.abs(rows[i][k]) > np.abs(rows[k][k])
        for j in range(k, len(rows[k])):
            upper, lower = rows[k][j], rows[i][j]
            rows[k][j], rows[i][j] = np.where(larger, lower, upper), np.where(larger, upper, lower)
    for i in range(k + 1, len(rows)):
        factor = rows[i][k] / rows[k][k]
        for j in range(k + 1, len(rows[k])):
            rows[i][j] = rows[i][j] - factor * rows[k][j]


def _back(rows: list[list[Rows]]) -> list[Rows]:
    """Solution of a triangular system, from the last row up."""
    n = len(rows)
    x: list[Rows] = [None] * n
    for i in reversed(range(n)):
        rest = rows[i][n]
        for j in range(i + 1, n):
            rest = rest - rows[i][j] * x[j]
        x[i] = rest / rows[i][i]
    return x
