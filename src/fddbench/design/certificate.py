"""Proof of a γ in the coordinates of the filter that flies: no change of variables, no solver, only eigenvalues."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from fddbench.design.multipliers import Multiplier
from fddbench.design.problem import ClosedLoop
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Certificate", "bounded_real", "certify", "definite", "robust_matrix"]

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """Eigenvalues that prove ``‖T‖∞ < γ`` for every plant of the set.

    A matrix is as definite as ``D M D`` is for any diagonal D. With unit diagonals eigenvalues are relative margins, the
    same in all units of states and signals.

    Attributes
    ----------
    Pc : (n, n) array
        Lyapunov matrix of the closed loop (14).
    gamma : float
        The bound it proves [-].
    multiplier : Multiplier or None
        S and G; None for a polytope.
    smallest_Pc : float
        Smallest eigenvalue of Pc with its diagonal scaled to one, must be positive.
    largest_robust : float
        Largest eigenvalue of (25), of (43) for a structured Δ, of (46) over all vertices, with their diagonals scaled to
        minus one; must be negative.
    largest_sampled : float
        The same of (15) over the sampled members of the set; must be negative.
    rounding : float
        Bound of the rounding errors of these eigenvalues; they must clear it.
    n_sampled : int
        Members of the set that were sampled.
    """

    Pc: Floats
    gamma: float
    multiplier: Multiplier | None
    smallest_Pc: float
    largest_robust: float
    largest_sampled: float
    rounding: float
    n_sampled: int

    @property
    def holds(self) -> bool:
        """Whether every eigenvalue has its sign by more than rounding."""
        return self.smallest_Pc > len(self.Pc) * EPS and max(self.largest_robust, self.largest_sampled) < -self.rounding

    def require(self) -> "Certificate":
        """Return the certificate itself; a γ without proof is an error."""
        if self.holds:
            return self
        raise DesignError(
            f"gamma = {self.gamma:.6g} has no certificate: need Pc ≻ 0 (smallest eigenvalue {self.smallest_Pc:.3g}), "
            f"(25) ≺ 0 (largest {self.largest_robust:.3g}) and (15) ≺ 0 (largest of {self.n_sampled} samples "
            f"{self.largest_sampled:.3g}), beyond rounding {self.rounding:.1g}, all relative to their diagonals.\n"
            "Allow a larger gamma, or try another solver."
        )


def bounded_real(system: StateSpace, P: Floats, gamma: float) -> Floats:
    """Matrix of the bounded real lemma (15)."""
    n_v, n_r = system.D.shape[1], system.D.shape[0]
    return np.block([
        [system.A.T @ P + P @ system.A, P @ system.B, system.C.T],
        [system.B.T @ P, -gamma * np.eye(n_v), system.D.T],
        [system.C, system.D, -gamma * np.eye(n_r)],
    ])  # fmt: skip


def robust_matrix(loop: ClosedLoop, P: Floats, gamma: float, multiplier: Multiplier) -> Floats:
    """Matrix of (25) for ``S = λI, G = 0``, of (43) otherwise, with the rows of Δ multiplied by S."""
    nominal = bounded_real(StateSpace(loop.A, loop.B, loop.C, loop.D), P, gamma)
    S_w, S_z, G, H = multiplier.S_w, multiplier.S_z, multiplier.G, loop.H
    seen = np.vstack([loop.Er1.T, loop.Er2.T, np.zeros((len(loop.C), len(H)))])
    entered = np.vstack([P @ loop.Fr1, np.zeros((loop.B.shape[1], H.shape[1])), loop.Fr2]) + seen @ G
    return np.block([
        [nominal, entered, seen @ S_z],
        [entered.T, H.T @ G + G.T @ H - S_w, H.T @ S_z],
        [S_z @ seen.T, S_z @ H, -S_z],
    ])  # fmt: skip


def certify(
    loops: tuple[ClosedLoop, ...], P: Floats, gamma: float, multiplier: Multiplier | None, members: list[StateSpace]
) -> Certificate:
    """Eigenvalues of everything that must be definite.

    Parameters
    ----------
    loops : tuple of ClosedLoop
        One with its Δ channel, or the vertices of a polytope.
    P : (n, n) array
        Candidate Lyapunov matrix.
    gamma : float
        Bound to prove [-].
    multiplier : Multiplier or None
        None for a polytope or a certain plant.
    members : list of StateSpace
        Sampled closed loops for (15).
    """
    if multiplier is None:
        plain = [StateSpace(loop.A, loop.B, loop.C, loop.D) for loop in loops]
        robust = [(bounded_real(system, P, gamma), _magnitude(system, P, gamma)) for system in plain]
    else:
        robust = [
            (robust_matrix(loop, P, gamma, multiplier), robust_matrix(_sized(loop), abs(P), gamma, _sized(multiplier)))
            for loop in loops
        ]
    sampled = [(bounded_real(member, P, gamma), _magnitude(member, P, gamma)) for member in members]
    eigenvalues = [(_largest(matrix), _rounding(matrix, terms)) for matrix, terms in robust + sampled]
    return Certificate(
        Pc=P,
        gamma=gamma,
        multiplier=multiplier,
        smallest_Pc=-_largest(-P),
        largest_robust=max(value for value, _ in eigenvalues[: len(robust)]),
        largest_sampled=max((value for value, _ in eigenvalues[len(robust) :]), default=-np.inf),
        rounding=max(rounding for _, rounding in eigenvalues),
        n_sampled=len(members),
    )


def definite(symmetric: Floats) -> bool:
    """Whether a matrix is positive definite by more than the rounding of its eigenvalues, whatever its units."""
    return _largest(-symmetric) < -8.0 * len(symmetric) * EPS if len(symmetric) else True


def _sized(record: Any) -> Any:
    """The record with the absolute values of its matrices."""
    return replace(record, **{field.name: np.abs(getattr(record, field.name)) for field in fields(record)})


def _magnitude(system: StateSpace, P: Floats, gamma: float) -> Floats:
    """Sums of the absolute values of the terms of (15)."""
    return bounded_real(_sized(system), np.abs(P), gamma)


def _scale(symmetric: Floats) -> Floats:
    """Factors that make the diagonal plus or minus one; one where it is zero."""
    diagonal = np.sqrt(np.abs(np.diag(symmetric)))
    return 1.0 / np.where(diagonal > 0.0, diagonal, 1.0)


def _largest(symmetric: Floats) -> float:
    """Largest eigenvalue of a matrix with its diagonal scaled to size one."""
    scale = _scale(symmetric)
    return float(np.linalg.eigvalsh(0.5 * (symmetric + symmetric.T) * np.outer(scale, scale))[-1])


def _rounding(symmetric: Floats, terms: Floats) -> float:
    """Bound of what rounding moves the eigenvalues of the scaled matrix by, its entries being sums of `terms`."""
    scale, n = _scale(symmetric), len(symmetric)
    return n * EPS * float(np.linalg.norm((np.abs(symmetric) + np.abs(terms)) * np.outer(scale, scale), 2))
