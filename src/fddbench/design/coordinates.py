"""Coordinates in which the inequalities are solved: states of about the same size in and out."""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag, cholesky, solve_continuous_lyapunov, svd

from fddbench.design.problem import Augmented
from fddbench.interfaces import Floats

__all__ = ["balancing", "transformed"]

REGULAR = 1e-4
"""Share of the mean added to the diagonals of both Gramians: bounds the condition of T for states hardly moved."""


def balancing(augmented: Augmented) -> Floats:
    """T with ``ξ = T η`` that balances the states of plant and weights, (n_k, n_k); those of the reference stay.

    Both Gramians, from (v, w) and to (y, u, faults, z), become the same diagonal matrix up to the regularisation.

    References
    ----------
    Moore (1981), Principal component analysis in linear systems: controllability, observability, and model reduction,
    IEEE Transactions on Automatic Control 26(1), 17-32.
    """
    own = slice(augmented.n_ref, None)
    A, B = augmented.A[own, own], np.hstack([augmented.B, augmented.F])[own]
    C = np.vstack([augmented.Cm, augmented.Wc, augmented.E])[:, own]
    if not len(A):
        return np.eye(len(augmented.A))
    moved, seen = (
        _regular(np.asarray(solve_continuous_lyapunov(M, -Q), dtype=float)) for M, Q in ((A, B @ B.T), (A.T, C.T @ C))
    )
    root = cholesky(moved, lower=True)
    values, right = svd(root.T @ seen @ root)[1:]
    T = root @ right.T / values**0.25
    return np.asarray(block_diag(np.eye(augmented.n_ref), T), dtype=float)


def _regular(gramian: Floats) -> Floats:
    """Add a floor to a Gramian."""
    n = len(gramian)
    return np.asarray(0.5 * (gramian + gramian.T) + REGULAR * max(np.trace(gramian) / n, 1e-8) * np.eye(n))


def transformed(augmented: Augmented, T: Floats) -> Augmented:
    """Return the same system with the states η of ``ξ = T η``."""
    inverse = np.linalg.inv(T)
    return replace(
        augmented,
        A=inverse @ augmented.A @ T,
        B=inverse @ augmented.B,
        F=inverse @ augmented.F,
        Cm=augmented.Cm @ T,
        E=augmented.E @ T,
        Wc=augmented.Wc @ T,
    )
