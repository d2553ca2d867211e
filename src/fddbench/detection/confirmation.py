"""Confirmation times: how long a flag must stand before it counts."""

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["held_samples", "samples"]


def samples(time_s: float, sample_s: float) -> float:
    """Confirmation time in whole samples.

    >>> samples(0.1, 0.01)
    10.0
    """
    return float(round(time_s / sample_s))


def held_samples(count: Rows, flag: Rows) -> Rows:
    """Consecutive samples with the flag up, this one included, (n_cases,).

    A flag true at samples k0 to k has been held for ``k - k0`` samples, which is this count less one.
    """
    return np.where(flag, count + 1.0, 0.0)
