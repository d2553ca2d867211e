"""What a closed loop loses and gains, as one inequality in a Lyapunov matrix and multipliers: the filter is given."""

from typing import Any

import numpy as np

from fddbench.design.multipliers import MultiplierVariables
from fddbench.design.problem import ClosedLoop
from fddbench.design.solver import modelling
from fddbench.interfaces import Floats

__all__ = ["gain_matrix", "stability_loop"]


def gain_matrix(P: Any, loop: ClosedLoop, S: MultiplierVariables, gamma: Any) -> Any:
    """Matrix of (25) or (43), negative definite where ``V = xᵀPx`` loses more than ``|r|²/γ - γ|v|²``, whatever Δ.

    Parameters
    ----------
    P : (n_x, n_x) cvxpy expression
    loop : ClosedLoop
        Any of its sizes may be zero; without residuals r what is left is stability, and the gain from v to V.
    S : MultiplierVariables
        For the blocks of Δ.
    gamma : number or cvxpy expression
    """
    cp = modelling()
    E, Ev, H = loop.Er1, loop.Er2, loop.H
    (n, v), (z, w), r = loop.B.shape, H.shape, len(loop.C)
    rows: list[list[Any]] = [
        [P @ loop.A, P @ loop.B, P @ loop.Fr1 + E.T @ S.G, E.T @ S.S_z, loop.C.T],
        [np.zeros((v, n)), -0.5 * gamma * np.eye(v), Ev.T @ S.G, Ev.T @ S.S_z, loop.D.T],
        [np.zeros((w, n + v)), H.T @ S.G - 0.5 * S.S_w, H.T @ S.S_z, loop.Fr2.T],
        [np.zeros((z, n + v + w)), -0.5 * S.S_z, np.zeros((z, r))],
        [np.zeros((r, n + v + w + z)), -0.5 * gamma * np.eye(r)],
    ]
    kept = [[block for block in row if block.shape[1]] for row, size in zip(rows, (n, v, w, z, r), strict=True) if size]
    half = cp.bmat(kept)
    return half + half.T


def stability_loop(A: Floats, F: Floats, E: Floats, H: Floats) -> ClosedLoop:
    """Loop of which only the states and the Δ channel count."""
    n, (n_z, n_w) = len(A), H.shape
    return ClosedLoop(
        A=A, B=np.zeros((n, 0)), C=np.zeros((0, n)), D=np.zeros((0, 0)),
        Fr1=F, Fr2=np.zeros((0, n_w)), Er1=E, Er2=np.zeros((n_z, 0)), H=H,
    )  # fmt: skip
