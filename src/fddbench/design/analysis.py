"""A filter that is given, and the Lyapunov matrix that proves most for it.

The Lyapunov matrix that comes with a synthesis is as good as singular where γ is near its infimum, and then proves nothing
in floating point although the filter is good. With the filter fixed another one can be far from singular.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.gramians import input_normal
from fddbench.design.multipliers import Multiplier, MultiplierVariables
from fddbench.design.problem import ClosedLoop, Filter, close
from fddbench.design.proof import Proven, Task, proved
from fddbench.design.quadratic import gain_matrix
from fddbench.design.solver import attempt, modelling
from fddbench.interfaces import Floats

__all__ = ["certified", "storage"]

SOLVED = ("optimal", "optimal_inaccurate")
"""A point of these is worth a certificate; it is the certificate that counts."""


def certified(task: Task, candidate: Proven | None) -> Proven | None:
    """The candidate, if its certificate holds or the filter gets another one that does; else None."""
    if candidate is None or candidate.certificate.holds or candidate.solution is None:
        return candidate
    filter_ = candidate.solution.filter()
    if not filter_.as_system().stable():
        return None
    found = storage(task, filter_, candidate.gamma / task.coordinates.unit)
    if found is None:
        return None
    P, multiplier = found
    c = task.coordinates
    used = c.multiplier_back(multiplier) if task.blocks else None
    again = proved(task, candidate.filter, c.lyapunov_back(P), used, candidate.gamma, candidate.solution)
    return again if again.certificate.holds else None


def storage(task: Task, filter_: Filter, level: float | None) -> tuple[Floats, Multiplier] | None:
    """P and multipliers with the largest margin for a filter, all in the coordinates of the task; None without any.

    Parameters
    ----------
    filter_ : Filter
        In the coordinates of the task.
    level : float or None
        γ in their unit; None leaves the residuals out: that the loops are stable, and lose V but for ``|v|²``.
    """
    cp = modelling()
    reference = task.coordinates.reference(task.reference)
    loops = [close(plant, reference, filter_) for plant in task.scaled]
    if level is None:
        loops = [replace(loop, C=loop.C[:0], D=loop.D[:0], Fr2=loop.Fr2[:0]) for loop in loops]
    T = input_normal(loops[0].A, np.hstack([loops[0].B, loops[0].Fr1]), share=1e-4)
    inverse = np.asarray(np.linalg.inv(T), dtype=float)
    loops = [_in_states(loop, T, inverse) for loop in loops]
    n, S, t = len(T), MultiplierVariables(task.blocks), cp.Variable()
    P = cp.Variable((n, n), symmetric=True)
    gamma = 1.0 if level is None else level
    conditions = [P >> t * np.eye(n), t <= 0.1]
    for loop in loops:
        matrix = gain_matrix(P, loop, S, gamma)
        loss = block_diag(-(loops[0].A + loops[0].A.T), gamma * np.eye(matrix.shape[0] - n))
        conditions.append(matrix << -t * loss)
    if attempt(cp.Problem(cp.Maximize(t), conditions), task.solver, "certificate") not in SOLVED:
        return None
    return np.asarray(inverse.T @ P.value @ inverse, dtype=float), S.value()


def _in_states(loop: ClosedLoop, T: Floats, inverse: Floats) -> ClosedLoop:
    """The loop with the states η of ``ζ = T η``."""
    return replace(
        loop,
        A=inverse @ loop.A @ T, B=inverse @ loop.B, Fr1=inverse @ loop.Fr1,
        C=loop.C @ T, Er1=loop.Er1 @ T,
    )  # fmt: skip
