"""Filters that follow their reference exactly: where the measured signals contain the faults at once, no noise added."""

import numpy as np

from fddbench.design.analysis import storage
from fddbench.design.multipliers import Multiplier
from fddbench.design.problem import Filter
from fddbench.design.proof import Proven, Task, proved
from fddbench.interfaces import Floats

__all__ = ["exact_filter"]

ROUNDING = 1e-11
"""Largest part of the faults [-] that a static gain may miss and still count as exact."""


def exact_filter(task: Task) -> Proven | None:
    """Filter ``T_ref K`` of a static gain K with ``K (y, u) = f`` for every plant of the set; None where there is none.

    Its error is zero, so what makes a certificate is that the set is quadratically stable: a Lyapunov matrix and
    multipliers for that, scaled down until rounding is all that is left, prove a γ of about 1e-8 of the reference's.
    """
    K = _static_inverse(task)
    if K is None:
        return None
    R = task.coordinates.reference(task.reference)
    n_y = task.plants[0].n_y
    B, D = R.B @ K, R.D @ K
    filter_ = Filter(Ak=R.A, Bky=B[:, :n_y], Bku=B[:, n_y:], Ck=R.C, Dky=D[:, :n_y], Dku=D[:, n_y:])
    found = storage(task, filter_, None)
    if found is None:
        return None
    for scale in (1e-10, 1e-9, 1e-8, 1e-7, 1e-6):
        exact = _scaled(task, filter_, *found, scale)
        if exact.certificate.holds:
            return exact
    return None


def _static_inverse(task: Task) -> Floats | None:
    """K with ``K (Cm, Dm, Fm) = (Wc, Wd, 0)`` for all plants; None when there is none."""
    seen = np.hstack([np.hstack([plant.Cm, plant.Dm, plant.Fm]) for plant in task.scaled])
    wanted = np.hstack(
        [np.hstack([plant.Wc, plant.Wd, np.zeros((len(plant.Wc), plant.F.shape[1]))]) for plant in task.scaled]
    )
    sizes = np.linalg.norm(seen, axis=0)
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    K = np.asarray(np.linalg.lstsq((seen / sizes).T, (wanted / sizes).T, rcond=1e-13)[0].T, dtype=float)
    missed = np.abs(K @ seen - wanted).max(initial=0.0)
    return K if missed <= ROUNDING * np.abs(wanted).max(initial=0.0) else None


def _scaled(task: Task, filter_: Filter, P: Floats, multiplier: Multiplier, scale: float) -> Proven:
    """The filter with everything that proves it times `scale`, which is its γ."""
    c = task.coordinates
    small = Multiplier(S_w=scale * multiplier.S_w, S_z=scale * multiplier.S_z, G=scale * multiplier.G)
    used = c.multiplier_back(small) if task.blocks else None
    return proved(task, c.filter_back(filter_), c.lyapunov_back(scale * P), used, scale * c.unit, None)
