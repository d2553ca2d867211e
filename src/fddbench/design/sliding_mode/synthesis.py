"""Steps 1 to 12 in one call: pair, certificate and bound of a plant with faults."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.norms import hinf_norm
from fddbench.design.sliding_mode.bound import lower_bound
from fddbench.design.sliding_mode.canonical import Canonical, canonical
from fddbench.design.sliding_mode.certificate import Certificate, certify, storage
from fddbench.design.sliding_mode.error_system import ErrorSystem, Pair, Weights
from fddbench.design.sliding_mode.inequality import point_of
from fddbench.design.sliding_mode.plant import FaultyPlant
from fddbench.design.sliding_mode.search import best
from fddbench.errors import DesignError

__all__ = ["SlidingDesign", "analyse", "frozen_gain", "synthesise"]

_RELAX_OF_ANALYSIS = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False)
class SlidingDesign:
    """A pair with what is known of it.

    Attributes
    ----------
    form : Canonical
    pair : Pair
    certificate : Certificate
    optimum : float
        Smallest γ that any pair proves with one Lyapunov matrix, or that this pair does where it was given [-].
    bound : float
        No linear filter, even one that knows rho, has a smaller γ [-].
    """

    form: Canonical
    pair: Pair
    certificate: Certificate
    optimum: float
    bound: float


def synthesise(plant: FaultyPlant, weights: Weights, *, solver: str = "CLARABEL", relax: float = 0.02) -> SlidingDesign:
    """Pair with (nearly) the smallest certified γ.

    Parameters
    ----------
    plant : FaultyPlant
    weights : Weights
    solver : {"CLARABEL", "SCS", "MOSEK"}
    relax : float
        How much larger than the optimum γ may be, for gains inside the border and a proof without doubt [-].

    Raises
    ------
    DesignError
        The plant allows no such observer, or its numbers no proof; the message says which condition fails.

    References
    ----------
    The yaw-rate sliding-mode observer paper of the ADDSAFE project, section 4.1; the search over T in place of the
    inequalities of its reference [17] is ours.
    """
    system = ErrorSystem(form=canonical(plant), weights=weights)
    found = best(system, plant.vertices, solver, relax)
    pair, P = point_of(system, found.moderate, found.scale)
    proof = certify(system, pair, P, float(found.moderate.gamma), plant)
    return _judged(plant, system, pair, proof, float(found.optimum.gamma))


def analyse(plant: FaultyPlant, weights: Weights, pair: Pair, *, solver: str = "CLARABEL") -> SlidingDesign:
    """A given pair, with the smallest γ that is proved for it.

    Raises
    ------
    DesignError
        ``L F2 = 0`` or ``W F2 = I`` fails, or the pair has no Lyapunov matrix for all vertices.
    """
    system = ErrorSystem(form=canonical(plant), weights=weights)
    _require_structure(system.form, pair)
    P, gamma = storage(system, pair, plant, solver, _RELAX_OF_ANALYSIS)
    proof = certify(system, pair, P, gamma, plant)
    return _judged(plant, system, pair, proof, gamma / (1.0 + _RELAX_OF_ANALYSIS))


def frozen_gain(plant: FaultyPlant, weights: Weights, pair: Pair) -> float:
    """Largest H∞ norm of a pair over the vertices, for a rho that stands still; infinite where it is unstable [-]."""
    system = ErrorSystem(form=canonical(plant), weights=weights)
    loops = [system.at(rho, pair) for rho in plant.vertices]
    return max(hinf_norm(loop).value if loop.stable() else np.inf for loop in loops)


def _judged(plant: FaultyPlant, system: ErrorSystem, pair: Pair, proof: Certificate, optimum: float) -> SlidingDesign:
    bound = lower_bound(system, plant)
    if bound > proof.gamma:
        raise DesignError(f"γ = {proof.gamma:.6g} lies below what is possible, {bound:.6g}: report this")
    return SlidingDesign(form=system.form, pair=pair, certificate=proof, optimum=optimum, bound=bound)


def _require_structure(form: Canonical, pair: Pair) -> None:
    """Eqs (20) and (21)."""
    q = form.F2.shape[1]
    if pair.L.shape != (form.n_1, len(form.F2)) or pair.W.shape != (q, len(form.F2)):
        raise DesignError(
            f"pair: L needs {form.n_1} rows of {len(form.F2)} numbers and W {q}; got {pair.L.shape} and {pair.W.shape}"
        )
    for name, off in (("L F2 = 0", pair.L @ form.F2), ("W F2 = I", pair.W @ form.F2 - np.eye(q))):
        if abs(off).max(initial=0.0) > 1e-6:
            raise DesignError(
                f"pair: {name} fails by {abs(off).max():.3g}: the reconstruction would not follow the fault"
            )
