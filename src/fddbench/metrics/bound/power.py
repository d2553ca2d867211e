"""The probability with which an ideal test finds a fault of a given detectability."""

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["P_FA", "power"]

P_FA = 1e-6
"""Probability of a false alarm of one decision, unless a caller says otherwise [-]."""


def power(d: npt.ArrayLike, p_fa: float = P_FA) -> Floats:
    """P_D of the most powerful test between two known means that are d standard deviations apart: ``Φ(d - z(P_FA))``.

    Parameters
    ----------
    d : array
        Detectability [-].
    p_fa : float
        Probability of a false alarm of its one decision, between 0 and 1 [-].

    Returns
    -------
    array
        Probability that the fault is found [-]; p_fa itself where d is 0.

    References
    ----------
    Neyman and Pearson (1933), On the problem of the most efficient tests of statistical hypotheses, Philosophical
    Transactions of the Royal Society A 231, 289-337.

    Examples
    --------
    >>> power([0.0, 5.5, 7.08]).round(3)
    array([0.   , 0.772, 0.99 ])
    """
    if not 0.0 < p_fa < 1.0:
        raise FddbenchError(f"need a probability of false alarm above 0 and below 1, got {p_fa=:g}")
    found: Floats = ndtr(np.asarray(d, dtype=float) + ndtri(p_fa))
    return found
