"""The gain that makes a residual generator quadratically stable, eq (16): assigned where its state is seen, else by an LMI."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.geometric.affine import Box, at
from fddbench.design.geometric.subspaces import Matrix
from fddbench.design.solver import modelling, solve
from fddbench.errors import DesignError

__all__ = ["Stabilised", "stabilise"]

_MOST = 10
"""Most parameters whose corners make an LMI: 1024 of them."""
_MARGIN = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Stabilised:
    """A gain and its proof.

    Attributes
    ----------
    D1 : (n_parameters + 1, k, r) array
        Affine gain; ``N(rho) = A0(rho) + D1(rho) M``.
    X : (k, k) matrix
        ``N' X + X N + 2 decay X <= 0`` at every corner, so ``|w|`` decays at least as ``exp(-decay t)`` for any rho(t).
    active : tuple of int
        Numbers, from 0, of the parameters that really move A0; the LMI has 2^len(active) corners.
    """

    D1: Matrix
    X: Matrix
    active: tuple[int, ...]


def stabilise(A0: Matrix, M: Matrix, box: Box, *, decay: float, solver: str = "CLARABEL") -> Stabilised:
    """Gain D1 for ``N(rho) = A0(rho) + D1(rho) M``.

    Where M shows the whole of w (it is injective), ``N = -decay I`` is assigned, whatever rho does. Elsewhere ``X = X'`` and
    ``K = X D1`` solve eq (A16) with the decay at the corners of the active parameters, with X as near to the unit matrix, and
    K as small, as may be.

    Parameters
    ----------
    A0 : (n_parameters + 1, k, k) array
    M : (r, k) matrix
    decay : float
        Least decay rate of the error [1/s].

    Raises
    ------
    DesignError
        No such gain exists, with the decay that was asked.
    """
    active, k = box.active(A0), A0.shape[1]
    if np.linalg.matrix_rank(M) == k:
        wanted = np.zeros_like(A0)
        wanted[0] = -decay * np.eye(k)
        return Stabilised(D1=(wanted - A0) @ np.linalg.pinv(M), X=np.eye(k), active=active)
    if len(active) > _MOST:
        raise DesignError(
            f"the residual generator depends on {len(active)} parameters, which is {2 ** len(active)} corners of an LMI; at "
            f"most {_MOST} are possible. Freeze those that move A least"
        )
    own = [0, *(j + 1 for j in active)]
    X, K = _solved(box.normalised(A0)[own], M, decay, solver)
    gains = np.zeros((len(A0), k, len(M)))
    gains[own] = np.linalg.solve(X, K)
    D1 = box.restored(gains)
    _prove(A0 + D1 @ M, X, decay, box, active)
    return Stabilised(D1=D1, X=X, active=active)


def _solved(A0: Matrix, M: Matrix, decay: float, solver: str) -> tuple[Matrix, Matrix]:
    """X and K of parameters between -1 and 1."""
    cp, k = modelling(), A0.shape[1]
    size = max(float(np.abs(A0).max()), decay, 1e-12)  # in units of time in which the matrices are about one
    X, bound, effort = cp.Variable((k, k), symmetric=True), cp.Variable(), cp.Variable()
    K = [cp.Variable((k, len(M))) for _ in A0]
    constraints = [X >> np.eye(k), X << bound * np.eye(k), cp.norm(cp.hstack(K), 2) <= effort]
    signs = Box(-np.ones(len(A0) - 1), np.ones(len(A0) - 1)).corners()
    for corner in signs:
        A = at(A0, corner) / size
        KM = (K[0] + sum(float(s) * K[j + 1] for j, s in enumerate(corner))) @ M
        inside = A.T @ X + X @ A + KM.T + KM + (2.0 * decay / size) * X
        constraints.append(inside << -_MARGIN * np.eye(k))
    problem = cp.Problem(cp.Minimize(bound + 0.1 * effort), constraints)
    refusal = (
        f"no gain makes it quadratically stable with decay {decay:g} 1/s for every rho(t) in the box; ask for a smaller decay "
        "or a smaller box"
    )
    solve(problem, solver, "the gain of the residual generator", infeasible=refusal)
    return np.asarray(X.value, dtype=float), np.stack([np.asarray(each.value, dtype=float) * size for each in K])


def _prove(N: Matrix, X: Matrix, decay: float, box: Box, active: tuple[int, ...]) -> None:
    """Evaluate the inequality with the numbers that were found: what a solver says is no proof."""
    for rho in box.corners(active):
        inside = at(N, rho).T @ X + X @ at(N, rho) + 2.0 * decay * X
        if np.linalg.eigvalsh(inside)[-1] > 0.0:
            raise DesignError(
                "the gain of the residual generator does not keep its inequality at a corner of the box: the numbers are too "
                "badly scaled. Scale states and parameters to about one"
            )
