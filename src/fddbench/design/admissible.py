"""What a synthesis refuses before any optimisation, each with the reason and a way out."""

from typing import Any

import numpy as np

from fddbench.design.multipliers import MultiplierVariables
from fddbench.design.norms import hinf_norm
from fddbench.design.solver import modelling, solve
from fddbench.design.uncertainty import Block, NormBounded, Polytope, Structured, Uncertainty
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["require_admissible"]


def require_admissible(
    plants: tuple[UncertainPlant, ...],
    reference: StateSpace,
    uncertainty: Uncertainty,
    blocks: tuple[Block, ...],
    solver: str,
) -> None:
    """Refuse references that cannot be followed and plants outside Problem 1.

    Parameters
    ----------
    plants : tuple of UncertainPlant
        The plant, or the vertices of a polytope.
    reference : StateSpace
        T_ref.
    uncertainty : Uncertainty
        Kind of the set.
    blocks : tuple of Block
        Structure of Δ.
    solver : str
        Solver by name, used where stability needs an inequality of its own.
    """
    if not reference.stable():
        raise DesignError(
            f"the reference is unstable: poles {np.round(reference.poles(), 4)}; give A_ref negative eigenvalues."
        )
    for number, plant in enumerate(plants):
        name = f"vertex {number}" if isinstance(uncertainty, Polytope) else "the plant"
        _require_rank(plant, reference, name)
        poles = np.linalg.eigvals(plant.A)
        if np.any(poles.real >= 0.0):
            raise DesignError(
                f"{name} is unstable: A has poles {np.round(poles, 4)}. Problem 1 assumes quadratic stability; "
                "design the filter for the loop closed by its controller."
            )
    if isinstance(uncertainty, Polytope):
        _require_common_lyapunov(plants, solver)
    elif blocks:
        _require_small_gain(plants[0], uncertainty, blocks, solver)


def _require_rank(plant: UncertainPlant, reference: StateSpace, name: str) -> None:
    """Refuse a Df that is blind to what the reference asks for at infinite frequency (text before section 3)."""
    values = np.linalg.svd(plant.Df, compute_uv=False)
    rank = int(np.sum(values > 1e-9 * values.max(initial=0.0)))
    unseen = reference.D - reference.D @ np.linalg.pinv(plant.Df, rcond=1e-9) @ plant.Df
    if rank < plant.Df.shape[1] and np.linalg.norm(unseen) > 1e-9 * np.linalg.norm(reference.D):
        raise DesignError(
            f"Df of {name} has rank {rank} for {plant.Df.shape[1]} faults (singular values {np.round(values, 6)}), but "
            "D_ref asks for faults that no output shows at once: gamma would stay at ‖D_ref‖ and the best residual at "
            "zero.\n"
            "Use a strictly proper fixed reference, e.g. StateSpace.diagonal([-1], [1], [1], [0]), or measure those "
            "faults directly."
        )


def _require_small_gain(
    plant: UncertainPlant, uncertainty: NormBounded | Structured, blocks: tuple[Block, ...], solver: str
) -> None:
    """Refuse a Δ channel that is ill-posed or destabilises; exact if unstructured, by scaling if structured."""
    structured = isinstance(uncertainty, Structured)
    size = float(np.linalg.norm(plant.H, 2))
    if size >= 1.0 and not (structured and _margin(plant.H[:0, :0], plant, blocks, solver) > 0.0):
        raise DesignError(
            f"Δ(I - HΔ)⁻¹ is ill-posed: H {plant.H.shape} has norm {size:.4g}, and a Δ of norm {1.0 / size:.4g} makes "
            "I - HΔ singular. Need ‖H‖ < 1, after scaling by the structure; make the uncertainty smaller."
        )
    loop = hinf_norm(StateSpace(plant.A, plant.FA, plant.EA, plant.H))
    if loop.value >= 1.0 and not (structured and _margin(plant.A, plant, blocks, solver) > 0.0):
        raise DesignError(
            f"the plant is not quadratically stable: the gain of its Δ channel ‖EA(sI - A)⁻¹FA + H‖∞ is "
            f"{loop.value:.4g} at {loop.frequency:.4g} rad/s, must be < 1. Divide FA or EA by {loop.value:.3g} "
            "or more, declare the structure of Δ, or use a polytope."
        )


def _margin(A: Floats, plant: UncertainPlant, blocks: tuple[Block, ...], solver: str) -> float:
    """Largest t with the stability part of (43) ⪯ -t I for some P, S ⪯ I; for A of size 0 that is well-posedness."""
    cp = modelling()
    n = len(A)
    F, E, H = plant.FA[:n], plant.EA[:, :n], plant.H
    S = MultiplierVariables(blocks)
    P, t = cp.Variable((n, n), symmetric=True) if n else None, cp.Variable()
    half: Any = cp.bmat([[H.T @ S.G - 0.5 * S.S_w, H.T @ S.S_z], [np.zeros((len(H), H.shape[1])), -0.5 * S.S_z]])
    bounded = [S.S_w << np.eye(H.shape[1])]
    if P is not None:
        top = cp.hstack([P @ A, P @ F + E.T @ S.G, E.T @ S.S_z])
        half = cp.vstack([top, cp.hstack([np.zeros((half.shape[0], n)), half])])
        bounded += [P >> t * np.eye(n), P << np.eye(n)]
    condition = half + half.T << -t * np.eye(half.shape[0])
    goal = cp.Problem(cp.Maximize(t), [condition, *bounded])
    margin = solve(goal, solver, "quadratic stability", infeasible="no margin exists.")
    return margin if margin > 1e-7 else 0.0


def _require_common_lyapunov(plants: tuple[UncertainPlant, ...], solver: str) -> None:
    """Refuse a polytope without a common Lyapunov matrix ``A_iᵀP + P A_i ≺ 0``."""
    cp = modelling()
    if len(plants) == 1 or not plants[0].n_x:
        return
    n = plants[0].n_x
    P, t = cp.Variable((n, n), symmetric=True), cp.Variable()
    conditions = [plant.A.T @ P + P @ plant.A << -t * np.eye(n) for plant in plants]
    goal = cp.Problem(cp.Maximize(t), [*conditions, P >> t * np.eye(n), P << np.eye(n)])
    if solve(goal, solver, "quadratic stability", infeasible="no margin exists.") <= 1e-7:
        raise DesignError(
            f"the polytope of {len(plants)} vertices is not quadratically stable: no P ≻ 0 makes AᵀP + PA ≺ 0 at all. "
            "Take vertices that lie closer together, or split the set and design one filter for each part."
        )
