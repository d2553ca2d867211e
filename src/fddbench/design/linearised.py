"""The linear inequalities (61) and (65) of Algorithm 1, with the scaling that makes it converge."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.design.lmi import FilterVariables, Margins, Solution, upper_part
from fddbench.design.multipliers import MultiplierVariables
from fddbench.design.problem import Augmented
from fddbench.design.solver import modelling, solve
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Freedom", "ReferenceVariables", "inequality_about", "sensitivity_about", "storage"]


@dataclass(frozen=True, kw_only=True)
class Freedom:
    """Which entries of T_ref may move, (11); the others keep their values.

    Attributes
    ----------
    A, B, C, D : boolean arrays
        Of the shapes of the reference.
    """

    A: Any
    B: Any
    C: Any
    D: Any

    @classmethod
    def diagonal(cls, reference: StateSpace) -> "Freedom":
        """Diagonal entries of A, C and D where they exist; B is fixed (Remark 8)."""
        A, C, D = (np.eye(*M.shape) != 0.0 for M in (reference.A, reference.C, reference.D))
        return cls(A=A, B=np.zeros(reference.B.shape, dtype=bool), C=C, D=D)

    @classmethod
    def triangular(cls, reference: StateSpace) -> "Freedom":
        """Entries on and below the diagonal of A, C and D, or above, where C or D has some there; a diagonal stays one.

        A reference with entries on both sides is free everywhere. B is fixed.
        """
        used = [M for M in (reference.A, reference.C, reference.D) if M.size]
        below, above = (any(np.any(side(M, k) != 0.0) for M in used) for side, k in ((np.tril, -1), (np.triu, 1)))
        shapes = {name: np.ones(getattr(reference, name).shape) for name in "ACD"}
        masks = {
            name: (np.eye(*M.shape) + below * np.tril(M, -1) + above * np.triu(M, 1)) != 0.0
            for name, M in shapes.items()
        }
        return cls(B=np.zeros(reference.B.shape, dtype=bool), **masks)


class ReferenceVariables:
    """A_ref, B_ref, C_ref, D_ref as cvxpy expressions that are free where `freedom` says so."""

    def __init__(self, reference: StateSpace, freedom: Freedom) -> None:
        self.A, self.B, self.C, self.D = (
            _masked(getattr(reference, name), np.asarray(getattr(freedom, name), dtype=bool)) for name in "ABCD"
        )

    def value(self) -> StateSpace:
        """Return the solution as a system."""
        return StateSpace(*(np.asarray(getattr(M, "value", M), dtype=float) for M in (self.A, self.B, self.C, self.D)))


def _masked(matrix: Floats, mask: Any) -> Any:
    """`matrix` with a variable in place of every entry where `mask` holds."""
    cp = modelling()
    if not mask.any():
        return matrix
    place = np.eye(matrix.size)[:, mask.ravel(order="F")]
    fixed = np.where(mask, 0.0, matrix)
    return fixed + cp.reshape(place @ cp.Variable(place.shape[1]), matrix.shape, order="F")


def _bilinear(augmented: Augmented, solution: Any, A: Any, B: Any, rows: int, stack: Any) -> tuple[Any, Any]:
    """Q and R of (59) with one column per reference state: the nonlinear terms of (37) are ``Q Rᵀ + R Qᵀ``."""
    n, n_v, E1 = len(augmented.A), augmented.B.shape[1], augmented.E1
    rest = np.zeros((rows - 2 * n, augmented.n_ref))
    Q = stack([[solution.Z @ E1], [solution.Y @ E1], [rest]])
    state = (A @ E1.T + B @ augmented.Wc).T
    R = stack([[state], [state], [(B @ augmented.Wd).T], [rest[n_v:]]])
    return Q, R


def inequality_about(
    augmented: Augmented,
    variables: FilterVariables,
    multiplier: MultiplierVariables,
    reference: ReferenceVariables,
    gamma: Any,
    about: tuple[Solution, StateSpace],
    scale: float,
    margins: Margins,
) -> list[Any]:
    """Constraint (66): (37) linearised about a solution and its reference, with ``scale Q, R / scale`` for Q, R.

    Q Rᵀ does not see the scale but the price ``(ΔQ - ΔR)(ΔQ - ΔR)ᵀ`` of a step does: a small one lets Z and Y move
    freely and holds A_ref and B_ref, a large one the other way round.
    """
    cp = modelling()
    frozen = np.zeros_like(about[1].A), np.zeros_like(about[1].B)
    quadruple = augmented.with_reference(*frozen, reference.C, reference.D)
    half = upper_part(augmented, quadruple, variables, multiplier, gamma)
    margin = margins.of_rows(half.shape[0], gamma)
    if not augmented.n_ref:
        return [half + half.T << -margin]
    Q, R = _bilinear(augmented, variables, reference.A, reference.B, half.shape[0], cp.bmat)
    Qo, Ro = _bilinear(augmented, about[0], about[1].A, about[1].B, half.shape[0], np.block)
    Q, Qo, R, Ro = scale * Q, scale * Qo, R / scale, Ro / scale
    Eo = Qo - Ro
    step = half + 0.5 * (Eo @ Eo.T) - (Q - R) @ Eo.T + 0.5 * margin
    unit = np.eye(augmented.n_ref)
    return [cp.bmat([[step + step.T, R, Q], [R.T, -unit, 0 * unit], [Q.T, 0 * unit, -unit]]) << 0]


def sensitivity_about(reference: ReferenceVariables, about: StateSpace, P: Floats) -> list[Any]:
    """Constraint (67), ``‖T_ref‖₋ ≥ 1`` linearised about a reference with its storage matrix P, (65)."""
    cp = modelling()
    U, Uo = cp.hstack([reference.C, reference.D]).T, np.hstack([about.C, about.D]).T
    n_ref, n_f = about.order, len(about.D)
    half = U @ Uo.T - 0.5 * (Uo @ Uo.T) - 0.5 * np.diag([0.0] * n_ref + [1.0] * n_f)
    if not n_ref:
        return [half + half.T >> 0]
    new = cp.Variable((n_ref, n_ref), symmetric=True)
    rest = np.zeros((n_f, n_ref))
    sizes = [max(float(np.linalg.norm(M)), 1e-3) for M in (np.hstack([about.A, about.B]), P)]
    scale = float(np.sqrt(sizes[0] / sizes[1]))
    Q, R = scale * cp.vstack([new, rest]), cp.vstack([reference.A.T, reference.B.T]) / scale
    Qo, Ro = scale * np.vstack([P, rest]), np.vstack([about.A.T, about.B.T]) / scale
    Fo = Qo + Ro
    half = half - 0.5 * (Fo @ Fo.T) + (Q + R) @ Fo.T
    unit = np.eye(n_ref)
    return [cp.bmat([[half + half.T, R, Q], [R.T, unit, 0 * unit], [Q.T, 0 * unit, unit]]) >> 0]


def storage(reference: StateSpace, solver: str) -> Floats:
    """P_ref of Lemma 3, (n_ref, n_ref): makes the smallest eigenvalue of (39) largest; it is 0 when ‖T_ref‖₋ = 1."""
    cp = modelling()
    n, n_f = reference.order, len(reference.D)
    if not n:
        return np.zeros((0, 0))
    P, slack = cp.Variable((n, n), symmetric=True), cp.Variable()
    U = np.hstack([reference.C, reference.D])
    half = cp.bmat([[P @ reference.A, P @ reference.B], [np.zeros((n_f, n + n_f))]])
    matrix = half + half.T + U.T @ U - np.diag([0.0] * n + [1.0] * n_f)
    goal = cp.Maximize(slack - 1e-6 * cp.norm(P, "fro"))
    solve(
        cp.Problem(goal, [matrix >> slack * np.eye(n + n_f), slack <= 1.0]),
        solver,
        "storage of T_ref (39)",
        infeasible="no P_ref",
    )
    return np.asarray(P.value, dtype=float)
