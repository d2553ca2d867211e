"""The reference model that is easiest to follow: Algorithm 1, and one inequality where the poles are given."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fddbench.design.bounds import lower_bound_diagonal
from fddbench.design.linearised import Freedom, ReferenceVariables, inequality_about, sensitivity_about, storage
from fddbench.design.lmi import FilterVariables, Solution, inequality, positive, upper_part
from fddbench.design.multipliers import MultiplierVariables
from fddbench.design.norms import hminus_index
from fddbench.design.proof import Task
from fddbench.design.robust_hinf import Design, prepare, synthesize
from fddbench.design.solver import attempt, modelling, solve
from fddbench.design.synthesis import optimal
from fddbench.design.uncertainty import NormBounded, Uncertainty
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["Iteration", "ReferenceSearch", "normalised", "optimize_fixed_poles", "optimize_reference"]


@dataclass(frozen=True)
class Iteration:
    """One step of Algorithm 1: γ proved by its inequality and the reference it belongs to."""

    gamma: float
    reference: StateSpace


@dataclass(frozen=True, kw_only=True)
class ReferenceSearch:
    """What Algorithm 1 found.

    Attributes
    ----------
    design : Design
        Filter and certificate for the last reference.
    iterations : tuple of Iteration
        The start and every step; γ never grows.
    lower_bound : float
        No diagonal reference with ‖T_ref‖₋ ≥ 1, of any order, has a smaller γ [-]; 0 for other references.
    """

    design: Design
    iterations: tuple[Iteration, ...]
    lower_bound: float


def optimize_reference(
    plant: UncertainPlant,
    reference: StateSpace,
    uncertainty: Uncertainty | None = None,
    weights: Weights | None = None,
    *,
    freedom: Freedom | None = None,
    iterations: int = 10,
    tolerance: float = 1e-6,
    solver: str = "CLARABEL",
    relax: float | None = 0.02,
) -> ReferenceSearch:
    """Algorithm 1: improve reference and filter together until γ stands still, possibly at a local minimum.

    Two scalings make it converge in a few steps where the run of Table 1 crawls: before every step the reference is
    divided by its own smallest gain, row by row when it is diagonal, which can only lower γ; and Q and R of (59) are
    brought to the same norm, so that neither the Lyapunov matrices nor the reference are held still.

    Parameters
    ----------
    reference : StateSpace
        Start, stable, with ``‖T_ref‖₋ > 0``.
    freedom : Freedom, optional
        Entries that may move; the diagonals of A, C, D when left out.
    iterations : int
        Most steps after the start.
    tolerance : float
        Stop when γ falls by less than this fraction [-].
    plant, uncertainty, weights, solver, relax
        As in `synthesize`.
    """
    freedom = freedom or Freedom.diagonal(reference)
    current = reference if hminus_index(reference).value >= 1.0 else normalised(reference, freedom)
    task = prepare(plant, current, uncertainty or NormBounded(), weights, solver, moving=True)
    first = optimal(task)
    history, solution = [Iteration(min(first.gamma, task.idle_gamma), current)], first.solution
    for _ in range(iterations):
        if solution is None:  # followed exactly: there is nothing to gain
            break
        task = replace(task, reference=normalised(current, freedom))
        step = _step(task, solution, freedom)
        if step is None or step[0].gamma > history[-1].gamma:
            break
        history.append(step[0])
        current, solution = step[0].reference, step[1]
        if history[-1].gamma > (1.0 - tolerance) * history[-2].gamma:
            break
    final = normalised(current, freedom) if len(history) > 1 else current
    design = synthesize(plant, final, uncertainty, weights, solver=solver, relax=relax)
    bound = lower_bound_diagonal(task.scaled, task.blocks).gamma if _is_diagonal(reference, freedom) else 0.0
    return ReferenceSearch(design=design, iterations=tuple(history), lower_bound=bound)


def optimize_fixed_poles(
    plant: UncertainPlant,
    poles: npt.ArrayLike,
    uncertainty: Uncertainty | None = None,
    weights: Weights | None = None,
    *,
    solver: str = "CLARABEL",
    relax: float | None = 0.02,
) -> Design:
    """Find the best diagonal reference ``d_i + c_i / (s - a_i)`` for given poles, by one exact inequality.

    With A_ref fixed and B_ref = I the inequality (37) is linear in C_ref and D_ref, and ``‖T_ref‖₋ ≥ 1`` means that the
    gains at infinity, d_i, and at zero, ``d_i - c_i / a_i``, have size one at least. It is exact among references whose
    two gains have the same sign, and γ equal to `lower_bound_diagonal` proves that no other reference is better.

    Parameters
    ----------
    poles : (n_f,) array
        a_i < 0 [rad/s].
    plant, uncertainty, weights, solver, relax
        As in `synthesize`.
    """
    cp = modelling()
    a, n_f = np.asarray(poles, dtype=float), plant.inputs[0]
    if a.shape != (n_f,) or np.any(a >= 0.0):
        raise DesignError(f"need one negative pole for each of the {n_f} faults (columns of Bf), got {a}.")
    start = StateSpace.diagonal(a, np.ones(n_f), np.zeros(n_f), np.ones(n_f))
    task = prepare(plant, start, uncertainty or NormBounded(), weights, solver, moving=True)
    variables, multiplier, margins = FilterVariables(task.scaled[0]), MultiplierVariables(task.blocks), task.margins
    c, d, gamma = cp.Variable(n_f), cp.Variable(n_f), cp.Variable()
    constraints = [*positive(variables, margins), d >= 1.0, d - cp.multiply(1.0 / a, c) >= 1.0]
    slow = task.coordinates.reference(start)
    for augmented in task.scaled:
        quadruple = augmented.with_reference(slow.A, slow.B, cp.diag(c), cp.diag(d))
        constraints += inequality(upper_part(augmented, quadruple, variables, multiplier, gamma), margins, gamma)
    solve(
        cp.Problem(cp.Minimize(gamma), constraints), solver, "reference of fixed poles", infeasible="no filter exists."
    )
    found = StateSpace.diagonal(a, np.ones(n_f), np.asarray(c.value), np.asarray(d.value))
    final = normalised(found, Freedom.diagonal(found))
    return synthesize(plant, final, uncertainty, weights, solver=solver, relax=relax)


def normalised(reference: StateSpace, freedom: Freedom) -> StateSpace:
    """T_ref over its smallest gain, so that ``‖T_ref‖₋ = 1``; row by row when it is and stays diagonal."""
    A, B, C, D = reference.A, reference.B, reference.C, reference.D
    if _is_diagonal(reference, freedom):
        rows = [StateSpace(A, B[:, [i]], C[[i]], D[[i]][:, [i]]) for i in range(len(D))]
        gains: Floats = np.array([[hminus_index(row).value] for row in rows])
    else:
        gains = np.array([[hminus_index(reference).value]])
    if np.any(gains <= 1e-9):
        raise DesignError(
            f"the reference is blind: its smallest gains are {gains.ravel()}, need ‖T_ref‖₋ > 0 at every frequency. "
            "Give D_ref a full-rank part and keep c_i b_i / a_i away from d_i."
        )
    return StateSpace(A, B, C / gains, D / gains)


def _is_diagonal(reference: StateSpace, freedom: Freedom) -> bool:
    """Whether all four matrices are diagonal and stay so."""
    pairs = [(getattr(reference, name), np.asarray(getattr(freedom, name))) for name in "ABCD"]
    return all(not np.any((M != 0.0) & (np.eye(*M.shape) == 0.0)) for pair in pairs for M in pair)


def _step(task: Task, about: Solution, freedom: Freedom) -> tuple[Iteration, Solution] | None:
    """Step 5 of Algorithm 1 about the task's reference, (66)-(68); None when the solver gives no reliable answer."""
    cp = modelling()
    reference, margins = task.coordinates.reference(task.reference), task.margins
    variables, multiplier = FilterVariables(task.scaled[0]), MultiplierVariables(task.blocks)
    moving, gamma = ReferenceVariables(reference, freedom), cp.Variable()
    scale = _balance(task, about, reference)
    constraints = positive(variables, margins) + sensitivity_about(moving, reference, storage(reference, task.solver))
    for plant in task.scaled:
        constraints += inequality_about(plant, variables, multiplier, moving, gamma, (about, reference), scale, margins)
    if attempt(cp.Problem(cp.Minimize(gamma), constraints), task.solver, "Algorithm 1") != "optimal":
        return None
    found = task.coordinates.reference_back(moving.value())
    return Iteration(float(gamma.value), found), variables.value(task.plants[0].n_y)


def _balance(task: Task, about: Solution, reference: StateSpace) -> float:
    """Scale that gives Q and R of (59) the same norm."""
    E1 = task.plants[0].E1
    if not E1.shape[1]:
        return 1.0
    Q, R = np.vstack([about.Z @ E1, about.Y @ E1]), np.hstack([reference.A, reference.B])
    return float(np.sqrt(np.linalg.norm(R, 2) / np.linalg.norm(Q, 2)))
