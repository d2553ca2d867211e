"""Lower bounds of γ that no filter can beat: a few explicit plants, one frequency, and a dual certificate."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from fddbench.design.problem import Augmented
from fddbench.design.search import Fraction, climb
from fddbench.design.solver import attempt, modelling
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["lower_bound", "lower_bound_diagonal"]

ROUNDS = 12
"""Most rounds of adding the worst plants; four to eight settle the references of the jet engine."""


@dataclass(frozen=True)
class _Response:
    """What the filter sees and what it should say at a frequency where all responses are real.

    Attributes
    ----------
    measured : Fraction
        From v to (y, u), as a function of Δ.
    faults : (n_f, n_v) array
        From v to the weighted faults.
    """

    measured: Fraction
    faults: Floats

    @classmethod
    def of(cls, plant: Augmented, frequency: float) -> "_Response":
        """Response of the plant with its weights, at 0 or ∞ [rad/s]."""
        n_m, n_f, n_v, own = len(plant.Cm), len(plant.Wc), plant.B.shape[1], slice(plant.n_ref, None)
        inputs, outputs = np.hstack([plant.B, plant.F]), np.vstack([plant.Cm, plant.Wc, plant.E])
        direct = np.block([[plant.Dm, plant.Fm], [plant.Wd, np.zeros((n_f, plant.F.shape[1]))], [plant.Ev, plant.H]])
        whole = StateSpace(plant.A[own, own], inputs[own], outputs[:, own], direct).at(frequency).real
        m, f, z = whole[:n_m], whole[n_m : n_m + n_f], whole[n_m + n_f :]
        return cls(Fraction(m[:, :n_v], m[:, n_v:], z[:, :n_v], z[:, n_v:]), f[:, :n_v])

    def error(self, gain: Floats, reference: Floats) -> Fraction:
        """``K M(Δ) - T_ref W`` for a filter with the response K at this frequency."""
        M = self.measured
        return Fraction(gain @ M.rv - reference @ self.faults, gain @ M.rw, M.zv, M.zw)


def lower_bound(plants: tuple[Augmented, ...], reference: StateSpace, blocks: tuple[Block, ...]) -> float:
    """Largest γ that is proved unreachable for a fixed reference, over the frequencies 0 and ∞.

    At one frequency any filter is a constant matrix K, so γ is at least ``min_K max_i ‖K M_i - R‖`` over any finite set
    of plants. The minimum is bounded from below by a point of its dual, taken from the solver's answer and made
    feasible by projection and scaling: the bound does not trust the solver.

    Parameters
    ----------
    plants : tuple of Augmented
        One with its Δ channel, or the vertices of a polytope.
    reference : StateSpace
        T_ref.
    blocks : tuple of Block
        Structure of Δ; () for a polytope or a certain plant.
    """
    bounds = [0.0]
    for frequency in (np.inf, 0.0):
        responses = [_Response.of(plant, frequency) for plant in plants]
        bounds.append(_cutting_planes(responses, blocks, reference.at(frequency).real))
    return max(bounds)


def lower_bound_diagonal(plants: tuple[Augmented, ...], blocks: tuple[Block, ...]) -> float:
    """Largest γ proved unreachable for every diagonal reference with ‖T_ref‖₋ ≥ 1, of any order and with any poles.

    Such a reference has ``|d_i| ≥ 1`` at infinity, and the sign of a residual is free, so that ``d_i ≥ 1``.
    """
    return _cutting_planes([_Response.of(plant, np.inf) for plant in plants], blocks, None)


def _cutting_planes(responses: list[_Response], blocks: tuple[Block, ...], reference: Floats | None) -> float:
    """Best bound while the worst plants for the best gain join the binding ones; no reference is a free one."""
    nothing = np.zeros((sum(b.shape[0] for b in blocks), sum(b.shape[1] for b in blocks)))
    if not blocks:
        return _best_gain([r.measured.rv for r in responses], [r.faults for r in responses], reference)[-1]
    (response,) = responses
    measured, best = [response.measured.at(delta) for delta in (nothing, *sample_delta(blocks, 4, seed=0)[1:])], 0.0
    for _ in range(ROUNDS):
        gain, wanted, level, bound = _best_gain(measured, [response.faults] * len(measured), reference)
        best = max(best, bound)
        error = response.error(gain, wanted)
        climbs = [climb(error, blocks, start, steps=10) for start in sample_delta(blocks, 6, seed=1)]
        worse = {round(value, 9): delta for delta, value in climbs if value > level * (1.0 + 1e-5)}
        if not worse:
            break
        target = wanted @ response.faults
        binding = [M for M in measured if np.linalg.norm(gain @ M - target, 2) > 0.99 * level]
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
        raise DesignError(f"lower bound of gamma: solver status {status!r}; scale states and signals to about one.")
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
