"""Whether the values of a column were asked for or drawn."""

import numpy as np

from fddbench.interfaces import Floats

__all__ = ["is_drawn"]


def is_drawn(values: Floats, run: Floats) -> bool:
    """Whether each of few values is that of one run of several: a course over these is one flight a point.

    Parameters
    ----------
    values, run : (n_rows,) arrays
        Values, not-a-number for none, and the runs that have them.

    Examples
    --------
    >>> run = np.array([0.0, 0.0, 1.0, 1.0])
    >>> is_drawn(np.array([3.2, 3.2, 4.7, 4.7]), run), is_drawn(np.array([3.0, 5.0, 3.0, 5.0]), run)
    (True, False)
    """
    own = [run[values == value] for value in np.unique(values[~np.isnan(values)])]
    return len(own) > 1 and float(np.ptp(run)) > 0.0 and all(np.ptp(each) == 0.0 for each in own)
