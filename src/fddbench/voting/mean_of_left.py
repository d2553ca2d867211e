"""Mean of the sensors that are left in a vote."""

import numpy as np

from fddbench.blocks.layout import Row, Rows

__all__ = ["mean_of_left"]


def mean_of_left(sensors: Rows, out: Rows, otherwise: Row) -> Row:
    """Mean of the sensors that are not out, (n_cases,); `otherwise` where none or all of them are out.

    Parameters
    ----------
    sensors, out : (n_sensors, n_cases) rows
        Readings; 1 where one has left the vote, else 0.
    otherwise : (n_cases,) row
        What is voted where nobody has left, and where nobody would be left.

    Examples
    --------
    >>> sensors = np.array([[1.0, 1.0, 1.0], [9.0, 9.0, 9.0], [2.0, 2.0, 2.0]])
    >>> out = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])
    >>> mean_of_left(sensors, out, np.array([2.0, 2.0, 2.0]))
    array([2. , 1.5, 2. ])
    """
    total, left = 0.0 * sensors[0], 0.0 * sensors[0]
    for value, gone in zip(sensors, out, strict=True):
        total = total + np.where(gone > 0.5, 0.0, value)
        left = left + np.where(gone > 0.5, 0.0, 1.0)
    some = (left > 0.5) & (left < len(sensors) - 0.5)
    return np.where(some, total / np.maximum(left, 1.0), otherwise)
