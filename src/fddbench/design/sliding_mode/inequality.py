"""The bounded-real inequality of the error system as one that is linear in all unknowns but T.

With ``zeta = e1 + T d`` and ``V = zeta' P1 zeta + d' Pd d``, that is P = [P1, P1 T; T' P1, Pd + T' P1 T], every positive
definite P has this form. L moves e1 alone, so that for fixed T the inequality is linear in P1, Pd, Y = P1 L1, W1 and γ.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.design.sliding_mode.error_system import ErrorSystem, Pair
from fddbench.interfaces import Floats

__all__ = ["Point", "Vertex", "assemble", "point_of", "vertex"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Vertex:
    """Numbers of the inequality at one vertex; the e1 rows in units of `scale`, faults in units of theirs.

    Attributes
    ----------
    a : tuple of arrays
        Ã11, Ã12 E, M1.
    seen : tuple of arrays
        What W1 and L1 multiply: blind Ã21, blind (Ã22 + a_f I) E, blind M2, blind E.
    told : tuple of arrays
        The same with the inverse of F2 from the left.
    a_f : float
        Pole of the corruption [1/s].
    """

    a: tuple[Floats, Floats, Floats]
    seen: tuple[Floats, Floats, Floats, Floats]
    told: tuple[Floats, Floats, Floats, Floats]
    a_f: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """Unknowns of the inequality, as cvxpy variables or as numbers: P1, Pd, Y = P1 L1, W1, γ, and T."""

    P1: Any
    Pd: Any
    Y: Any
    W1: Any
    gamma: Any
    T: Any


def vertex(system: ErrorSystem, rho: Floats, scale: Floats) -> Vertex:
    """Numbers at one vertex of the box; `scale` is the size of each row of e1."""
    form, w, E, n_1 = system.form, system.weights, system.shown, system.form.n_1
    A11, A12, A21, A22 = form.split(rho)
    M = form.M * w.uncertainty
    inner = 1.0 / scale[:, np.newaxis]
    seen = (A21 * scale, (A22 + w.corruption_pole_1_s * np.eye(len(A22))) @ E, M[n_1:], E)
    told = form.F2_left / w.fault[:, np.newaxis]
    return Vertex(
        a=(inner * A11 * scale, inner * A12 @ E, inner * M[:n_1]),
        seen=tuple(form.blind @ part for part in seen),  # type: ignore[arg-type]
        told=tuple(told @ part for part in seen),  # type: ignore[arg-type]
        a_f=w.corruption_pole_1_s,
    )


def assemble(at: Vertex, x: Point, block: Callable[[list[list[Any]]], Any]) -> Any:
    """Matrix that is negative definite where V proves γ, rows (zeta, d, xi, phi, error).

    Parameters
    ----------
    at : Vertex
    x : Point
    block : function
        `cvxpy.bmat` or `numpy.block`.
    """
    (a11, a12, m1), (b21, b22, bm, be), (f21, f22, fm, fe), a_f = at.a, at.seen, at.told, at.a_f
    n_1, n_d, n_xi, q = len(a11), a12.shape[1], m1.shape[1], len(f21)
    error_d = (f22 + x.W1 @ b22).T
    rows: dict[tuple[int, int], Any] = {
        (1, 1): -a_f * x.Pd,
        (1, 3): a_f * x.Pd,
        (1, 4): -error_d,
        (2, 2): -0.5 * x.gamma * np.eye(n_xi),
        (2, 4): (fm + x.W1 @ bm).T,
        (3, 3): -0.5 * x.gamma * np.eye(n_d),
        (3, 4): a_f * (fe + x.W1 @ be).T,
        (4, 4): -0.5 * x.gamma * np.eye(q),
    }
    if n_1:
        hidden, error_1 = x.P1 @ a11 + x.Y @ b21, f21 + x.W1 @ b21
        rows |= {
            (0, 0): hidden,
            (0, 1): x.P1 @ a12 + x.Y @ b22 - hidden @ x.T - a_f * (x.P1 @ x.T),
            (0, 2): -(x.P1 @ m1 + x.Y @ bm),
            (0, 3): a_f * (x.P1 @ x.T - x.Y @ be),
            (0, 4): -error_1.T,
            (1, 4): (error_1 @ x.T).T - error_d,
        }
    sizes = [n_1, n_d, n_xi, n_d, q]
    kept = [i for i, size in enumerate(sizes) if size]
    half = block([[rows.get((i, j), np.zeros((sizes[i], sizes[j]))) for j in kept] for i in kept])
    return half + half.T


def point_of(system: ErrorSystem, x: Point, scale: Floats) -> tuple[Pair, Floats]:
    """The pair (L, W) of a solution, and P of V in the coordinates [e1; d] of `ErrorSystem.at`."""
    form, inner = system.form, np.diag(1.0 / scale)
    L1 = np.linalg.solve(x.P1, x.Y) if form.n_1 else np.zeros((0, len(form.blind)))
    W = form.F2_left + system.weights.fault[:, np.newaxis] * (x.W1 @ form.blind)
    P1, T = inner @ x.P1 @ inner, np.diag(scale) @ x.T
    P = np.block([[P1, P1 @ T], [T.T @ P1, x.Pd + T.T @ P1 @ T]])
    return Pair(L=np.diag(scale) @ L1 @ form.blind, W=W), P
