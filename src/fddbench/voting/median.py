"""Median of three sensors."""

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["Median"]


class Median:
    """Middle value of three sensors: one arbitrary fault is out-voted, two equal ones win."""

    def vote(self, sensors: Rows) -> Rows:
        """Voted signal, (n_cases,), of (3, n_cases) sensors.

        >>> Median().vote(np.array([[1.0], [9.0], [2.0]]))
        array([2.])
        """
        a, b, c = sensors
        return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
