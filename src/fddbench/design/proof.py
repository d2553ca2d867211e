"""A filter with the γ it guarantees, and the task it answers."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fddbench.design.bounds import Bound, lower_bound
from fddbench.design.certificate import Certificate, certify
from fddbench.design.coordinates import Coordinates
from fddbench.design.lmi import FilterVariables, Margins, Solution, inequality, positive, upper_part
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.problem import Augmented, ClosedLoop, Filter, close
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.design.worst_case import hull_members
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["N_SAMPLED", "Proven", "Task", "prove", "proved"]

N_SAMPLED = 50
"""Members of the set at which a certificate checks (15) besides the robust inequality that covers all of them."""


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
    solution : Solution or None
        The point Z, Y, Â, ... of the inequality; None for a filter that follows exactly, which is found without one.
    """

    filter: Filter
    gamma: float
    multiplier: Multiplier | None
    certificate: Certificate
    loops: tuple[ClosedLoop, ...] = field(repr=False)
    blocks: tuple[Block, ...] = field(repr=False)
    solution: Solution | None = field(repr=False)

    @property
    def exact(self) -> bool:
        """Whether the filter follows its reference exactly, γ being nothing but what rounding allows to prove."""
        return self.solution is None

    @property
    def lambda_(self) -> float | None:
        """The multiplier λ of Lemma 4; None where there is none or a matrix S."""
        if self.multiplier is None or len(self.blocks) != 1:
            return None
        return float(self.multiplier.scalars[0])


@dataclass(frozen=True, kw_only=True)
class Task:
    """Everything an optimisation needs to know.

    Attributes
    ----------
    plants : tuple of Augmented
        One with its Δ channel, or the vertices of a polytope.
    blocks : tuple of Block
        Structure of Δ.
    reference : StateSpace
        T_ref.
    solver : str
        Solver by name.
    coordinates : Coordinates
        Of the optimisation: time, states, signals and residuals of about size one.
    idle_gamma : float
        γ of the residual that is always zero [-].
    """

    plants: tuple[Augmented, ...]
    blocks: tuple[Block, ...]
    reference: StateSpace
    solver: str
    coordinates: Coordinates
    idle_gamma: float

    @property
    def scaled(self) -> tuple[Augmented, ...]:
        """The plants in the coordinates of the optimisation."""
        return tuple(self.coordinates.plant(plant) for plant in self.plants)

    @property
    def margins(self) -> Margins:
        """What the margins of the optimisation are a share of."""
        plant, R = self.scaled[0], self.coordinates.reference(self.reference)
        A, B, _, _ = plant.with_reference(R.A, R.B, R.C, R.D)
        return Margins.of(A, np.hstack([B, plant.F]), B.shape[1] + len(plant.Wc))

    def lower_bound(self) -> Bound:
        """Largest γ proved unreachable for the reference, with the frequency that proves it."""
        scaled = self.coordinates.reference(self.reference)
        bound = lower_bound(self.scaled, scaled, self.blocks)
        return Bound(bound.gamma * self.coordinates.unit, bound.frequency * self.coordinates.rate)

    def constraints(self, level: Any) -> tuple[list[Any], FilterVariables, MultiplierVariables]:
        """(37) or (44), or (47) at every vertex, with (38); `level` is γ in the unit of the coordinates."""
        scaled, margins, R = self.scaled, self.margins, self.coordinates.reference(self.reference)
        variables, multiplier = FilterVariables(scaled[0]), MultiplierVariables(self.blocks)
        constraints = positive(variables, margins)
        for plant in scaled:
            quadruple = plant.with_reference(R.A, R.B, R.C, R.D)
            constraints += inequality(upper_part(plant, quadruple, variables, multiplier, level), margins, level)
        return constraints, variables, multiplier


def prove(task: Task, solution: Solution, multiplier: Multiplier, gamma: float) -> Proven:
    """Return the filter of a solution with its certificate, which may still fail; all in the plant's own units."""
    coordinates = task.coordinates
    used = coordinates.multiplier_back(multiplier) if task.blocks else None
    filter_ = coordinates.filter_back(solution.filter())
    return proved(task, filter_, coordinates.lyapunov_back(solution.lyapunov()), used, gamma, solution)


def proved(
    task: Task, filter_: Filter, P: Floats, multiplier: Multiplier | None, gamma: float, solution: Solution | None
) -> Proven:
    """Return a filter with the certificate that P and the multiplier give it."""
    loops = tuple(close(plant, task.reference, filter_) for plant in task.plants)
    return Proven(
        filter=filter_,
        gamma=gamma,
        multiplier=multiplier,
        certificate=certify(loops, P, gamma, multiplier, _members(task, loops)),
        loops=loops,
        blocks=task.blocks,
        solution=solution,
    )


def _members(task: Task, loops: tuple[ClosedLoop, ...]) -> list[StateSpace]:
    """Closed loops of sampled plants."""
    if task.blocks:
        return [loops[0].at(delta) for delta in sample_delta(task.blocks, N_SAMPLED, seed=0)]
    mixes = np.random.default_rng(0).dirichlet(np.full(len(loops), 0.5), N_SAMPLED if len(loops) > 1 else 1)
    return hull_members(loops, mixes)
