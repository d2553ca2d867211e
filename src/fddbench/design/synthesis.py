"""The two optimisations behind a design: the smallest γ, then a filter of moderate size for a slightly larger one."""

import numpy as np

from fddbench.design.proof import Proven, Task, prove
from fddbench.design.solver import attempt, modelling
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["moderate", "optimal", "refuse_idle"]

SLACKS = (1e-5, 1e-4, 1e-3, 1e-2)
"""Steps above the smallest γ that are tried when the solver reaches it only in the limit of infinite gains [-]."""

IDLE = 0.99
"""Share of the γ of a zero residual [-] above which a filter is refused: it would hardly differ from zero."""

FLOOR = 0.3
"""``Y - Z ⪰ 0.3 I`` in the second step: gives the jet engine filters with poles between 0.01 and 3 rad/s."""


def optimal(task: Task) -> Proven:
    """Find the smallest γ with its filter, certified.

    Where the infimum asks for infinite gains the solver's point has no certificate; then the smallest of a few slightly
    larger γ that has one is the result. A value that the solver calls inaccurate is only ever used as such a hint.
    """
    cp = modelling()
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
        centred = _centred(task, hint + slack * max(hint, 0.1 * task.idle_gamma), 0.6)
        if centred and centred[0].certificate.holds:
            return centred[0]
    refuse_idle(hint, task.idle_gamma)
    raise DesignError(
        f"filter synthesis: {task.solver} stopped with status {status!r} at gamma about {hint:.5g}, and no gamma up to "
        f"{SLACKS[-1]:.1%} above it has a certificate; what a solver doubts proves nothing.\n"
        "Scale states and signals to about one (weights W_f, W_d, W_u), or try another solver."
    )


def refuse_idle(gamma: float, idle: float) -> None:
    """Refuse a γ that a residual which is always zero has as well."""
    if gamma >= IDLE * idle:
        raise DesignError(
            f"the best gamma is {gamma:.5g}, and a residual that is always zero has {idle:.5g}: for this reference no "
            "filter tells the faults from the rest. Reasons: disturbances or uncertainty as large as the faults (lower "
            "W_d, W_u, FA, FC), or a zero of the faults in the right half-plane (more outputs, or a reference with the "
            "same zero)."
        )


def moderate(task: Task, best: float, relax: float) -> Proven:
    """Find a filter of moderate size for γ a fraction `relax` above the best, or twice, four or eight times as far.

    γ stays below the middle between the best one and that of a zero residual, which would be the most moderate of all.
    """
    for factor in (1.0, 2.0, 4.0, 8.0):
        step = max(factor * relax * best, 1e-3 * task.idle_gamma)
        found = _moderate(task, best + min(step, 0.5 * (task.idle_gamma - best)), FLOOR)
        if found:
            return found
    raise DesignError(
        f"second step: {task.solver} finds no filter of moderate size within {8.0 * relax:.0%} of {best:.5g}; "
        "use a larger relax, or relax=None for the optimum alone."
    )


def _moderate(task: Task, gamma: float, floor: float) -> Proven | None:
    """Find a filter of moderate size: smallest ‖Â‖ with ``Y - Z ⪰ floor I``, so N = Z - Y is regular.

    Both refer to the coordinates of the plant; where that finds nothing, to the balanced ones, and last with the floor
    halved below the largest feasible one.
    """
    T, unit = task.T, np.eye(len(task.T))
    smallest = _smallest(task, gamma, floor, T) or _smallest(task, gamma, floor, unit)
    if smallest is None:
        centred = _centred(task, gamma, 2.0 * floor)
        if centred is None:
            return None
        smallest = _smallest(task, gamma, 0.5 * centred[1], unit) or centred[0]
    return smallest if smallest.certificate.holds else None


def _smallest(task: Task, gamma: float, floor: float, T: Floats) -> Proven | None:
    """Filter with the smallest ‖Â‖ above the floor in the coordinates ``T η``; None when it has no certificate."""
    cp = modelling()
    constraints, variables, multiplier = task.constraints(gamma)
    constraints.append(variables.Y - variables.Z >> floor * T.T @ T)
    inverse = np.linalg.inv(T)
    size = cp.norm(cp.vec(inverse.T @ variables.A @ inverse, order="F"), 2)
    if attempt(cp.Problem(cp.Minimize(size), constraints), task.solver, "second step") != "optimal":
        return None
    proven = prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma)
    return proven if proven.certificate.holds else None


def _centred(task: Task, gamma: float, most: float) -> tuple[Proven, float] | None:
    """Filter with the largest ``Y - Z ⪰ t I``, t ≤ most, in balanced coordinates, and t; None when none is found."""
    cp = modelling()
    constraints, variables, multiplier = task.constraints(gamma)
    t = cp.Variable()
    constraints += [variables.Y - variables.Z >> t * np.eye(len(task.T)), t <= most]
    if attempt(cp.Problem(cp.Maximize(t), constraints), task.solver, "second step") != "optimal":
        return None
    return prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma), float(t.value)
