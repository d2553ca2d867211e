"""Integration of differential equations over one sample, its inputs held."""

from collections.abc import Callable

from fddbench.blocks.layout import Rows
from fddbench.blocks.repeat import repeat

__all__ = ["rk4"]


def rk4(derivative: Callable[..., Rows], x: Rows, *fixed: Rows, step_s: float, substeps: int = 1) -> Rows:
    """State at the end of a step by the classical Runge-Kutta method of order 4.

    The error of a step is of order ``(step_s / substeps)^5``. Compiled, substeps are a loop: a thousand of them compile as
    fast as two.

    Parameters
    ----------
    derivative : callable
        ``xdot = derivative(x, *fixed)``, rows as `x`; it may use values from outside, which are held during the step.
    x : (n, n_cases) rows
        State at the beginning.
    fixed : rows
        Handed over to `derivative`.
    step_s : float
        Length of the step [s].
    substeps : int
        Equal parts it is taken in, at least 1.

    References
    ----------
    Hairer, Norsett, Wanner (1993), Solving Ordinary Differential Equations I, 2nd edition, section II.1.

    Examples
    --------
    >>> import numpy as np
    >>> x = rk4(lambda x, rate: rate * x, np.array([[1.0]]), -1.0, step_s=1.0, substeps=10)
    >>> round(float(x[0, 0] - np.exp(-1.0)), 8)
    3.3e-07
    """
    if substeps < 1:
        raise ValueError(f"need substeps >= 1, got {substeps=}")
    h = step_s / substeps

    def step(x: Rows, *fixed: Rows) -> Rows:
        k1 = derivative(x, *fixed)
        k2 = derivative(x + (0.5 * h) * k1, *fixed)
        k3 = derivative(x + (0.5 * h) * k2, *fixed)
        k4 = derivative(x + h * k3, *fixed)
        return x + (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)

    return repeat(step, x, *fixed, count=substeps)
