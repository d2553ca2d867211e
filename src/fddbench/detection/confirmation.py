"""Confirmation times: how long a flag must stand before it counts."""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.clock import misfit
from fddbench.clock import samples as whole
from fddbench.errors import DesignError

__all__ = ["held_samples", "samples"]


def samples(name: str, time_s: float, sample_s: float, *, least: int = 0) -> float:
    """Time of a design in whole samples.

    Parameters
    ----------
    name : str
        Key of the time in the design, for the message.
    least : int
        Fewest samples that it may last.

    Raises
    ------
    DesignError
        The time does not fit the clock: the design was made for another.

    Examples
    --------
    >>> samples("confirm_two_s", 0.1, 0.01)
    10.0
    """
    wrong = misfit(time_s, sample_s, least=least)
    if wrong:
        raise DesignError(
            f"{name} {wrong}. This design was made for another clock: copy it with times that fit and tune it again, or "
            "change sample_s"
        )
    return float(whole(time_s, sample_s))


def held_samples(count: Rows, flag: Rows) -> Rows:
    """Consecutive samples with the flag up, this one included, (n_cases,).

    A flag true at samples k0 to k has been held for ``k - k0`` samples, which is this count less one.
    """
    return np.where(flag, count + 1.0, 0.0)
