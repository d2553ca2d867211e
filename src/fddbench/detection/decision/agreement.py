"""What is left of redundant sensors once some are declared: how many, their mean, and how far apart they are."""

from itertools import combinations

import numpy as np

from fddbench.blocks.layout import Row, Rows
from fddbench.blocks.linear import largest, total

__all__ = ["live_mean", "live_sensors", "spread"]


def live_sensors(declared: Rows) -> Row:
    """Number of sensors that are not declared, (n_cases,).

    >>> live_sensors(np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]))
    array([2., 3.])
    """
    return total(1.0 - declared)


def live_mean(sensors: Rows, declared: Rows) -> Row:
    """Mean of the sensors that are not declared, (n_cases,), in their unit; 0 where all are.

    >>> live_mean(np.array([[9.0, 1.0], [1.0, 2.0], [2.0, 3.0]]), np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]))
    array([1.5, 2. ])
    """
    return total(np.where(declared > 0.0, 0.0, sensors)) / np.maximum(live_sensors(declared), 1.0)


def spread(sensors: Rows, declared: Rows) -> Row:
    """Largest difference of two sensors that are not declared, (n_cases,), in their unit; 0 where fewer than two are left.

    >>> spread(np.array([[9.0, 1.0], [1.0, 2.0], [2.0, 4.0]]), np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]))
    array([1., 3.])
    """
    apart = [
        np.where(declared[i] + declared[j] > 0.0, 0.0, np.abs(sensors[i] - sensors[j]))
        for i, j in combinations(range(len(sensors)), 2)
    ]
    return largest(apart)
