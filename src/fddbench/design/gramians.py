"""How much inputs move states and states move outputs, and the states in which both are the same."""

import numpy as np
import numpy.typing as npt
from scipy.linalg import cholesky, matrix_balance, solve_continuous_lyapunov, svd

from fddbench.interfaces import Floats

__all__ = ["balancing", "coarse", "gramian", "input_normal"]

REGULAR = 1e-4
"""Share of the mean added to the diagonals of both Gramians: bounds the condition of T for states hardly moved."""

COARSE = 32.0
"""Step of scale factors: products with them are exact."""


def gramian(A: Floats, B: Floats, share: float = 0.0) -> Floats:
    """``A W + W Aᵀ = -(B Bᵀ + share trace(B Bᵀ)/n I)`` for stable A, (n, n); states are scaled before it is solved."""
    if not len(A):
        return np.zeros((0, 0))
    scale = np.asarray(matrix_balance(A, permute=False, separate=True)[1][0], dtype=float)
    even, driven = A * scale / scale[:, None], B / scale[:, None]
    Q = driven @ driven.T
    Q += share * (np.trace(Q) or 1.0) / len(A) * np.eye(len(A))
    W = np.asarray(solve_continuous_lyapunov(even, -Q), dtype=float)
    return np.asarray(scale[:, None] * (0.5 * (W + W.T)) * scale)


def balancing(A: Floats, B: Floats, C: Floats) -> Floats:
    """T with ``ξ = T η`` that balances the states, (n, n): both Gramians become the same diagonal matrix but for a floor.

    States are first scaled one by one, so that the floor means the same in all units.

    References
    ----------
    Moore (1981), Principal component analysis in linear systems: controllability, observability, and model reduction,
    IEEE Transactions on Automatic Control 26(1), 17-32.
    """
    if not len(A):
        return np.eye(0)
    moved, seen = gramian(A, B), gramian(A.T, C.T)
    reach, sight = (np.sqrt(np.abs(np.diag(W))) for W in (moved, seen))
    own = coarse(np.sqrt(np.divide(reach, sight, out=np.zeros(len(A)), where=sight > 0.0)))
    moved, seen = _regular(moved / own[:, None] / own), _regular(own[:, None] * seen * own)
    root = cholesky(moved, lower=True)
    values, right = svd(root.T @ seen @ root)[1:]
    return np.asarray(own[:, None] * (root @ right.T / values**0.25), dtype=float)


def input_normal(A: Floats, B: Floats, share: float) -> Floats:
    """T with ``ξ = T η`` whose reachability Gramian is the unit matrix, (n, n), so that ``A + Aᵀ`` is negative definite.

    In these states a storage of about one is natural, however slow or lightly damped a mode is.
    """
    if not len(A):
        return np.eye(0)
    own = balancing(A, B, np.eye(len(A)))
    inverse = np.asarray(np.linalg.inv(own), dtype=float)
    W = gramian(inverse @ A @ own, inverse @ B, share)
    return np.asarray(own @ cholesky(W, lower=True), dtype=float)


def coarse(sizes: npt.ArrayLike) -> Floats:
    """Powers of 32 next to the sizes, one in place of zero: what is of about size one already stays as it is."""
    given = np.asarray(sizes, dtype=float)
    return np.asarray(COARSE ** np.round(np.log(np.where(given > 0.0, given, 1.0)) / np.log(COARSE)))


def _regular(symmetric: Floats) -> Floats:
    """Add a floor to a Gramian."""
    n = len(symmetric)
    floor = REGULAR * (np.trace(symmetric) / n or 1.0)
    return np.asarray(0.5 * (symmetric + symmetric.T) + floor * np.eye(n))
