"""Robust H∞ detection filters by linear matrix inequalities: one call from a plant to a filter with proof of its γ.

References
----------
Robust fault detection and isolation by linear matrix inequalities with an optimal reference model; the equation and
lemma numbers of this package are those of that paper.
"""

from dataclasses import dataclass

import numpy as np

from fddbench.design.admissible import require_admissible
from fddbench.design.coordinates import Coordinates
from fddbench.design.norms import hinf_norm
from fddbench.design.problem import augment
from fddbench.design.proof import Proven, Task
from fddbench.design.synthesis import moderate, optimal, refuse_idle
from fddbench.design.uncertainty import NormBounded, Polytope, Uncertainty, blocks_of
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant, series

__all__ = ["Design", "idle_gamma", "prepare", "synthesize"]


@dataclass(frozen=True, kw_only=True)
class Design(Proven):
    """The filter with the smallest proved γ, and one of moderate size to fly.

    Attributes
    ----------
    reference : StateSpace
        T_ref.
    lower_bound : float
        No filter for this reference has a smaller γ [-].
    idle_gamma : float
        γ of the residual that is always zero, ``‖T_ref W_f‖∞`` [-].
    moderate : Proven or None
        Filter of the second step with its own larger γ and certificate; a filter that follows exactly is its own.
    """

    reference: StateSpace
    lower_bound: float
    idle_gamma: float
    moderate: Proven | None


def prepare(
    plant: UncertainPlant,
    reference: StateSpace,
    uncertainty: Uncertainty,
    weights: Weights | None,
    solver: str,
    *,
    moving: bool = False,
) -> Task:
    """Return the optimisation for admissible data; refuses all other data with advice.

    The coordinates of a reference that is `moving` are its own, since what is free in it are entries of its matrices.
    """
    members = uncertainty.vertices if isinstance(uncertainty, Polytope) else (plant,)
    for name in ("A", "Bf", "Bd", "B", "C", "Df", "Dd", "D"):
        ours, theirs = getattr(plant, name).shape, getattr(members[0], name).shape
        if ours != theirs:
            raise DesignError(f"{name} of the plant has shape {ours} but {name} of the vertices has shape {theirs}.")
    if not plant.n_y or not plant.inputs[0]:
        raise DesignError(
            f"a filter needs outputs and faults: C has shape {plant.C.shape}, Bf has shape {plant.Bf.shape}."
        )
    blocks = () if isinstance(uncertainty, Polytope) else blocks_of(uncertainty, plant)
    plants = tuple(augment(member, reference, weights) for member in members)
    if not reference.stable():
        raise DesignError(
            f"the reference is unstable: poles {np.round(reference.poles(), 4)}; give A_ref negative eigenvalues."
        )
    idle, W_f = idle_gamma(reference, plant, weights), (weights or Weights()).systems(plant.inputs)[0]
    require_admissible(members, reference, uncertainty, blocks, solver, W_f=W_f, idle=idle)
    seen = StateSpace.gain(np.eye(plant.inputs[0])) if moving else reference
    coordinates = Coordinates.of(plants[0], seen, blocks, unit=1.0 if moving or not idle else idle)
    return Task(
        plants=plants,
        blocks=blocks,
        reference=reference,
        solver=solver,
        coordinates=coordinates,
        idle_gamma=idle,
    )


def synthesize(
    plant: UncertainPlant,
    reference: StateSpace,
    uncertainty: Uncertainty | None = None,
    weights: Weights | None = None,
    *,
    solver: str = "CLARABEL",
    relax: float | None = 0.02,
) -> Design:
    """Filter that follows ``r = T_ref f`` best in the worst case, for a fixed reference.

    Minimises γ of ``sup ‖[(T_rf - T_ref) W_f, T_rd W_d, T_ru W_u]‖∞ < γ`` over all filters of the order of plant,
    weights and reference together: Lemma 4 for a `NormBounded` Δ, Lemma 5 for a `Structured` one,
    Lemma 6 for a `Polytope`.

    Parameters
    ----------
    plant : UncertainPlant
        Nominal plant with its Δ channel; for a polytope only its sizes count.
    reference : StateSpace
        T_ref, stable, faults to residuals: ``StateSpace.gain(np.eye(n_f))`` asks for the faults themselves.
    uncertainty : NormBounded, Structured or Polytope
        Norm-bounded when left out.
    weights : Weights, optional
        γ weighs f, d and u as unit signals; weights give them their sizes.
    solver : {"CLARABEL", "SCS", "MOSEK"}
        Solver by name.
    relax : float or None
        How much larger [-] γ of the moderate filter may be, more where that gives none; None leaves the step out.

    Returns
    -------
    Design
        Always with a certificate: a γ without one is an error.

    Notes
    -----
    The optimum often has fast poles and large gains; `Design.moderate` is the one to discretise and fly. The filter is
    not unique: compare γ and certificates, not matrices. A smaller γ is not better detection.
    """
    task = prepare(plant, reference, uncertainty or NormBounded(), weights, solver)
    best = optimal(task)
    refuse_idle(task, best.gamma)
    second = None
    if relax is not None:
        second = best if best.exact else moderate(task, best.gamma, relax)
    bound = task.lower_bound().gamma
    return Design(**vars(best), reference=reference, lower_bound=bound, idle_gamma=task.idle_gamma, moderate=second)


def idle_gamma(reference: StateSpace, plant: UncertainPlant, weights: Weights | None) -> float:
    """γ of the residual that is always zero, ``‖T_ref W_f‖∞`` [-]."""
    W_f = (weights or Weights()).systems(plant.inputs)[0]
    return hinf_norm(series(W_f, reference)).value
