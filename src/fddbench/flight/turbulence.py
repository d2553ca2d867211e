"""Lateral Dryden gust, discretised exactly: its variance does not depend on the sample time.

The filter ``(1 + sqrt3 tau s) / (1 + tau s)^2`` with tau = L / V on white noise, as the two states
``x1' = -x1 / tau + w / sqrt(tau)``, ``x2' = (x1 - x2) / tau`` with the output ``sigma (sqrt3 x1 + (1 - sqrt3) x2)``.

Reference: MIL-F-8785C (1980), section 3.7.1; L = 1750 ft above 2000 ft.
"""

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Rows

__all__ = ["GUST_CONSTANTS", "SCALE_LENGTH_M", "WINDS_M_S", "gust_constants", "gust_m_s", "gust_start", "gust_step"]

SCALE_LENGTH_M = 533.4
WINDS_M_S = {"none": 0.0, "light": 1.5, "moderate": 3.0, "severe": 6.0}
"""One sigma of the lateral gust by wind [m/s], above 2000 ft."""
GUST_CONSTANTS = Layout(decay_ratio=0, coupling_ratio=0, noise_11=0, noise_21=0, noise_22=0, sigma_m_s=0)
_ROOT3 = float(np.sqrt(3.0))
# stationary covariance of (x1, x2) for unit output variance: [[1/2, 1/4], [1/4, 1/4]]
_P11, _P21, _P22 = 0.5, 0.25, 0.25


def gust_constants(*, sigma_m_s: Rows, v_tas_m_s: Rows, sample_s: float) -> Rows:
    """Transition and noise factors of every case, rows of `GUST_CONSTANTS`.

    The process noise is ``P - F P F'`` with the stationary covariance P, so the variance is sigma^2 at every sample.
    """
    a = sample_s * v_tas_m_s / SCALE_LENGTH_M
    e = exp(-a)
    f = a * e
    q11 = _P11 - e * e * _P11
    q21 = _P21 - e * (f * _P11 + e * _P21)
    q22 = _P22 - (f * f * _P11 + 2.0 * f * e * _P21 + e * e * _P22)
    n11 = np.sqrt(q11)
    n21 = q21 / n11
    n22 = np.sqrt(np.maximum(q22 - n21 * n21, 0.0))
    return GUST_CONSTANTS.pack(
        decay_ratio=e, coupling_ratio=f, noise_11=n11, noise_21=n21, noise_22=n22, sigma_m_s=sigma_m_s
    )


def gust_start(normals: Rows) -> Rows:
    """Stationary gust states, (2, n_cases), from two normals per case."""
    n11 = float(np.sqrt(_P11))
    n21 = _P21 / n11
    return np.stack([n11 * normals[0], n21 * normals[0] + float(np.sqrt(_P22 - n21 * n21)) * normals[1]])


def gust_step(state: Rows, constants: Rows, normals: Rows) -> Rows:
    """Gust states at the next sample, (2, n_cases)."""
    c = GUST_CONSTANTS.unpack(constants)
    first = c.decay_ratio * state[0] + c.noise_11 * normals[0]
    second = c.coupling_ratio * state[0] + c.decay_ratio * state[1] + c.noise_21 * normals[0] + c.noise_22 * normals[1]
    return np.stack([first, second])


def gust_m_s(state: Rows, constants: Rows) -> Rows:
    """Lateral gust [m/s], (n_cases,), positive to the right."""
    return GUST_CONSTANTS.unpack(constants).sigma_m_s * (_ROOT3 * state[0] + (1.0 - _ROOT3) * state[1])
