"""A residual generator, eqs (14) and (15), and the identity that it must keep."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.geometric.affine import at
from fddbench.design.geometric.solvability import Solvability
from fddbench.design.geometric.subspaces import Matrix

__all__ = ["ResidualGenerator", "identity_error"]


@dataclass(frozen=True, kw_only=True, eq=False)
class ResidualGenerator:
    """``w' = N(rho) w - G(rho) y + F(rho) u, r = M w - H y`` for one fault of a bank.

    With ``e = w - P x``: ``e' = N(rho) e - P L(rho) v, r = M e``; the other faults do not enter.

    Attributes
    ----------
    fault : str
        Its name.
    N, G, F : (n_parameters + 1, k, k), (n_parameters + 1, k, n_y), (n_parameters + 1, k, n_u) arrays
        Affine families, constant part first.
    M, H : (r, k), (r, n_y) matrices
    P : (k, n) matrix
        Projection along S*, the unobservability subspace of the other faults.
    PL : (n_parameters + 1, k, m) array
        How the fault enters; ``M N^-1 PL`` is the residual of a steady fault of size one.
    X : (k, k) matrix
        Lyapunov matrix of its stability.
    decay : float
        Decay rate that X proves [1/s].
    active : tuple of int
        Numbers, from 0, of the parameters that moved the filter before its gain.
    solvability : Solvability
        How well the fault can be told from the others.
    identity_error : float
        Largest misfit of ``N_j P = P A_j + G_j C``, relative to the size of the terms [-].
    """

    fault: str
    N: Matrix
    G: Matrix
    F: Matrix
    M: Matrix
    H: Matrix
    P: Matrix
    PL: Matrix
    X: Matrix
    decay: float
    active: tuple[int, ...]
    solvability: Solvability
    identity_error: float

    @property
    def order(self) -> int:
        """Number of states."""
        return int(self.N.shape[1])

    def steady_gain(self, rho: Matrix) -> Matrix:
        """Residual of steady faults of size one at a frozen rho, (r, m)."""
        gain: Matrix = self.M @ np.linalg.solve(at(self.N, rho), at(self.PL, rho))
        return gain


def identity_error(N: Matrix, G: Matrix, P: Matrix, A: Matrix, C: Matrix) -> float:
    """Largest misfit over j of ``N_j P = P A_j + G_j C``, relative to the largest term [-]: 0 decouples exactly.

    Parameters
    ----------
    N, G, A : (n_parameters + 1, …) arrays
        Families with the same parameters.
    """
    left, right = N @ P, (P @ A, G @ C)
    size = max(float(np.abs(term).max(initial=0.0)) for term in (left, *right))
    return float(np.abs(left - right[0] - right[1]).max(initial=0.0)) / size if size > 0.0 else 0.0
