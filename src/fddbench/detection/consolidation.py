"""The flag: redundant sensors compared with their voted signal."""

from functools import reduce
from operator import and_

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import largest

__all__ = ["deviations_deg_s", "largest_deviation_deg_s", "outlier"]


def deviations_deg_s(sensors_deg_s: Rows, voted_deg_s: Rows) -> Rows:
    """Distance of every sensor from the voted signal [deg/s], (n_sensors, n_cases)."""
    return np.abs(voted_deg_s - sensors_deg_s)


def largest_deviation_deg_s(deviation_deg_s: Rows) -> Rows:
    """Largest distance [deg/s], (n_cases,)."""
    return largest(deviation_deg_s)


def outlier(deviation_deg_s: Rows) -> Rows:
    """1 for the sensor farthest from the voted signal, else 0, (n_sensors, n_cases); of equal ones the first.

    >>> outlier(np.array([[0.1], [0.4], [0.4]])).ravel()
    array([0., 1., 0.])
    """
    d = list(deviation_deg_s)
    rows = []
    for i in range(len(d)):
        conditions = [d[i] > d[j] if j < i else d[i] >= d[j] for j in range(len(d)) if j != i]
        rows.append(np.where(reduce(and_, conditions), 1.0, 0.0))
    return np.stack(rows)
