"""The two optimisations behind a design: the smallest γ, then a filter of moderate size for a slightly larger one."""

import numpy as np

from fddbench.design.admissible import IDLE
from fddbench.design.analysis import certified
from fddbench.design.exact import exact_filter
from fddbench.design.proof import Proven, Task, prove
from fddbench.design.solver import attempt, modelling
from fddbench.errors import DesignError

__all__ = ["moderate", "optimal", "refusal", "refuse_idle"]

SLACKS = (1e-5, 1e-4, 1e-3, 1e-2, 5e-2)
"""Steps above the smallest γ that are tried when the solver reaches it only in the limit of infinite gains [-]."""

NOTHING = 1e-4
"""Share of the γ of a zero residual [-] below which a filter may follow exactly, which is looked for then."""

FLOOR = 0.3
"""``Y - Z ⪰ 0.3 I`` in the second step: gives the jet engine filters with poles between 0.01 and 3 rad/s."""


def optimal(task: Task) -> Proven:
    """Find the smallest γ with its filter, certified.

    Where the infimum asks for infinite gains the solver's point has no certificate; then the smallest of a few slightly
    larger γ that has one is the result. A value that the solver calls inaccurate is only ever used as such a hint.

    Raises
    ------
    DesignError
        No certificate, see `refusal`.
    """
    hint, status, proven = _smallest_gamma(task)
    if hint <= NOTHING * task.idle_gamma:
        exact = exact_filter(task)
        if exact is not None:
            return exact
    if proven is not None and proven.certificate.holds:
        return proven
    for slack in SLACKS if hint < IDLE * task.idle_gamma else ():
        centred = certified(task, _centred(task, hint + slack * max(hint, 0.1 * task.idle_gamma), 0.6))
        if centred is not None:
            return centred
    stopped = f"status {status!r}"
    if hint < task.idle_gamma:
        stopped += f", at gamma about {hint:.4g}, which has no certificate"
    raise refusal(task, stopped)


def _smallest_gamma(task: Task) -> tuple[float, str, Proven | None]:
    """γ where the solver stops, its status, and the filter with a certificate that may fail; ∞ and none for a failure."""
    cp = modelling()
    level = cp.Variable()
    constraints, variables, multiplier = task.constraints(level)
    status = attempt(cp.Problem(cp.Minimize(level), constraints), task.solver, "filter synthesis")
    if status not in ("optimal", "optimal_inaccurate"):
        return float("inf"), status, None
    hint = max(task.coordinates.unit * float(level.value), 0.0)
    if status != "optimal":
        return hint, status, None
    return hint, status, prove(task, variables.value(task.plants[0].n_y), multiplier.value(), hint)


def refuse_idle(task: Task, gamma: float) -> None:
    """Refuse a γ that is not clearly below that of a residual which is always zero, see `refusal`."""
    if gamma >= IDLE * task.idle_gamma:
        raise refusal(task, "status 'optimal'")


def refusal(task: Task, stopped: str) -> DesignError:
    """Why there is no filter: the proof that none beats a zero residual, or that this solver only did not find one."""
    idle = task.idle_gamma
    bound = task.lower_bound()
    reasons = (
        "Reasons: disturbances or uncertainty as large as the faults (lower W_d, W_u, FA, FC), or a zero of the faults in "
        "the right half-plane (more outputs, or a reference with the same zero)."
    )
    if bound.gamma >= IDLE * idle:
        return DesignError(
            f"no filter tells the faults from the rest: a residual that is always zero has gamma {idle:.5g}, and no filter "
            f"for this reference has less than {bound.gamma:.5g}; the plant at {bound.frequency:.4g} rad/s proves it.\n"
            f"{reasons}"
        )
    return DesignError(
        f"{task.solver} ({stopped}) did not find a filter that is better than a residual that is always zero, which "
        f"has gamma {idle:.5g}; that is no proof that there is none: the lower bound is {bound.gamma:.5g}, at "
        f"{bound.frequency:.4g} rad/s, and what a solver doubts proves nothing.\n"
        "Try another solver, weights W_f, W_d, W_u that give f, d and u their sizes, a strictly proper reference, a smaller "
        f"uncertainty. {reasons}"
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
        f"second step: {task.solver} did not find a filter of moderate size within {8.0 * relax:.0%} of {best:.5g}; "
        "use a larger relax, or relax=None for the optimum alone."
    )


def _moderate(task: Task, gamma: float, floor: float) -> Proven | None:
    """Find a filter of moderate size: smallest ‖Â‖ with ``Y - Z ⪰ floor I``, so N = Z - Y is regular.

    Both refer to the plant's own states. Where that finds nothing, for instance where these are of very different size,
    the filter that is farthest inside the inequality is of moderate size as well.
    """
    smallest = _smallest(task, gamma, floor)
    if smallest is not None:
        return smallest
    return certified(task, _centred(task, gamma, 2.0 * floor))


def _smallest(task: Task, gamma: float, floor: float) -> Proven | None:
    """Filter with the smallest ‖Â‖ above the floor in the states of the plant; None when it has no certificate."""
    cp = modelling()
    T = task.coordinates.T
    constraints, variables, multiplier = task.constraints(gamma / task.coordinates.unit)
    constraints.append(variables.Y - variables.Z >> floor * T.T @ T)
    inverse = np.linalg.inv(T)
    size = cp.norm(cp.vec(inverse.T @ variables.A @ inverse, order="F"), 2)
    if attempt(cp.Problem(cp.Minimize(size), constraints), task.solver, "second step") != "optimal":
        return None
    proven = prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma)
    return proven if proven.certificate.holds else None


def _centred(task: Task, gamma: float, most: float) -> Proven | None:
    """Filter with the largest ``Y - Z ⪰ t I``, t ≤ most, in the coordinates of the optimisation; None when none is found."""
    cp = modelling()
    constraints, variables, multiplier = task.constraints(gamma / task.coordinates.unit)
    t = cp.Variable()
    constraints += [variables.Y - variables.Z >> t * np.eye(len(task.coordinates.T)), t <= most]
    if attempt(cp.Problem(cp.Maximize(t), constraints), task.solver, "second step") != "optimal":
        return None
    return prove(task, variables.value(task.plants[0].n_y), multiplier.value(), gamma)
