"""Quadratic stability of a system with its uncertainty, as one inequality in a Lyapunov matrix and multipliers."""

from typing import Any

import numpy as np

from fddbench.design.multipliers import MultiplierVariables
from fddbench.design.solver import modelling
from fddbench.interfaces import Floats

__all__ = ["gain_matrix"]


def gain_matrix(
    P: Any, A: Floats, B: Floats, channel: tuple[Floats, Floats, Floats, Floats], S: MultiplierVariables, gamma: Any
) -> Any:
    """Matrix that is negative definite where ``V = xᵀPx`` falls but for ``γ|v|²``, whatever Δ: (25) without its residual.

    Parameters
    ----------
    P : (n_x, n_x) cvxpy expression
    A, B : (n_x, n_x), (n_x, n_v) arrays
        ``x' = A x + B v + F w``; n_x and n_v may be zero.
    channel : (F, E, Ev, H)
        (n_x, n_w), (n_z, n_x), (n_z, n_v), (n_z, n_w) arrays, ``z = E x + Ev v + H w``.
    S : MultiplierVariables
        For the blocks of Δ.
    gamma : number or cvxpy expression
    """
    cp = modelling()
    F, E, Ev, H = channel
    (n, v), (z, w) = B.shape, H.shape
    rows: list[list[Any]] = [
        [P @ A, P @ B, P @ F + E.T @ S.G, E.T @ S.S_z],
        [np.zeros((v, n)), -0.5 * gamma * np.eye(v), Ev.T @ S.G, Ev.T @ S.S_z],
        [np.zeros((w, n + v)), H.T @ S.G - 0.5 * S.S_w, H.T @ S.S_z],
        [np.zeros((z, n + v + w)), -0.5 * S.S_z],
    ]
    kept = [[block for block in row if block.shape[1]] for row, size in zip(rows, (n, v, w, z), strict=True) if size]
    half = cp.bmat(kept)
    return half + half.T
