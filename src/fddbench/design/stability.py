"""Quadratic stability where no norm decides it: found and checked, or refused with the proof that there is none."""

from typing import Any

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.certificate import definite
from fddbench.design.coordinates import channel_units
from fddbench.design.gramians import input_normal
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.norms import hinf_norm
from fddbench.design.quadratic import gain_matrix, stability_loop
from fddbench.design.solver import attempt, modelling
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["require_common_lyapunov", "require_multipliers"]

SOLVED = ("optimal", "optimal_inaccurate")
"""A point of these is worth checking; it is the check that counts."""


def require_multipliers(plant: UncertainPlant, blocks: tuple[Block, ...], solver: str) -> None:
    """Refuse a structured Δ that is ill-posed or destabilises, by example, or that no multipliers were found for (Lemma 5)."""
    inputs, seen = np.hstack([plant.Bf, plant.Bd, plant.B]), np.hstack([plant.Ef, plant.Ed, plant.EB])
    w, z = channel_units(plant.A, inputs, plant.EA, seen, blocks)
    H, F, E = z[:, None] * plant.H / w, plant.FA / w, z[:, None] * plant.EA
    T = input_normal(plant.A, np.hstack([inputs, F]), share=1e-2)
    inverse = np.linalg.inv(T)
    if hinf_norm(StateSpace(inverse @ plant.A @ T, inverse @ F, E @ T, H)).value < 1.0:
        return  # stable for the whole ball
    if _multipliers(inverse @ plant.A @ T, inverse @ F, E @ T, H, blocks, solver):
        return
    corners = sample_delta(blocks, 400, seed=0)
    sizes = [_largest_real(plant.H @ delta) for delta in corners]
    if max(sizes) >= 1.0:
        delta = corners[int(np.argmax(sizes))] / max(sizes)
        raise DesignError(
            f"Δ(I - HΔ)⁻¹ is ill-posed: Δ = {np.round(delta, 4).tolist()} makes I - HΔ singular.\n"
            "Make the uncertainty smaller: H."
        )
    growth = [float(np.linalg.eigvals(plant.at(delta).A).real.max(initial=-np.inf)) for delta in corners]
    worst = int(np.argmax(growth))
    if growth[worst] >= 0.0:
        raise DesignError(
            f"the plant is unstable for a Δ of this structure: Δ = {np.round(corners[worst], 4).tolist()} gives it a pole "
            f"with real part {growth[worst]:.4g}. Make the uncertainty smaller: FA or EA."
        )
    raise DesignError(
        f"{solver} did not find multipliers that prove quadratic stability for this structure of Δ. No Δ that destabilises "
        f"was found either, the slowest of {len(corners)} has a pole with real part {growth[worst]:.4g}; Lemma 5 is only "
        "sufficient.\nMake FA or EA smaller, or use a polytope."
    )


def _largest_real(matrix: Floats) -> float:
    """Largest real eigenvalue, 0 when there is none."""
    values = np.linalg.eigvals(matrix)
    real = values.real[np.abs(values.imag) <= 1e-9 * np.abs(values)]
    return float(real.max(initial=0.0))


def _multipliers(A: Floats, F: Floats, E: Floats, H: Floats, blocks: tuple[Block, ...], solver: str) -> bool:
    """Whether P ≻ 0 and S ≻ 0 are found that satisfy the stability part of (43), checked by eigenvalues."""
    cp = modelling()
    n, (n_z, n_w) = len(A), H.shape
    S, t = MultiplierVariables(blocks), cp.Variable()
    P: Any = cp.Variable((n, n), symmetric=True) if n else np.zeros((0, 0))
    matrix = gain_matrix(P, stability_loop(A, F, E, H), S, 1.0)
    margin = block_diag(-(A + A.T), np.eye(n_w + n_z))
    bounded = [S.S_w << np.eye(n_w), *([P >> t * np.eye(n), P << np.eye(n)] if n else [])]
    if (
        attempt(cp.Problem(cp.Maximize(t), [matrix << -t * margin, *bounded]), solver, "quadratic stability")
        not in SOLVED
    ):
        return False
    found: Multiplier = S.value()
    value = np.asarray(matrix.value, dtype=float)
    signs = [definite(-value), definite(found.S_w), definite(found.S_z), not n or definite(np.asarray(P.value))]
    return all(signs)


def require_common_lyapunov(plants: tuple[UncertainPlant, ...], solver: str) -> None:
    """Refuse a polytope without a common Lyapunov matrix ``A_iᵀP + P A_i ≺ 0``, with the proof that there is none.

    Solved in states in which the first vertex has a Lyapunov matrix of ones: a common P then has a margin that means
    something, however slow or lightly damped a mode is. What is found is checked, so an inaccurate point counts too.
    """
    cp = modelling()
    if len(plants) == 1 or not plants[0].n_x:
        return
    first = plants[0]
    T = input_normal(first.A, np.hstack([first.Bf, first.Bd, first.B]), share=1e-2)
    inverse = np.linalg.inv(T)
    A = [np.asarray(inverse @ plant.A @ T, dtype=float) for plant in plants]
    n = first.n_x
    P, t = cp.Variable((n, n), symmetric=True), cp.Variable()
    loss = -(A[0] + A[0].T)
    falls = [M.T @ P + P @ M << -t * loss for M in A]
    goal = cp.Problem(cp.Maximize(t), [*falls, P >> t * np.eye(n), P << np.eye(n)])
    if attempt(goal, solver, "quadratic stability") in SOLVED:
        found = np.asarray(P.value, dtype=float)
        if definite(found) and all(definite(-(M.T @ found + found @ M)) for M in A):
            return
    level = _farkas(A, solver)
    if level is not None:
        raise DesignError(
            f"the polytope of {len(plants)} vertices is not quadratically stable: no P ≻ 0 makes A_iᵀP + PA_i ≺ 0 for all of "
            f"them. Proof: there are X_i ⪰ 0 with Σ(A_i X_i + X_i A_iᵀ) ⪰ {level:.3g} I, trace Σ X_i = 1.\n"
            "Take vertices that lie closer together, or split the set and design one filter for each part."
        )
    raise DesignError(
        f"{solver} did not find a P ≻ 0 with A_iᵀP + PA_i ≺ 0 for all {len(plants)} vertices of the polytope, and no proof "
        "that there is none.\nTry another solver, vertices that lie closer together, or one filter for each part of the set."
    )


def _farkas(A: list[Floats], solver: str) -> float | None:
    """Largest t with ``Σ(A_i X_i + X_i A_iᵀ) ⪰ t I``, ``X_i ⪰ 0`` of trace one together, checked; None unless t > 0.

    Then trace(P Σ(A_i X_i + X_i A_iᵀ)) > 0 for every P ≻ 0, while A_iᵀP + PA_i ≺ 0 would make it negative.
    """
    cp = modelling()
    n = len(A[0])
    X, t = [cp.Variable((n, n), symmetric=True) for _ in A], cp.Variable()
    grown = sum((M @ Xi + Xi @ M.T for M, Xi in zip(A, X, strict=True)), start=np.zeros((n, n)))
    goal = cp.Problem(
        cp.Maximize(t), [grown >> t * np.eye(n), sum(cp.trace(Xi) for Xi in X) == 1.0, *(Xi >> 0 for Xi in X)]
    )
    if attempt(goal, solver, "quadratic stability") not in SOLVED:
        return None
    found = [_positive_part(np.asarray(Xi.value, dtype=float)) for Xi in X]
    whole = sum((M @ Xi + Xi @ M.T for M, Xi in zip(A, found, strict=True)), start=np.zeros((n, n)))
    return float(np.linalg.eigvalsh(whole)[0]) if definite(whole) else None


def _positive_part(symmetric: Floats) -> Floats:
    """Nearest positive semidefinite matrix."""
    values, vectors = np.linalg.eigh(0.5 * (symmetric + symmetric.T))
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)
