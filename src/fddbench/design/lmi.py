"""The synthesis inequalities (37), (38), (44) and (47) as cvxpy constraints."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.gramians import gramian
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.problem import Augmented, Filter
from fddbench.design.solver import modelling
from fddbench.interfaces import Floats

__all__ = ["EPSILON", "FilterVariables", "Margins", "Solution", "inequality", "positive", "upper_part"]

EPSILON = 1e-6
"""Margin that turns ≺ into ⪯, as a share of `Margins`; large beside the accuracy of a solver (1e-8), small beside γ."""


@dataclass(frozen=True, kw_only=True)
class Margins:
    """What a margin is a share of: the storage of the plant alone and what it loses, but at most one.

    A margin of the same size for all asks a slow or lightly damped mode for more than it can give: ``ZA + AᵀZ ⪯ -εI``
    with a decay of 0.002 rad/s makes Z, and with it γ, five hundred times as large as ε.

    Attributes
    ----------
    storage : (n_k, n_k) array
        Inverse reachability Gramian of the plant with its reference; Z of about this size bounds unit gains.
    loss : (n_k, n_k) array
        ``-(ZA + AᵀZ)`` for this storage, positive definite.
    n_signals : int
        Rows of v and r, whose margin is a share of γ.
    """

    storage: Floats
    loss: Floats
    n_signals: int

    @classmethod
    def of(cls, A: Floats, B: Floats, n_signals: int) -> "Margins":
        """Margins for the states of ``ξ' = A ξ + B v`` in coordinates where sizes are about one."""
        storage = np.asarray(np.linalg.inv(gramian(A, B, share=1e-4)), dtype=float)
        loss = -(storage @ A + A.T @ storage)
        return cls(storage=_at_most_one(storage), loss=_at_most_one(loss), n_signals=n_signals)

    def of_rows(self, n: int, level: Any) -> Any:
        """Margin of the n rows of (37), (44) or (47): (ξ, ξ̂), signals v and r with ``-γI``, channels w and z."""
        cp = modelling()
        rest = n - 2 * len(self.loss) - self.n_signals
        states, channels = EPSILON * block_diag(self.loss, self.loss), EPSILON * np.eye(rest)
        signals = 3.0 * EPSILON * level * np.eye(self.n_signals)
        sizes = (len(states), self.n_signals, rest)
        blocks = [[np.zeros((a, b)) for b in sizes] for a in sizes]
        for place, block in enumerate((states, signals, channels)):
            blocks[place][place] = block
        return cp.bmat([[block for block in row if block.shape[1]] for row in blocks if row[0].shape[0]])


def _at_most_one(definite: Floats) -> Floats:
    """Parallel sum of a positive definite matrix with the unit matrix: below both."""
    n = len(definite)
    bounded = np.linalg.solve(np.eye(n) + 0.5 * (definite + definite.T), 0.5 * (definite + definite.T))
    return np.asarray(0.5 * (bounded + bounded.T))


class FilterVariables:
    """Z, Y and the changed filter variables (36) as cvxpy variables; columns of B̂ and D̂ are (y, u)."""

    def __init__(self, augmented: Augmented) -> None:
        cp = modelling()
        n, n_m, n_f = len(augmented.A), len(augmented.Cm), len(augmented.Wc)
        self.Z, self.Y = cp.Variable((n, n), symmetric=True), cp.Variable((n, n), symmetric=True)
        self.A, self.B = cp.Variable((n, n)), cp.Variable((n, n_m))
        self.C, self.D = cp.Variable((n_f, n)), cp.Variable((n_f, n_m))

    def value(self, n_y: int) -> "Solution":
        """Return the solution as numbers."""
        Z, Y, A, B, C, D = (np.asarray(v.value, dtype=float) for v in (self.Z, self.Y, self.A, self.B, self.C, self.D))
        return Solution(Z=Z, Y=Y, A=A, B=B, C=C, D=D, n_y=n_y)


@dataclass(frozen=True, kw_only=True)
class Solution:
    """A point of the synthesis inequality: Z, Y, Â, B̂, Ĉ, D̂, with `n_y` outputs first in B̂ and D̂."""

    Z: Floats
    Y: Floats
    A: Floats
    B: Floats
    C: Floats
    D: Floats
    n_y: int

    def filter(self) -> Filter:
        """Undo (36) with ``N = Z - Y, Mᵀ = Z⁻¹``, which satisfies ``N Mᵀ = I - Y Z⁻¹`` without a factorisation."""
        N = self.Z - self.Y
        Ak, Bk = (np.asarray(np.linalg.solve(N, M), dtype=float) for M in (self.A, self.B))
        y, u = slice(None, self.n_y), slice(self.n_y, None)
        return Filter(Ak=Ak, Bky=Bk[:, y], Bku=Bk[:, u], Ck=self.C, Dky=self.D[:, y], Dku=self.D[:, u])

    def lyapunov(self) -> Floats:
        """Pc of (26) for that choice of N, (2 n_k, 2 n_k): ``[[Y, Z - Y], [Z - Y, Y - Z]]``."""
        N = self.Z - self.Y
        return np.block([[self.Y, N], [N, -N]])


def positive(variables: FilterVariables, margins: Margins) -> list[Any]:
    """Constraint (38), ``[[Z, Z], [Z, Y]] ≻ 0``, equivalent to ``Z ≻ 0`` and ``Y - Z ≻ 0``."""
    least = EPSILON * margins.storage
    return [variables.Z >> least, variables.Y - variables.Z >> least]


def inequality(matrix: Any, margins: Margins, level: Any) -> list[Any]:
    """``matrix + matrixᵀ ≺ 0`` for the matrix of `upper_part` with γ = level."""
    return [matrix + matrix.T << -margins.of_rows(matrix.shape[0], level)]


def upper_part(
    augmented: Augmented,
    reference: tuple[Any, Any, Any, Any],
    variables: FilterVariables,
    multiplier: MultiplierVariables | Multiplier,
    gamma: Any,
) -> Any:
    """Half of the matrix of (37), (44) or (47): it and its transpose add up to it.

    `reference` is the quadruple of `Augmented.with_reference`; the rows are (ξ, ξ̂, v, r, w, z), the last
    two only where the plant is uncertain.
    """
    cp = modelling()
    A, B, Cr, Dr = reference
    v, plant = variables, augmented
    n, n_v, n_f = len(plant.A), plant.B.shape[1], len(plant.Wc)
    n_z, n_w = plant.H.shape
    top, bottom = v.Z @ A, v.Y @ A + v.B @ plant.Cm
    error = v.D @ plant.Cm - Cr
    half_gamma = -0.5 * gamma
    rows = [
        [top, top, v.Z @ B, (error + v.C).T],
        [bottom + v.A, bottom, v.Y @ B + v.B @ plant.Dm, error.T],
        [np.zeros((n_v, n)), np.zeros((n_v, n)), half_gamma * np.eye(n_v), (v.D @ plant.Dm - Dr).T],
        [np.zeros((n_f, n)), np.zeros((n_f, n)), np.zeros((n_f, n_v)), half_gamma * np.eye(n_f)],
    ]
    if not n_z or not n_w:
        return cp.bmat(rows)
    S_w, S_z, G = multiplier.S_w, multiplier.S_z, multiplier.G
    rows[0] += [v.Z @ plant.F + plant.E.T @ G, plant.E.T @ S_z]
    rows[1] += [v.Y @ plant.F + v.B @ plant.Fm + plant.E.T @ G, plant.E.T @ S_z]
    rows[2] += [plant.Ev.T @ G, plant.Ev.T @ S_z]
    rows[3] += [v.D @ plant.Fm, np.zeros((n_f, n_z))]
    rows.append([np.zeros((n_w, 2 * n + n_v + n_f)), plant.H.T @ G - 0.5 * S_w, plant.H.T @ S_z])
    rows.append([np.zeros((n_z, 2 * n + n_v + n_f + n_w)), -0.5 * S_z])
    return cp.bmat(rows)
