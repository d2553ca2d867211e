"""Whether a fault can be told from the others: its direction outside their unobservability subspace, at every rho."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from fddbench.design.geometric.affine import Box, at
from fddbench.design.geometric.invariance import unobservability_subspace
from fddbench.design.geometric.subspaces import TOLERANCE, Matrix, complement, image, intersection, sine
from fddbench.errors import DesignError

__all__ = ["Solvability", "require_solvable", "solvability", "span"]


@dataclass(frozen=True, kw_only=True)
class Solvability:
    """How well a fault can be told from the others.

    Attributes
    ----------
    solvable : bool
        The pointwise condition: at no rho of the box does the direction L(rho) of the fault meet S*.
    smallest_angle_deg : float
        Between L(rho) and S*, over the box [deg], in the units of the states; the smallest of those looked at.
    condition_number : float
        1 / sin of it [-]: so much larger are the estimate's errors than for a fault at right angles to S*; inf where not
        solvable.
    at_rho : tuple of float
        Where it is smallest.
    sum_condition : bool
        Whether S* does not even meet the sum of the Im L_j (Proposition 4). Sufficient where L has one column, not needed.
    """

    solvable: bool
    smallest_angle_deg: float
    condition_number: float
    at_rho: tuple[float, ...]
    sum_condition: bool


def span(L: Matrix) -> Matrix:
    """``Im L_0 + Im L_1 + ...`` of a family, (n, k)."""
    return image(np.hstack(list(L)))


def solvability(S: Matrix, L: Matrix, box: Box) -> Solvability:
    """How a fault of direction L(rho) lies to a subspace S.

    For one column the point at which it comes nearest is found exactly (a convex problem) and added to those looked at; for
    several columns the box is sampled (`Box.looked_at`).

    Parameters
    ----------
    S : (n, k) matrix
    L : (n_parameters + 1, n, m) array
    """
    active = box.active(L)
    points = box.looked_at(active)
    if L.shape[2] == 1:
        points = np.vstack([points, _nearest(S, L, box)])
    found = [_sine_at(S, at(L, rho)) for rho in points]
    worst = int(np.argmin(found))
    s = float(found[worst])
    solvable = s > TOLERANCE
    return Solvability(
        solvable=solvable,
        smallest_angle_deg=float(np.rad2deg(np.arcsin(min(s, 1.0)))) if solvable else 0.0,
        condition_number=1.0 / s if solvable else float("inf"),
        at_rho=tuple(float(r) for r in points[worst]),
        sum_condition=not intersection(S, span(L)).shape[1],
    )


def _sine_at(S: Matrix, direction: Matrix) -> float:
    """Sine of the angle; 0 for a fault that does nothing there."""
    lengths = np.linalg.norm(direction, axis=0)
    return sine(S, direction) if np.all(lengths > 0.0) else 0.0


def _nearest(S: Matrix, L: Matrix, box: Box) -> Matrix:
    """Point of the box at which the part of L(rho) outside S is shortest, (n_parameters,)."""
    outside = np.einsum("ij,ajk->aik", complement(S).T, box.normalised(L))[:, :, 0]
    size = np.abs(outside).max(initial=0.0)
    if len(outside) == 1 or size == 0.0 or not outside.shape[1]:
        return box.centre
    found = lsq_linear(outside[1:].T / size, -outside[0] / size, bounds=(-1.0, 1.0), tol=1e-14)
    nearest: Matrix = box.centre + box.half * found.x
    return nearest


def require_solvable(
    name: str, found: Solvability, A: Matrix, C: Matrix, faults: Mapping[str, Matrix], box: Box
) -> None:
    """Refuse a fault that cannot be told from the others, and name those.

    Raises
    ------
    DesignError
        With the smallest set of others that hides it: a single one where there is one, else all.
    """
    if found.solvable:
        return
    others = [other for other in faults if other != name]
    where = f" at rho = {[float(f'{r:.4g}') for r in found.at_rho]}" if found.at_rho else ""
    if not np.all(np.linalg.norm(at(faults[name], np.array(found.at_rho)), axis=0) > 0.0):
        raise DesignError(
            f"fault {name!r} does nothing{where}: its direction is zero there. Take a box without that point"
        )
    if not _shows(C, A, faults[name], box):
        raise DesignError(
            f"fault {name!r} cannot be seen at all{where}: its direction lies in what the outputs never show. Measure more "
            "outputs, or give states in units in which the numbers of A and C are about one"
        )
    hiding = [
        other
        for other in others
        if not solvability(unobservability_subspace(list(A), C, span(faults[other])), faults[name], box).solvable
    ] or others
    together = " together" if len(hiding) > 1 and len(hiding) == len(others) else ""
    raise DesignError(
        f"fault {name!r} cannot be isolated from {' and '.join(map(repr, hiding))}{together}: its direction lies in their "
        f"smallest unobservability subspace{where}, so no residual can show it and be blind to them. Measure more outputs, "
        "watch them as one fault, or take a box without that point"
    )


def _shows(C: Matrix, A: Matrix, L: Matrix, box: Box) -> bool:
    """Whether the fault moves the outputs at all."""
    return solvability(unobservability_subspace(list(A), C, np.zeros((A.shape[1], 0))), L, box).solvable
