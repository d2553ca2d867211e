"""What a synthesis refuses before any optimisation, each with the reason and a way out."""

import numpy as np

from fddbench.design.norms import hinf_norm
from fddbench.design.stability import require_common_lyapunov, require_multipliers
from fddbench.design.uncertainty import Block, NormBounded, Polytope, Structured, Uncertainty
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["IDLE", "require_admissible"]

IDLE = 0.99
"""Share of the γ of a zero residual [-] above which a filter is refused: it would hardly differ from zero."""


def require_admissible(
    plants: tuple[UncertainPlant, ...],
    reference: StateSpace,
    uncertainty: Uncertainty,
    blocks: tuple[Block, ...],
    solver: str,
    *,
    W_f: StateSpace,
    idle: float,
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
    W_f : StateSpace
        Weight of the faults.
    idle : float
        γ of the residual that is always zero [-].
    """
    for number, plant in enumerate(plants):
        name = f"vertex {number}" if isinstance(uncertainty, Polytope) else "the plant"
        _require_rank(plant, reference, W_f, idle, name)
        poles = np.linalg.eigvals(plant.A)
        if np.any(poles.real >= 0.0):
            raise DesignError(
                f"{name} is unstable: A has poles {np.round(poles, 4)}. Problem 1 assumes quadratic stability; "
                "design the filter for the loop closed by its controller."
            )
    if isinstance(uncertainty, Polytope):
        require_common_lyapunov(plants, solver)
    elif blocks:
        _require_small_gain(plants[0], uncertainty, blocks, solver)


def _require_rank(plant: UncertainPlant, reference: StateSpace, W_f: StateSpace, idle: float, name: str) -> None:
    """Refuse a Df that is blind to what the reference asks for at infinite frequency (text before section 3)."""
    seen, wanted = plant.Df @ W_f.D, reference.D @ W_f.D
    unseen = float(np.linalg.norm(wanted - wanted @ np.linalg.pinv(seen, rcond=1e-9) @ seen, 2)) if wanted.size else 0.0
    if unseen > 0.0 and unseen >= IDLE * idle:
        values = np.linalg.svd(plant.Df, compute_uv=False)
        rank = int(np.sum(values > 1e-9 * values.max(initial=0.0)))
        raise DesignError(
            f"Df of {name} has rank {rank} for {plant.Df.shape[1]} faults (singular values {np.round(values, 6)}), but "
            f"D_ref asks for faults that no output shows at once: no filter has a gamma below {unseen:.4g}, and a residual "
            f"that is always zero has {idle:.4g}.\n"
            "Use a strictly proper fixed reference, e.g. StateSpace.diagonal([-1], [1], [1], [0]), or measure those "
            "faults directly."
        )


def _require_small_gain(
    plant: UncertainPlant, uncertainty: NormBounded | Structured, blocks: tuple[Block, ...], solver: str
) -> None:
    """Refuse a Δ channel that is ill-posed or destabilises; exact if unstructured, by multipliers if structured."""
    if isinstance(uncertainty, Structured):
        require_multipliers(plant, blocks, solver)
        return
    size = float(np.linalg.norm(plant.H, 2))
    if size >= 1.0:
        raise DesignError(
            f"Δ(I - HΔ)⁻¹ is ill-posed: H {plant.H.shape} has norm {size:.4g}, and a Δ of norm {1.0 / size:.4g} makes "
            "I - HΔ singular. Need ‖H‖ < 1; make the uncertainty smaller, or declare the structure of Δ."
        )
    loop = hinf_norm(StateSpace(plant.A, plant.FA, plant.EA, plant.H))
    if loop.value >= 1.0:
        raise DesignError(
            f"the plant is not quadratically stable: the gain of its Δ channel ‖EA(sI - A)⁻¹FA + H‖∞ is "
            f"{loop.value:.4g} at {loop.frequency:.4g} rad/s, must be < 1. Divide FA or EA by {loop.value:.3g} "
            "or more, declare the structure of Δ, or use a polytope."
        )
