"""Ring buffer: the value of n samples ago, at the cost of one load and one store whatever the depth."""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.primitives import pick

__all__ = ["ring"]


def ring(rows: Rows, value: Rows, sample: Rows) -> tuple[Rows, Rows]:
    """Rows after writing, and what was written ``len(rows)`` samples ago (what the rows started with, before that).

    Compiled, a ring whose rows are consecutive state rows, in and out, is addressed by the sample number; otherwise
    each row is compared with it.

    Parameters
    ----------
    rows : (n, n_cases) array
        State of the ring.
    value : (n_cases,) array
        Value of this sample.
    sample : number or (n_cases,) array
        Number of the sample; it must rise by one from call to call and be the same for all cases.

    Examples
    --------
    >>> rows, old = np.zeros((2, 1)), []
    >>> for k in range(5):
    ...     rows, oldest = ring(rows, np.array([10.0 + k]), np.float64(k))
    ...     old.append(float(oldest[0]))
    >>> old
    [0.0, 0.0, 10.0, 11.0, 12.0]
    """
    depth = len(rows)
    phase = sample - depth * np.floor(sample / depth)
    oldest = pick(phase, *rows)
    return np.stack([np.where(phase == float(j), value, rows[j]) for j in range(depth)]), oldest
