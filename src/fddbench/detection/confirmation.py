"""Confirmation times: how long a flag must stand before it counts."""

from math import ceil

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["held_samples", "samples"]


def samples(time_s: float, sample_s: float) -> float:
    """Confirmation time in whole samples, never shorter than asked.

    >>> samples(0.1, 0.01), samples(0.1, 0.04)
    (10.0, 3.0)
    """
    return float(ceil(time_s / sample_s - 1e-9))


def held_samples(count: Rows, flag: Rows) -> Rows:
    """Consecutive samples with the flag up, this one included, (n_cases,).

    A flag true at samples k0 to k has been held for ``k - k0`` samples, which is this count less one.
    """
    return np.where(flag, count + 1.0, 0.0)
