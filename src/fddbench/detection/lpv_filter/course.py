"""What outputs and inputs do between two samples.

A filter integrates the outputs, and what it takes between two samples is all the error it makes: to hold them would cost a lag
of half a sample, 1 % of the plant's own acceleration at 10 ms and 2 1/s. Inputs that the plant holds are held; then the
outputs bend as ``y'' = C A(rho) C^+ y'``, whatever a fault adds to an input, since that is held as well. So they are taken as

    y(s) = y_0 + s (y_1 - y_0) + (s^2 - s) T K(rho) (y_1 - y_0) / 2,    K = C A C^+,    s from 0 to 1,

which leaves an error of the fourth order where the outputs give the state. Other inputs go along a straight line.
"""

from typing import NamedTuple

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import affine, column, product
from fddbench.interfaces import Floats

__all__ = ["Course", "course"]


class Course(NamedTuple):
    """Coefficients of 1, s and s^2 of the outputs, (n_y, n_cases) each, and of 1 and s of the inputs, (n_u, n_cases)."""

    y: tuple[Rows, Rows, Rows]
    u: tuple[Rows, Rows]


def course(
    y: tuple[Rows, Rows], u: tuple[Rows, Rows], rho: Rows, *, bend: Floats, smooth: Floats, sample_s: float
) -> Course:
    """Course over one sample.

    Parameters
    ----------
    y, u : two (n_y, n_cases) and two (n_u, n_cases) rows
        At its beginning and at its end.
    rho : (n_parameters, n_cases) rows
        At its beginning.
    bend : (n_parameters + 1 or 1, n_y, n_y, 1) array
        K.
    smooth : (n_u,) array
        1 for inputs that go along a straight line, 0 for those that are held.
    sample_s : float
        T [s].
    """
    rise = y[1] - y[0]
    bent = (0.5 * sample_s) * product(affine(bend, rho), rise)
    return Course((y[0], rise - bent, bent), (u[0], column(np.asarray(smooth)) * (u[1] - u[0])))
