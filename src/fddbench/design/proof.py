"""A filter with the γ it guarantees, and the task it answers."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.certificate import Certificate, certify
from fddbench.design.coordinates import transformed
from fddbench.design.lmi import FilterVariables, Solution, inequality, positive, upper_part
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.problem import Augmented, ClosedLoop, Filter, close
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.design.worst_case import hull_members
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["N_SAMPLED", "Proven", "Task", "prove"]

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
    T : (n_k, n_k) array
        Coordinates of the optimisation, ``ξ = T η``.
    idle_gamma : float
        γ of the residual that is always zero [-].
    """

    plants: tuple[Augmented, ...]
    blocks: tuple[Block, ...]
    reference: StateSpace
    solver: str
    T: Floats
    idle_gamma: float

    @property
    def scaled(self) -> tuple[Augmented, ...]:
        """The plants in the coordinates of the optimisation, ``ξ = T η``."""
        return tuple(transformed(plant, self.T) for plant in self.plants)

    def constraints(self, gamma: Any) -> tuple[list[Any], FilterVariables, MultiplierVariables]:
        """(37) or (44), or (47) at every vertex, with (38)."""
        scaled = self.scaled
        variables, multiplier = FilterVariables(scaled[0]), MultiplierVariables(self.blocks)
        constraints, R = positive(variables), self.reference
        for plant in scaled:
            quadruple = plant.with_reference(R.A, R.B, R.C, R.D)
            constraints += inequality(upper_part(plant, quadruple, variables, multiplier, gamma))
        return constraints, variables, multiplier


def prove(task: Task, solution: Solution, multiplier: Multiplier, gamma: float) -> Proven:
    """Return the filter of a solution with its certificate, which may still fail."""
    filter_ = solution.filter()
    loops = tuple(close(plant, task.reference, filter_) for plant in task.plants)
    if task.blocks:
        members = [loops[0].at(delta) for delta in sample_delta(task.blocks, N_SAMPLED, seed=0)]
    else:
        mixes = np.random.default_rng(0).dirichlet(np.full(len(loops), 0.5), N_SAMPLED if len(loops) > 1 else 1)
        members = hull_members(loops, mixes)
    used = multiplier if task.blocks else None
    back = block_diag(np.linalg.inv(task.T), np.eye(len(task.T)))
    certificate = certify(loops, back.T @ solution.lyapunov() @ back, gamma, used, members)
    return Proven(
        filter=filter_,
        gamma=gamma,
        multiplier=used,
        certificate=certificate,
        loops=loops,
        blocks=task.blocks,
        solution=solution,
    )
