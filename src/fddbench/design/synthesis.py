"""The two optimisations behind a design: the smallest γ, then a filter of moderate size for a slightly larger one."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fddbench.design.certificate import Certificate, certify
from fddbench.design.lmi import FilterVariables, Solution, inequality, positive, upper_part
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.problem import Augmented, ClosedLoop, Filter, close
from fddbench.design.solver import attempt
from fddbench.design.systems import StateSpace
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.design.worst_case import hull_members
from fddbench.errors import DesignError

__all__ = ["N_SAMPLED", "Proven", "Task", "moderate", "optimal", "prove"]

N_SAMPLED = 50
"""Members of the set at which a certificate checks (15) besides the robust inequality, which already covers all of them."""

SLACKS = (1e-5, 1e-4, 1e-3)
"""Relative steps above the smallest γ that are tried when the solver reaches it only in the limit of infinite gains."""


@dataclass(frozen=True, kw_only=True)
class Proven:
    """A filter with the γ it guarantees.

    Attributes
    ----------
    filter : Filter
        The filter (8).
    gamma : float
        ``‖[(T_rf - T_ref) W_f, T_rd W_d, T_ru W_u]‖∞ < gamma`` for every plant of the set [-].
    multiplier : Multiplier or None
        S and G of Lemma 5, λI and 0 of Lemma 4; None for a polytope or a certain plant.
    certificate : Certificate
        Eigenvalues that prove it.
    loops : tuple of ClosedLoop
        The closed loop with its Δ channel, or those at the vertices of a polytope.
    blocks : tuple of Block
        Structure of Δ.
    solution : Solution
        The point Z, Y, Â, ... of the inequality.
    """

    filter: Filter
    gamma: float
    multiplier: Multiplier | None
    certificate: Certificate
    loops: tuple[ClosedLoop, ...] = field(repr=False)
    blocks: tuple[Block, ...] = field(repr=False)
    solution: Solution = field(repr=False)

    @property
    def lambda_(self) -> float | None:
        """The multiplier λ of Lemma 4; None where there is none or a matrix S."""
        if self.multiplier is None or len(self.blocks) != 1:
            return None
        return float(self.multiplier.scalars[0])


@dataclass(frozen=True, kw_only=True)
class Task:
    """Everything an optimisation needs to know: augmented plants, structure of Δ, reference, solver."""

    plants: tuple[Augmented, ...]
    blocks: tuple[Block, ...]
    reference: StateSpace
    solver: str

    def constraints(self, gamma: Any) -> tuple[list[Any], FilterVariables, MultiplierVariables]:
        """(37) or (44), or (47) at every vertex, with (38)."""
        variables, multiplier = FilterVariables(self.plants[0]), MultiplierVariables(self.blocks)
        constraints, R = positive(variables), self.reference
        for plant in self.plants:
            quadruple = plant.with_reference(R.A, R.B, R.C, R.D)
            constraints += inequality(upper_part(plant, quadruple, variables, multiplier, gamma))
        return constraints, variables, multiplier


def prove(task: Task, solution: Solution, multiplier: Multiplier, gamma: float) -> Proven:
    """The filter of a solution with its certificate, which may still fail."""
    filter_ = solution.filter()
    loops = tuple(close(plant, task.reference, filter_) for plant in task.plants)
    if task.blocks:
        members = [loops[0].at(delta) for delta in sample_delta(task.blocks, N_SAMPLED, seed=0)]
    else:
        mixes = np.random.default_rng(0).dirichlet(np.full(len(loops), 0.5), N_SAMPLED if len(loops) > 1 else 1)
        members = hull_members(loops, mixes)
    used = multiplier if task.blocks else None
    certificate = certify(loops, solution.lyapunov(), gamma, used, members)
    return Proven(
        filter=filter_, gamma=gamma, multiplier=used, certificate=certificate, loops=loops, blocks=task.blocks, solution=solution
    )  # fmt: skip


def optimal(task: Task) -> Proven:
    """The smallest γ with its filter, certified.

    Where the infimum asks for infinite gains the solver's point has no certificate; then the smallest of a few slightly
    larger γ that has one is the result. A value that the solver calls inaccurate is only ever used as such a hint.
    """
    import cvxpy as cp

    gamma = cp.Variable()
    constraints, variables, multiplier = task.constraints(gamma)
    status = attempt(cp.Problem(cp.Minimize(gamma), constraints), task.solver, "filter synthesis")
    if status not in ("optimal", "optimal_inaccurate"):
        raise DesignError(
            f"filter synthesis: {task.solver} stopped with status {status!r} although the plant is admissible. "
            "Scale states and signals to about one (weights W_f, W_d, W_u), or try another solver."
        )
    hint = float(gamma.value)
    if status == "optimal":
        proven = prove(task, variables.value(task.plants[0].n_y), multiplier.value(), hint)
        if proven.certificate.holds:
            return proven
    for slack in SLACKS:
        centred = _centred(task, hint * (1.0 + slack) + 1e-7, 0.3)
        if centred and centred[0].certificate.holds:
            return centred[0]
    raise DesignError(
        f"filter synthesis: {task.solver} stopped with status {status!r} at gamma about {hint:.5g}, and no gamma up to "
        f"{SLACKS[-1]:.1%} above it has a certificate; what a solver doubts proves nothing.\n"
        "Scale states and signals to about one (weights W_f, W_d, W_u), or try another solver."
    )


def moderate(task: Task, gamma: float, floor: float) -> Proven:
    """A filter of moderate size for a given γ: minimise ‖Â‖ while ``Y - Z ⪰ floor I`` keeps N = Z - Y far from singular.

    The floor is halved below the largest feasible one where `floor` itself is not feasible.
    """
    smallest = _smallest(task, gamma, floor)
    if smallest is None:
        centred = _centred(task, gamma, floor)
        if centred is None:
            raise DesignError(
                f"second step: {task.solver} finds no filter of moderate size for gamma = {gamma:.5g}; use a larger relax, "
                "or relax=None for the optimum alone."
            )
        smallest = _smallest(task, gamma, 0.5 * centred[1]) or centred[0]
    smallest.certificate.require()
    return smallest


def _smallest(task: Task, gamma: float, floor: float) -> Proven | None:
    """Filter with the smallest ‖Â‖ above the floor; None when there is none with a certificate."""
    import cvxpy as cp

    constraints, variables, multiplier = task.constraints(gamma)
    constraints.append(variables.Y - variables.Z >> floor * np.eye(len(task.plants[0].A)))
    goal = cp.Problem(cp.Minimize(cp.norm(cp.vec(variables.A, order="F"), 2)), constraints)
    if attempt(goal, task.solver, "second step") != "optimal":
        return None
    proven = prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma)
    return proven if proven.certificate.holds else None


def _centred(task: Task, gamma: float, most: float) -> tuple[Proven, float] | None:
    """Filter with the largest ``Y - Z ⪰ t I``, t ≤ 2 most, and that t; None when the solver finds none."""
    import cvxpy as cp

    constraints, variables, multiplier = task.constraints(gamma)
    t = cp.Variable()
    constraints += [variables.Y - variables.Z >> t * np.eye(len(task.plants[0].A)), t <= 2.0 * most]
    if attempt(cp.Problem(cp.Maximize(t), constraints), task.solver, "second step") != "optimal":
        return None
    return prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma), float(t.value)
