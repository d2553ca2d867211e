"""What a synthesis refuses before any optimisation, each with the reason and a way out."""

import numpy as np

from fddbench.design.norms import hinf_norm
from fddbench.design.stability import require_common_lyapunov, require_multipliers
from fddbench.design.uncertainty import Block, NormBounded, Polytope, Structured, Uncertainty
from fddbench.errors import DesignError
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
        require_common_lyapunov(plants, solver)
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
