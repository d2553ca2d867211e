"""Lateral Dryden gust, discretised exactly: its variance does not depend on the sample time.

The filter ``(1 + sqrt3 tau s) / (1 + tau s)^2`` with tau = L / V on white noise, as the two states
``x1' = -x1 / tau + w / sqrt(tau)``, ``x2' = (x1 - x2) / tau`` with the output ``sigma (sqrt3 x1 + (1 - sqrt3) x2)``.

Reference: MIL-F-8785C (1980), section 3.7.1; L = 1750 ft above 2000 ft.
"""

from typing import Any

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.wind import AirMotion, Encounter, still

__all__ = ["SCALE_LENGTH_M", "GustConstants", "GustState", "LateralGust"]

SCALE_LENGTH_M = 533.4
_ROOT3 = float(np.sqrt(3.0))
# stationary covariance of (x1, x2) for unit output variance: [[1/2, 1/4], [1/4, 1/4]]
_P11, _P21, _P22 = 0.5, 0.25, 0.25


@record
class GustState:
    """The two states of the filter [-]."""

    first: Row
    second: Row


@record
class GustConstants:
    """Transition and noise factors [-], intensity, and the stationary states before sample 0 [-]."""

    decay_ratio: Row
    coupling_ratio: Row
    noise_11: Row
    noise_21: Row
    noise_22: Row
    sigma_m_s: Row
    start: GustState


class LateralGust:
    """Dryden's lateral gust alone, positive to the right, see `fddbench.flight.wind.Wind`.

    It has numbers of its own: `fddbench.flight.dryden` flies another v_g.

    Parameters
    ----------
    sigma_m_s : float
        One sigma [m/s].
    """

    states = Layout(GustState(first=ROW, second=ROW))
    constants = Layout(
        GustConstants(
            decay_ratio=ROW, coupling_ratio=ROW, noise_11=ROW, noise_21=ROW, noise_22=ROW, sigma_m_s=ROW,
            start=GustState(first=ROW, second=ROW),
        )
    )  # fmt: skip
    draws: Draws[Any] = Draws(Draw(consumers.GUST, rows=2))
    before: Draws[Any] = Draws(Draw(consumers.START, rows=2))

    def __init__(self, sigma_m_s: float) -> None:
        self.sigma_m_s = sigma_m_s

    def prepare(self, normals: Rows, meets: Encounter, sample_s: float) -> GustConstants:
        """Constants of flights; the start is stationary.

        The process noise is ``P - F P F'`` with the stationary covariance P, so the variance is sigma^2 at every sample.

        Parameters
        ----------
        normals : (2, n_cases) rows
            As `before` names them.
        meets : Encounter
            Of which share and airspeed count.
        """
        meets = meets.spread()
        a = sample_s * meets.v_tas_m_s / SCALE_LENGTH_M
        e = exp(-a)
        f = a * e
        q11 = _P11 - e * e * _P11
        q21 = _P21 - e * (f * _P11 + e * _P21)
        q22 = _P22 - (f * f * _P11 + 2.0 * f * e * _P21 + e * e * _P22)
        n11 = np.sqrt(q11)
        n21 = q21 / n11
        n22 = np.sqrt(np.maximum(q22 - n21 * n21, 0.0))
        return GustConstants(
            decay_ratio=e, coupling_ratio=f, noise_11=n11, noise_21=n21, noise_22=n22,
            sigma_m_s=self.sigma_m_s * meets.scale_ratio, start=_stationary(normals),
        )  # fmt: skip

    def start(self, c: GustConstants) -> GustState:
        """Stationary."""
        return c.start

    def step(self, x: GustState, c: GustConstants, n: Rows, sample: Row, like: Row) -> tuple[GustState, AirMotion]:
        """State at the next sample, and the motion of the air at this one."""
        del sample
        first = c.decay_ratio * x.first + c.noise_11 * n[0]
        second = c.coupling_ratio * x.first + c.decay_ratio * x.second + c.noise_21 * n[0] + c.noise_22 * n[1]
        gust_m_s = c.sigma_m_s * (_ROOT3 * x.first + (1.0 - _ROOT3) * x.second)
        return GustState(first=first, second=second), still(like, v_m_s=gust_m_s)


def _stationary(normals: Rows) -> GustState:
    """States with the stationary covariance from two normals per case."""
    n11 = float(np.sqrt(_P11))
    n21 = _P21 / n11
    second = n21 * normals[0] + float(np.sqrt(_P22 - n21 * n21)) * normals[1]
    return GustState(first=n11 * normals[0], second=second)
