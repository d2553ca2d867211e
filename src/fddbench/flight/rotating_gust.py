"""The lateral gust with the rotations that go with it: its gradient along the path, r_g, and a roll of its own, p_g.

The velocity keeps every bit that `fddbench.flight.turbulence.LateralGust` gives. With v the gust, b the span:

    r_g = (v - z) / (V T_b),  z' = (v - z) / T_b,  T_b = 3 b / (pi V):  (s / V) / (1 + T_b s) of v, held over a sample
    p_g first order with the lag 4 b / (pi V), sigma as in `fddbench.flight.dryden`

Both are stationary at sample 0: z is drawn from its covariance with the states of the gust.

Reference: MIL-F-8785C (1980), section 3.7.5.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.dryden import INTENSITIES_M_S, roll_gust_per_m
from fddbench.flight.turbulence import SCALE_LENGTH_M, GustConstants, GustState, LateralGust
from fddbench.flight.wind import AirMotion, CalmAir, Encounter, Wind

__all__ = ["LATERAL_WINDS", "RotatingGust"]

_FIRST, _SECOND = float(np.sqrt(3.0)), 1.0 - float(np.sqrt(3.0))
"""Gust of one sigma: so much of its first and of its second state."""


@record
class RotatingState:
    """States of the gust, the gust behind the span's lag [m/s], p_g of one sigma [-]."""

    gust: GustState
    smooth_m_s: Row
    roll: Row


@record
class RotatingConstants:
    """The gust; what is kept of z and of p_g from sample to sample [-], noise of p_g [-], its sigma [rad/s], 1 / (V T_b)."""

    gust: GustConstants
    smooth_decay: Row
    roll_decay: Row
    roll_noise: Row
    roll_rad_s: Row
    gradient_per_m: Row
    smooth_m_s: Row
    roll: Row


@record
class RotatingDraws:
    """Normal numbers of the gust and of p_g (before sample 0: of z besides)."""

    gust: Rows
    roll: Any


class RotatingGust:
    """Dryden's v_g with r_g and p_g, see `fddbench.flight.wind.Wind`.

    Parameters
    ----------
    gust : LateralGust
        The gust that rotates.
    """

    draws: Draws[Any] = Draws(RotatingDraws(gust=LateralGust.draws.names, roll=Draw(consumers.GUST, 2)))
    before: Draws[Any] = Draws(RotatingDraws(gust=LateralGust.before.names, roll=Draw(consumers.START, 2, rows=2)))
    states = Layout(RotatingState(gust=LateralGust.states.shape, smooth_m_s=ROW, roll=ROW))
    constants = Layout(
        RotatingConstants(
            gust=LateralGust.constants.shape, smooth_decay=ROW, roll_decay=ROW, roll_noise=ROW, roll_rad_s=ROW,
            gradient_per_m=ROW, smooth_m_s=ROW, roll=ROW,
        )
    )  # fmt: skip

    def __init__(self, gust: LateralGust) -> None:
        self.gust, self.sigma_m_s = gust, gust.sigma_m_s
        self.about = f"Dryden's lateral gust of {gust.sigma_m_s:g} m/s, with its rotations"

    def prepare(self, normals: RotatingDraws, meets: Encounter, sample_s: float) -> RotatingConstants:
        """Constants of flights."""
        meets = meets.spread()
        gust = self.gust.prepare(normals.gust, meets, sample_s)
        along_s = meets.span_m / meets.v_tas_m_s
        smooth_s, roll_s = 3.0 / np.pi * along_s, 4.0 / np.pi * along_s
        decay = exp(-sample_s / roll_s)
        return RotatingConstants(
            gust=gust,
            smooth_decay=exp(-sample_s / smooth_s),
            roll_decay=decay,
            roll_noise=np.sqrt((1.0 - decay) * (1.0 + decay)),
            roll_rad_s=gust.sigma_m_s * roll_gust_per_m(meets.span_m),
            gradient_per_m=1.0 / (meets.v_tas_m_s * smooth_s),
            smooth_m_s=gust.sigma_m_s
            * _smoothed(gust.start, SCALE_LENGTH_M / meets.v_tas_m_s / smooth_s, normals.roll[1]),
            roll=normals.roll[0],
        )

    def start(self, c: RotatingConstants) -> RotatingState:
        """Stationary."""
        return RotatingState(gust=self.gust.start(c.gust), smooth_m_s=c.smooth_m_s, roll=c.roll)

    def step(
        self, x: RotatingState, c: RotatingConstants, n: RotatingDraws, sample: Row, like: Row
    ) -> tuple[RotatingState, AirMotion]:
        """State at the next sample, and the motion of the air at this one."""
        gust, air = self.gust.step(x.gust, c.gust, n.gust, sample, like)
        ahead = air.v_m_s - x.smooth_m_s
        after = RotatingState(
            gust=gust,
            smooth_m_s=air.v_m_s - c.smooth_decay * ahead,
            roll=c.roll_decay * x.roll + c.roll_noise * n.roll,
        )
        return after, replace(air, p_rad_s=c.roll_rad_s * x.roll, r_rad_s=c.gradient_per_m * ahead)


def _smoothed(x: GustState, k: Row, normal: Row) -> Row:
    """Lagged gust z of a gust of one sigma before sample 0, with the stationary covariance of ``z' = k (v - z)`` (time in tau).

    The gust's states have the covariance [[1/2, 1/4], [1/4, 1/4]], so m = E[z x] follows from ``0 = k E[v x1] - (1 + k) m1``
    and ``0 = m1 + k E[v x2] - (1 + k) m2``, and E[z z] = E[z v].
    """
    m1 = k * (0.5 * _FIRST + 0.25 * _SECOND) / (1.0 + k)
    m2 = (m1 + k * (0.25 * _FIRST + 0.25 * _SECOND)) / (1.0 + k)
    a, b = 4.0 * (m1 - m2), 4.0 * (2.0 * m2 - m1)
    rest = _FIRST * m1 + _SECOND * m2 - a * m1 - b * m2
    return a * x.first + b * x.second + np.sqrt(np.maximum(rest, 0.0)) * normal


LATERAL_WINDS: dict[str, Wind] = {
    "none": CalmAir(),
    **{name: RotatingGust(LateralGust(sigma_m_s)) for name, sigma_m_s in INTENSITIES_M_S.items()},
}
"""Winds of a lateral model by their names in campaigns, the default first; intensities [m/s] above 2000 ft by MIL-F-8785C."""
