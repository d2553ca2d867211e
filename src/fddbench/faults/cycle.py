"""Where in a cycle of whole samples a fault stands, counted from its onset."""

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["into_cycle", "whole_samples"]


def whole_samples(time_s: Rows, sample_s: float) -> Rows:
    """Length of a cycle in samples, at least one: where a fault is not, its constants are zero.

    >>> whole_samples(np.array([0.05, 0.0]), 0.01)
    array([5., 1.])
    """
    return np.maximum(np.rint(time_s / sample_s), 1.0)


def into_cycle(since_samples: Rows, length: Rows) -> Rows:
    """Samples since the last cycle began, 0 at the onset.

    >>> into_cycle(np.arange(5.0), np.array([3.0]))
    array([0., 1., 2., 0., 1.])
    """
    return since_samples - length * np.floor(since_samples / length)
