"""Which sensors are the faulty ones, once their number is known."""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import total
from fddbench.blocks.primitives import rarely

__all__ = ["choose", "latch"]


def choose(outlier: Rows, n_faulty: Rows, tripped: Rows, energy: Rows) -> Rows:
    """Sites to declare, 1 or 0, (n_sites, n_cases): as many as `n_faulty`, chosen in this order.

    First sensors on which the energy monitor has tripped, the larger energy before the smaller; then, for one faulty
    sensor, the outlier; for two, those that agree with the voted signal (it is the wrong pair that has won the vote).
    The energy monitor chooses which sites, never how many.

    Parameters
    ----------
    outlier, tripped : (n_sites, n_cases) rows
        1 where the sensor is farthest from the voted signal, and where its energy monitor has tripped.
    n_faulty : (n_cases,) row
        Number of faulty sensors, 0, 1 or 2.
    energy : (n_sites, n_cases) rows
        Not negative; any unit.
    """
    logic = np.where(n_faulty >= 2.0, 1.0 - outlier, outlier)
    # not tripped: -2 or -1, below every energy
    score = list(np.where(tripped > 0.0, energy, logic - 2.0))
    rows = []
    for i in range(len(score)):
        before = [score[j] >= score[i] if j < i else score[j] > score[i] for j in range(len(score)) if j != i]
        rank = total([np.where(ahead, 1.0, 0.0) for ahead in before])
        rows.append(np.where(rank < n_faulty, 1.0, 0.0))
    return np.stack(rows)


def latch(declared: Rows, chosen: Rows, *, n_before: Rows, n_now: Rows) -> Rows:
    """Declared sites, (n_sites, n_cases): chosen anew only when the number of faulty sensors rises."""
    return np.where(rarely(n_now > n_before), chosen, declared)
