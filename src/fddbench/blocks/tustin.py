"""Small dense matrices of many cases at once, and Tustin's discretisation of them, in a fixed order of operations.

LAPACK and BLAS choose their kernels by processor and shape; what a flight flies with must not depend on either. Matrices
are (rows, columns, n_cases).
"""

import numpy as np
import numpy.typing as npt

from fddbench.blocks.linear import total

__all__ = ["identity", "inverse", "times", "tustin"]

Stacked = npt.NDArray[np.float64]


def identity(n: int) -> Stacked:
    """Unit matrix, (n, n, 1)."""
    return np.eye(n)[:, :, np.newaxis]


def times(a: Stacked, b: Stacked) -> Stacked:
    """Matrix product, (n, m, n_cases), of (n, k, n_cases or 1) and (k, m, n_cases or 1), summed left to right."""
    if not a.shape[1]:
        return np.zeros((a.shape[0], b.shape[1], max(a.shape[2], b.shape[2])))
    summed: Stacked = total([a[:, j, np.newaxis] * b[j] for j in range(a.shape[1])])
    return summed


def inverse(a: Stacked) -> Stacked:
    """Inverse, (n, n, n_cases), by Gauss-Jordan elimination down the diagonal.

    There is no search for a pivot: meant for matrices near the unit matrix, such as ``I - A T/2`` and ``I - Δ H``.
    Not finite where a pivot vanishes.
    """
    n = len(a)
    work = np.concatenate([a, np.broadcast_to(identity(n), a.shape)], axis=1)
    with np.errstate(all="ignore"):
        for j in range(n):
            pivot = work[j] / work[j, j]
            work = work - work[:, j, np.newaxis] * pivot
            work[j] = pivot
    return work[:, n:]


def tustin(
    A: Stacked, B: Stacked, C: Stacked, D: Stacked, *, sample_s: float
) -> tuple[Stacked, Stacked, Stacked, Stacked]:
    """Discrete-time matrices by the trapezoidal rule, s replaced by ``(2/T)(z - 1)/(z + 1)``.

    ``x[k+1] = A x[k] + B v[k]``, ``y[k] = C x[k] + D v[k]``; the state is not that of the continuous system, inputs and
    outputs are. The same matrices as ``scipy.signal.cont2discrete(..., method="bilinear")``.
    """
    half = (0.5 * sample_s) * A
    M = inverse(identity(len(A)) - half)
    Bd = sample_s * times(M, B)
    return times(M, identity(len(A)) + half), Bd, times(C, M), D + 0.5 * times(C, Bd)
