"""One sample of ``w' = N w + a_0 + a_1 s + a_2 s^2`` with s from 0 to 1 over the sample: exact for a constant N.

``w[k+1] = exp(Z) w[k] + T sum_m m! phi_{m+1}(Z) a_m`` with ``Z = N T`` and ``phi_m(Z) = sum_j Z^j / (j + m)!``. Where N moves
with rho it is that of the sample before, as the whole schedule is, and the series ends with the power `POWERS`: the rest is
below ``2 z^(POWERS + 1) / (POWERS + 1)!`` of w and T a with z = |Z|.

References
----------
Hochbruck, Ostermann (2010), Exponential integrators, Acta Numerica 19, 209-286, section 2.
"""

from math import factorial

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column, product
from fddbench.interfaces import Floats

__all__ = ["POWERS", "Constant", "Varying", "rest_of_series"]

POWERS = 8
_ENOUGH = 40
"""Powers after which nothing is left of any filter that a sample can follow."""


def _factor(m: int, j: int) -> float:
    """Factor of Z^j in ``m! phi_{m+1}(Z)``."""
    return factorial(m) / factorial(j + m + 1)


def rest_of_series(norm: float) -> float:
    """Largest relative error of the series at ``|N| T = norm`` [-]."""
    return 2.0 * norm ** (POWERS + 1) / factorial(POWERS + 1)


class Constant:
    """Propagation with a constant N, (k, k), over T = `sample_s`; exact to rounding."""

    def __init__(self, N: Floats, sample_s: float) -> None:
        powers = [np.eye(len(N))]
        for _ in range(_ENOUGH):
            powers.append(powers[-1] @ N * sample_s)

        def summed(factors: list[float]) -> Floats:
            total: Floats = np.sum([factor * P for factor, P in zip(factors, powers, strict=True)], axis=0)
            return column(total)

        each = range(len(powers))
        self.decay = summed([1.0 / factorial(j) for j in each])
        self.weights = [sample_s * summed([_factor(m, j) for j in each]) for m in range(3)]

    def step(self, w: Rows, a: tuple[Rows, Rows, Rows]) -> Rows:
        """State at the next sample, (k, n_cases)."""
        after = product(self.decay, w)
        for weight, coefficient in zip(self.weights, a, strict=True):
            after = after + product(weight, coefficient)
        return after


class Varying:
    """Propagation with an N that moves, by its series, over T = `sample_s`."""

    def __init__(self, sample_s: float) -> None:
        self.sample_s = sample_s

    def step(self, N: Rows, w: Rows, a: tuple[Rows, Rows, Rows]) -> Rows:
        """State at the next sample, (k, n_cases), with N at the sample before, (k, k, n_cases)."""
        T = self.sample_s
        value: Rows = None
        for j in reversed(range(POWERS + 1)):
            term = w * (1.0 / factorial(j))
            for m, coefficient in enumerate(a):
                term = term + coefficient * (T * _factor(m, j))
            value = term if value is None else term + product(N, value) * T
        return value
