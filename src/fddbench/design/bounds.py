"""Lower bounds of γ that no filter can beat: explicit plants, one frequency, and what no gain can do there."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from fddbench.design.problem import Augmented
from fddbench.design.response import Matrix, Response, at, complex_form, real_form, unseen, worst_frequency
from fddbench.design.search import climb
from fddbench.design.solver import attempt, modelling
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Bound", "lower_bound", "lower_bound_diagonal"]

ROUNDS = 12
"""Most rounds of adding the worst plants; four to eight settle the references of the jet engine."""


@dataclass(frozen=True)
class Bound:
    """No filter has a smaller γ, and the frequency [rad/s] at which this is proved."""

    gamma: float
    frequency: float


def lower_bound(plants: tuple[Augmented, ...], reference: StateSpace, blocks: tuple[Block, ...]) -> Bound:
    """Largest γ that is proved unreachable for a fixed reference.

    At one frequency any filter is a constant matrix K, so γ is at least ``min_K max_i ‖K M_i - R‖`` over any finite set
    of plants. For one plant that is what R asks of the directions that M does not see, at any frequency. For several,
    at 0, ∞ and where a single one is worst, it is bounded from below by a point of the dual, taken from the solver's
    answer and made feasible by projection and scaling: the bound does not trust the solver.

    Parameters
    ----------
    plants : tuple of Augmented
        One with its Δ channel, or the vertices of a polytope.
    reference : StateSpace
        T_ref.
    blocks : tuple of Block
        Structure of Δ; () for a polytope or a certain plant.
    """
    best = max((worst_frequency(plant, reference) for plant in plants), key=lambda spot: spot.gamma)
    bounds = [Bound(best.gamma, best.frequency)]
    if blocks or len(plants) > 1:
        ends = max(unseen(plant, reference, w) for plant in plants for w in (0.0, np.inf))
        inner = (best.frequency,) if best.gamma > 1.001 * ends else ()
        for frequency in dict.fromkeys((np.inf, 0.0, *inner)):
            responses = [Response.of(plant, frequency) for plant in plants]
            bounds.append(Bound(_cutting_planes(responses, blocks, at(reference, frequency)), frequency))
    return max(bounds, key=lambda bound: bound.gamma)


def lower_bound_diagonal(plants: tuple[Augmented, ...], blocks: tuple[Block, ...]) -> Bound:
    """Largest γ proved unreachable for every diagonal reference with ‖T_ref‖₋ ≥ 1, of any order and with any poles.

    Such a reference has ``|d_i| ≥ 1`` at infinity, and the sign of a residual is free, so that ``d_i ≥ 1``.
    """
    return Bound(_cutting_planes([Response.of(plant, np.inf) for plant in plants], blocks, None), np.inf)


def _cutting_planes(responses: list[Response], blocks: tuple[Block, ...], wanted_at: Matrix | None) -> float:
    """Best bound while the worst plants for the best gain join the binding ones; no reference is a free one."""
    nothing = np.zeros((sum(b.shape[0] for b in blocks), sum(b.shape[1] for b in blocks)))
    reference = None if wanted_at is None else real_form(wanted_at)
    if not blocks:
        pairs = [(real_form(response.measured.rv), real_form(response.faults)) for response in responses]
        return _best_gain([M for M, _ in pairs], [W for _, W in pairs], reference)[-1]
    (response,) = responses
    measured, best = [response.measured.at(delta) for delta in (nothing, *sample_delta(blocks, 4, seed=0)[1:])], 0.0
    faults, n_f = real_form(response.faults), len(response.faults)
    for _ in range(ROUNDS):
        gain, target, level, bound = _best_gain([real_form(M) for M in measured], [faults] * len(measured), reference)
        best = max(best, bound)
        K, R = complex_form(gain, n_f), complex_form(target, n_f)
        climbs = [climb(response.error(K, R), blocks, start, steps=10) for start in sample_delta(blocks, 6, seed=1)]
        worse = {round(value, 9): delta for delta, value in climbs if value > level * (1.0 + 1e-5)}
        if not worse:
            break
        asked = R @ response.faults
        binding = [M for M in measured if np.linalg.norm(K @ M - asked, 2) > 0.99 * level]
        measured = binding + [response.measured.at(worse[value]) for value in sorted(worse)[-3:]]
    return best


def _best_gain(
    measured: list[Floats], faults: list[Floats], reference: Floats | None
) -> tuple[Floats, Floats, float, float]:
    """K and T_ref that minimise the largest ``‖K M_i - T_ref W_i‖``, that value, and its proved lower bound."""
    cp = modelling()
    n_f = len(faults[0])
    K, d, level = cp.Variable((n_f, len(measured[0]))), cp.Variable(n_f), cp.Variable()
    wanted = cp.diag(d) if reference is None else reference
    errors = [K @ M - wanted @ W for M, W in zip(measured, faults, strict=True)]
    cones = [cp.bmat([[level * np.eye(n_f), e], [e.T, level * np.eye(e.shape[1])]]) >> 0 for e in errors]
    free = [d >= 1.0] if reference is None else []
    status = attempt(cp.Problem(cp.Minimize(level), cones + free), "CLARABEL", "lower bound")
    if status not in ("optimal", "optimal_inaccurate"):
        raise DesignError(f"lower bound of gamma: solver status {status!r}; try other weights.")
    duals = [np.asarray(cone.dual_value)[:n_f, n_f:] for cone in cones]
    bound = _dual_bound(duals, measured, faults, reference)
    return np.asarray(K.value), np.asarray(getattr(wanted, "value", wanted)), float(level.value), bound


def _dual_bound(duals: list[Floats], measured: list[Floats], faults: list[Floats], reference: Floats | None) -> float:
    """Value of the dual at the nearest feasible point, 0 when there is none.

    The dual of ``min max ‖K M_i - T W_i‖`` maximises ``Σ⟨V_i, T W_i⟩`` over ``Σ V_i M_iᵀ = 0, Σ‖V_i‖⁎ ≤ 1``; over
    ``T = diag(d), d ≥ 1`` the value is that of d = 1 when every ``c_j = Σ⟨V_i, e_j e_jᵀ W_i⟩`` is nonnegative.
    """
    V, stacked, W = np.hstack(duals), np.hstack(measured), np.hstack(faults)
    blind = null_space(stacked, rcond=1e-10)
    whole, V = np.linalg.norm(V), V @ blind @ blind.T
    size = sum(float(np.linalg.norm(piece, "nuc")) for piece in np.split(V, len(measured), axis=1))
    if size <= 1e-6 * whole:  # nothing but rounding is left: some gain follows the reference exactly
        return 0.0
    correlation = V @ W.T / size
    if reference is not None:
        return abs(float(np.sum(correlation * reference)))
    parts = np.diag(correlation)
    return abs(float(parts.sum())) if np.all(parts >= 0.0) or np.all(parts <= 0.0) else 0.0
