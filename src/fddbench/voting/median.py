"""Median of redundant sensors."""

import numpy as np

from fddbench.blocks.layout import Row, Rows

__all__ = ["Median"]


class Median:
    """Middle value of the sensors (of an even number the mean of the two middle ones): fewer than half are out-voted.

    With three sensors one arbitrary fault is out-voted, two equal ones win.
    """

    about = "middle value of the sensors"

    def vote(self, sensors: Rows) -> Row:
        """Voted signal, (n_cases,), of (n_sensors, n_cases) sensors.

        >>> Median().vote(np.array([[1.0], [9.0], [2.0]]))
        array([2.])
        >>> Median().vote(np.array([[1.0], [9.0], [2.0], [4.0]]))
        array([3.])
        """
        rows = list(sensors)
        if len(rows) == 3:
            a, b, c = rows
            return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
        for last in range(len(rows) - 1, 0, -1):
            for j in range(last):
                rows[j], rows[j + 1] = np.minimum(rows[j], rows[j + 1]), np.maximum(rows[j], rows[j + 1])
        middle = len(rows) // 2
        return rows[middle] if len(rows) % 2 else 0.5 * (rows[middle - 1] + rows[middle])
