"""The discrete gust of certification: a hump of air that the aircraft flies through, from one side.

``U(s) = U_ds / 2 (1 - cos(pi s / H))`` for 0 <= s <= 2 H with the distance s flown into it [m], the gradient distance H from 9
to 107 m, and ``U_ds = U_ref F_g (H / 107 m)^(1/6)``, F_g = 1. U_ref is an equivalent airspeed: 17.07 m/s at sea level,
13.41 m/s at 15,000 ft, 6.36 m/s at 60,000 ft, linear between; the hump in true airspeed is larger by sqrt(rho0 / rho).

Reference: CS-25.341(a); the numbers were written down from memory of the rule. The aircraft flies into the hump as a whole: a
gust shorter than the aircraft is not what the equations of a rigid point describe, and its gradient is no rotation here.
"""

from typing import Any, Literal

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import cos, interpolate, pow_
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, record
from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import FT_M, density_kg_m3
from fddbench.flight.wind import AirMotion, Encounter, still

__all__ = ["HumpConstants", "OneMinusCosine", "design_gust_m_s"]

_ALTITUDE_FT, _REFERENCE_M_S = (0.0, 15000.0, 60000.0), (17.07, 13.41, 6.36)
_LONGEST_M, _SEA_LEVEL_KG_M3 = 107.0, 1.225
_TURN = 2.0 * np.pi
_COMPONENTS = {"up": ("w_m_s", -1.0), "down": ("w_m_s", 1.0), "right": ("v_m_s", 1.0), "left": ("v_m_s", -1.0)}


@record
class HumpConstants:
    """Phase gained in a sample [rad], the sample at which it begins, and half of the peak [m/s]."""

    phase_rad: Row
    begins: Row
    half_m_s: Row


def design_gust_m_s(altitude_m: Row, gradient_m: Row) -> Row:
    """Peak of the gust in true airspeed [m/s], ``U_ds sqrt(rho0 / rho)``, (n_cases,).

    >>> design_gust_m_s(np.zeros(1), np.full(1, 107.0)).round(3)
    array([17.07])
    """
    altitude_ft = altitude_m / FT_M
    reference_m_s = interpolate(altitude_ft, column(_ALTITUDE_FT), column(_REFERENCE_M_S))
    share = pow_(gradient_m / _LONGEST_M, 1.0 / 6.0)
    return reference_m_s * share * np.sqrt(_SEA_LEVEL_KG_M3 / density_kg_m3(altitude_ft))


class OneMinusCosine:
    """The hump as a wind, the same in every flight but for airspeed, altitude, gradient distance and share.

    Parameters
    ----------
    direction : {"up", "down", "right", "left"}
        Where the air goes.
    onset_s : float
        When the aircraft enters it [s].
    """

    states: Layout[Any] = NOTHING
    constants = Layout(HumpConstants(phase_rad=ROW, begins=ROW, half_m_s=ROW))
    draws: Draws[Any] = NO_DRAWS
    before: Draws[Any] = NO_DRAWS

    def __init__(self, direction: Literal["up", "down", "right", "left"], onset_s: float) -> None:
        self.component, self.sign = _COMPONENTS[direction]
        self.onset_s = onset_s

    def prepare(self, normals: Nothing, meets: Encounter, sample_s: float) -> HumpConstants:
        """Constants of flights, see `fddbench.flight.wind.Wind`."""
        del normals
        meets = meets.spread()
        peak_m_s = meets.scale_ratio * design_gust_m_s(meets.altitude_m, meets.gradient_m)
        return HumpConstants(
            phase_rad=np.pi * meets.v_tas_m_s * sample_s / meets.gradient_m,
            begins=np.full_like(peak_m_s, self.onset_s / sample_s),
            half_m_s=0.5 * self.sign * peak_m_s,
        )

    def start(self, c: HumpConstants) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: HumpConstants, n: Nothing, sample: Row, like: Row) -> tuple[Nothing, AirMotion]:
        """The motion of the air at this sample."""
        del n
        flown_rad = c.phase_rad * (sample - c.begins)
        within_rad = np.minimum(np.maximum(flown_rad, 0.0), _TURN)
        return x, still(like, **{self.component: c.half_m_s * (1.0 - cos(within_rad))})
