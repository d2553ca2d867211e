"""Proof of a γ in the coordinates of the filter that flies: no change of variables, no solver, only eigenvalues."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.multipliers import Multiplier
from fddbench.design.problem import ClosedLoop
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Certificate", "bounded_real", "certify", "robust_matrix"]


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """Eigenvalues that prove ``‖T‖∞ < γ`` for every plant of the set.

    Attributes
    ----------
    Pc : (n, n) array
        Lyapunov matrix of the closed loop (14).
    gamma : float
        The bound it proves [-].
    multiplier : Multiplier or None
        S and G; None for a polytope.
    smallest_Pc : float
        Smallest eigenvalue of Pc, must be positive.
    largest_robust : float
        Largest eigenvalue of (25), of (43) for a structured Δ, of (46) over all vertices; must be negative.
    largest_sampled : float
        Largest eigenvalue of (15) over the sampled members of the set; must be negative.
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
        return self.smallest_Pc > 0.0 and max(self.largest_robust, self.largest_sampled) < -self.rounding

    def require(self) -> "Certificate":
        """Return the certificate itself; a γ without proof is an error."""
        if self.holds:
            return self
        raise DesignError(
            f"gamma = {self.gamma:.6g} has no certificate: need Pc ≻ 0 (smallest eigenvalue {self.smallest_Pc:.3g}), "
            f"(25) ≺ 0 (largest {self.largest_robust:.3g}) and (15) ≺ 0 (largest of {self.n_sampled} samples "
            f"{self.largest_sampled:.3g}), beyond rounding {self.rounding:.1g}.\n"
            "Allow a larger gamma or scale states and signals to about one."
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
        robust = [bounded_real(StateSpace(loop.A, loop.B, loop.C, loop.D), P, gamma) for loop in loops]
    else:
        robust = [robust_matrix(loop, P, gamma, multiplier) for loop in loops]
    sampled = [bounded_real(member, P, gamma) for member in members]
    return Certificate(
        Pc=P,
        gamma=gamma,
        multiplier=multiplier,
        smallest_Pc=float(np.linalg.eigvalsh(P)[0]),
        largest_robust=max(_largest(matrix) for matrix in robust),
        largest_sampled=max((_largest(matrix) for matrix in sampled), default=-np.inf),
        rounding=max(len(matrix) * np.finfo(float).eps * float(np.linalg.norm(matrix, 2)) for matrix in robust),
        n_sampled=len(members),
    )


def _largest(symmetric: Floats) -> float:
    """Largest eigenvalue."""
    return float(np.linalg.eigvalsh(0.5 * (symmetric + symmetric.T))[-1])
