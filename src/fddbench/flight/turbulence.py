"""Lateral Dryden gust, discretised exactly: its variance does not depend on the sample time.

The filter ``(1 + sqrt3 tau s) / (1 + tau s)^2`` with tau = L / V on white noise, as the two states
``x1' = -x1 / tau + w / sqrt(tau)``, ``x2' = (x1 - x2) / tau`` with the output ``sigma (sqrt3 x1 + (1 - sqrt3) x2)``.

Reference: MIL-F-8785C (1980), section 3.7.1; L = 1750 ft above 2000 ft.
"""

from typing import Any

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record

__all__ = ["SCALE_LENGTH_M", "WINDS", "CalmAir", "Gust", "GustConstants", "GustState", "LateralGust"]

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
    """Dryden's lateral gust as a block whose output is the gust [m/s], positive to the right.

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

    def prepare(self, normals: Rows, *, scale_ratio: Row, v_tas_m_s: Row, sample_s: float) -> GustConstants:
        """Constants of flights; the start is stationary.

        The process noise is ``P - F P F'`` with the stationary covariance P, so the variance is sigma^2 at every sample.

        Parameters
        ----------
        normals : (2, n_cases) rows
            As `before` names them.
        scale_ratio, v_tas_m_s : (n_cases,) rows
            Share of sigma [-], and true airspeed [m/s].
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
        return GustConstants(
            decay_ratio=e, coupling_ratio=f, noise_11=n11, noise_21=n21, noise_22=n22,
            sigma_m_s=self.sigma_m_s * scale_ratio, start=_stationary(normals),
        )  # fmt: skip

    def start(self, c: GustConstants) -> GustState:
        """Stationary."""
        return c.start

    def step(self, x: GustState, c: GustConstants, n: Rows, like: Row) -> tuple[GustState, Row]:
        """State at the next sample, and the gust at this one [m/s], (n_cases,)."""
        del like
        first = c.decay_ratio * x.first + c.noise_11 * n[0]
        second = c.coupling_ratio * x.first + c.decay_ratio * x.second + c.noise_21 * n[0] + c.noise_22 * n[1]
        gust_m_s = c.sigma_m_s * (_ROOT3 * x.first + (1.0 - _ROOT3) * x.second)
        return GustState(first=first, second=second), gust_m_s


def _stationary(normals: Rows) -> GustState:
    """States with the stationary covariance from two normals per case."""
    n11 = float(np.sqrt(_P11))
    n21 = _P21 / n11
    second = n21 * normals[0] + float(np.sqrt(_P22 - n21 * n21)) * normals[1]
    return GustState(first=n11 * normals[0], second=second)


class CalmAir:
    """No gust: a block without states, constants and draws."""

    states: Layout[Any] = NOTHING
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS
    before: Draws[Any] = NO_DRAWS

    def prepare(self, normals: Nothing, *, scale_ratio: Row, v_tas_m_s: Row, sample_s: float) -> Nothing:
        """No constants."""
        del scale_ratio, v_tas_m_s, sample_s
        return normals

    def start(self, c: Nothing) -> Nothing:
        """No state."""
        return c

    def step(self, x: Nothing, c: Nothing, n: Nothing, like: Row) -> tuple[Nothing, Row]:
        """No gust; `like` says of what shape, which a block without states cannot know."""
        del c, n
        return x, np.zeros_like(like)


Gust = LateralGust | CalmAir

WINDS: dict[str, Gust] = {
    "none": CalmAir(),
    "light": LateralGust(1.5),
    "moderate": LateralGust(3.0),
    "severe": LateralGust(6.0),
}
"""Winds by their names in campaigns, the default first; intensities [m/s] above 2000 ft by MIL-F-8785C."""
