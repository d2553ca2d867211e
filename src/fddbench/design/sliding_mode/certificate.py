"""What a γ is worth: V checked at every vertex in the coordinates of the model, and frozen gains inside the box."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import qmc

from fddbench.design.norms import hinf_norm
from fddbench.design.sliding_mode.error_system import ErrorSystem, Pair
from fddbench.design.sliding_mode.plant import FaultyPlant
from fddbench.design.solver import attempt, modelling
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["MARGIN", "Certificate", "bounded_real", "certify", "storage"]

MARGIN = 1e-9
"""Least relative margin of a proof [-]; rounding is 1e-14."""
N_INSIDE = 2000
_FREQUENCIES = np.concatenate([[0.0], np.logspace(-2.0, 3.0, 40)])


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """A γ for every rho in the box, however fast it moves, and how it was checked.

    Attributes
    ----------
    gamma : float
        The L2 gain from (xi, phi) to the error of the reconstruction is below it [-].
    margin : float
        Smallest distance of the inequalities from singular: eigenvalues of matrices scaled to unit diagonals [-].
    frozen : float
        Largest H∞ norm at a vertex for a rho that stands still [-].
    frozen_inside : float
        Largest gain over `N_INSIDE` points of the box and 41 frequencies [-].
    slowest_pole_1_s : float
        Largest real part of a pole of the sliding error over all of them [1/s].
    """

    gamma: float
    margin: float
    frozen: float
    frozen_inside: float
    slowest_pole_1_s: float


def bounded_real(P: Any, loop: StateSpace, gamma: Any, block: Callable[[list[list[Any]]], Any]) -> Any:
    """``[A'P + PA, PB, C'; *, -γI, D'; *, *, -γI]``, negative definite where ``V = x'Px`` proves γ."""
    n, m, q = loop.order, loop.n_inputs, loop.n_outputs
    half = block(
        [
            [P @ loop.A, P @ loop.B, loop.C.T],
            [np.zeros((m, n)), -0.5 * gamma * np.eye(m), loop.D.T],
            [np.zeros((q, n + m)), -0.5 * gamma * np.eye(q)],
        ]
    )
    return half + half.T


def certify(system: ErrorSystem, pair: Pair, P: Floats, gamma: float, plant: FaultyPlant) -> Certificate:
    """Certificate of a γ.

    Raises
    ------
    DesignError
        The inequalities do not hold with `MARGIN`, or a point inside contradicts them.
    """
    loops = [system.at(rho, pair) for rho in plant.vertices]
    margins = [_margin(-bounded_real(P, loop, gamma, np.block)) for loop in loops]
    margin = min([_margin(P), *margins])
    if margin < MARGIN:
        raise DesignError(
            f"γ = {gamma:.6g} is not proved: the inequalities hold with a relative margin of {margin:.2e}, need {MARGIN:.0e}. "
            "Choose units in which states, outputs and weights are about one, or a larger relax"
        )
    inside, slowest = _inside(system, pair, plant)
    if inside > gamma * (1.0 + 1e-9) or slowest >= 0.0:
        raise DesignError(
            f"γ = {gamma:.6g} is contradicted by a frozen point of the box with {inside:.6g}: report this"
        )
    return Certificate(
        gamma=gamma,
        margin=margin,
        frozen=max(hinf_norm(loop).value for loop in loops),
        frozen_inside=inside,
        slowest_pole_1_s=slowest,
    )


def storage(system: ErrorSystem, pair: Pair, plant: FaultyPlant, solver: str, relax: float) -> tuple[Floats, float]:
    """P and γ of a given pair: the smallest γ that one V proves at all vertices, relaxed so that it can be checked.

    Raises
    ------
    DesignError
        There is no V: the pair is unstable somewhere, or has no common one.
    """
    cp = modelling()
    loops = [system.at(rho, pair) for rho in plant.vertices]
    n = loops[0].order
    P, gamma, margin = cp.Variable((n, n), symmetric=True), cp.Variable(), cp.Variable()
    matrices = [bounded_real(P, loop, gamma, cp.bmat) for loop in loops]
    asked = cp.Problem(cp.Minimize(gamma), [P >> 0.0, *(M << 0 for M in matrices)])
    if attempt(asked, solver, "analysis of a pair") not in ("optimal", "optimal_inaccurate"):
        raise DesignError(
            "this pair (L, W) has no Lyapunov matrix that holds at every vertex of the box; leave `pair` out to design one"
        )
    level = (1.0 + relax) * float(gamma.value)
    inner = [M << -margin * np.eye(M.shape[0]) for M in matrices]
    attempt(cp.Problem(cp.Maximize(margin), [P >> 0.0, gamma == level, *inner]), solver, "analysis of a pair")
    return np.asarray(P.value, dtype=float), level


def _margin(definite: Floats) -> float:
    """Smallest eigenvalue of a symmetric matrix scaled to a unit diagonal; negative where a diagonal entry is."""
    diagonal = np.diag(definite)
    if np.any(diagonal <= 0.0):
        return float(diagonal.min(initial=0.0) / max(np.abs(definite).max(initial=0.0), 1e-300))
    root = np.sqrt(diagonal)
    return float(np.linalg.eigvalsh(definite / np.outer(root, root)).min(initial=np.inf))


def _inside(system: ErrorSystem, pair: Pair, plant: FaultyPlant) -> tuple[float, float]:
    """Largest gain over points of the box and frequencies, and the largest real part of a pole."""
    points = plant.vertices
    box = plant.box
    if len(box.low):
        spread = qmc.Halton(len(box.low), scramble=False).random(N_INSIDE)
        points = np.vstack([points, box.centre + (2.0 * spread - 1.0) * box.half])
    loops = [system.at(rho, pair) for rho in points]
    A, B, C, D = (np.stack([getattr(loop, name) for loop in loops]) for name in "ABCD")
    slowest = float(np.linalg.eigvals(A).real.max())
    largest = 0.0
    for frequency in _FREQUENCIES:
        response = C @ np.linalg.solve(1j * frequency * np.eye(A.shape[1]) - A, B) + D
        largest = max(largest, float(np.linalg.norm(response, 2, axis=(1, 2)).max()))
    return largest, slowest
