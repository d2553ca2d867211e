"""Mean of the two sensors that agree best."""

from itertools import combinations

import numpy as np

from fddbench.blocks.layout import Row, Rows

__all__ = ["ClosestTwo"]


class ClosestTwo:
    """Mean of the closest pair of sensors; of equally close pairs the first in the order 12, 13, …, 23, …."""

    about = "mean of the two sensors that agree best"

    def vote(self, sensors: Rows) -> Row:
        """Voted signal, (n_cases,), of (n_sensors, n_cases) sensors, at least two.

        >>> ClosestTwo().vote(np.array([[1.0], [9.0], [2.0]]))
        array([1.5])
        """
        pairs = list(combinations(list(sensors), 2))
        apart, voted = np.abs(pairs[0][0] - pairs[0][1]), 0.5 * (pairs[0][0] + pairs[0][1])
        for a, b in pairs[1:]:
            closer = np.abs(a - b) < apart
            voted = np.where(closer, 0.5 * (a + b), voted)
            apart = np.where(closer, np.abs(a - b), apart)
        return voted
