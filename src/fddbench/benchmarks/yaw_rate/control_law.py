"""Lateral control law: bank-angle hold with integral action, yaw damping and turn coordination on the voted yaw rate.

A linear-quadratic regulator designed on the published model at the centre of its box, with fixed gains; `tests` repeat the
design and show that the loop with actuators is stable over the whole box. The published law is not public.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.units import RAD_PER_DEG

__all__ = ["AILERON_GAINS", "Q_DIAGONAL", "RUDDER_GAINS", "R_DIAGONAL", "LateralLaw", "LawState", "allocate"]

# Bryson's rule: tolerated phi 5 deg, V_y of 2 deg of sideslip at 199 m/s, p 20 deg/s, r 2 deg/s, integral 8 deg s;
# roll order 5 deg, rudder 2 deg
Q_DIAGONAL = (
    1 / (5 * RAD_PER_DEG) ** 2,
    1 / (199 * 2 * RAD_PER_DEG) ** 2,
    1 / (20 * RAD_PER_DEG) ** 2,
    1 / (2 * RAD_PER_DEG) ** 2,
    1 / (8 * RAD_PER_DEG) ** 2,
)
R_DIAGONAL = (1 / 5.0**2, 1 / 2.0**2)
# on phi [rad], V_y [m/s], p [rad/s], r [rad/s], integral of phi [rad s]; in deg of surface
AILERON_GAINS = (94.0916, -0.4733, 37.5182, 36.2070, 34.7496)
RUDDER_GAINS = (-10.2657, 0.1755, -1.1810, -74.1917, -3.4597)
_DAMPER_DEG = 5.0
"""Authority of the yaw damper: what the yaw rate alone may ask of the rudder [deg]."""
_SPOILER_FROM_DEG, _SPOILER_RATIO = 10.0, 1.0
"""Spoilers help, upward only, where the roll order exceeds this."""
_INTEGRAL_RAD_S = 0.35
"""Limit of the integral, so that a saturated surface does not wind it up [rad s]."""


@record
class LawState:
    """Integral of the bank-angle error [rad s]."""

    integral_rad_s: Row


class LateralLaw:
    """Surface orders from measured signals.

    Parameters
    ----------
    sample_s : float
        Sample time [s].
    """

    states = Layout(LawState(integral_rad_s=ROW))
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, sample_s: float) -> None:
        self.sample_s = sample_s

    def start(self, c: Nothing) -> LawState:
        """Nothing integrated."""
        del c
        return LawState(integral_rad_s=0.0)

    def step(
        self, x: LawState, c: Nothing, n: Nothing, measured: SimpleNamespace, bank_command_deg: Row
    ) -> tuple[LawState, Rows]:
        """State at the next sample, and orders to the 13 surfaces [deg], (13, n_cases)."""
        del c, n
        phi, p, r = (RAD_PER_DEG * each for each in (measured.phi_deg, measured.p_deg_s, measured.r_voted_deg_s))
        error = phi - RAD_PER_DEG * bank_command_deg
        # yaw rate of a coordinated turn at this bank angle
        r_error = r - GRAVITY_M_S2 / measured.v_tas_m_s * phi
        v_y = measured.v_tas_m_s * (RAD_PER_DEG * measured.beta_deg)
        a, b = AILERON_GAINS, RUDDER_GAINS
        roll = -(a[0] * error + a[1] * v_y + a[2] * p + a[3] * r_error + a[4] * x.integral_rad_s)
        damper = np.minimum(np.maximum(-b[3] * r_error, -_DAMPER_DEG), _DAMPER_DEG)
        rudder = damper - (b[0] * error + b[1] * v_y + b[2] * p + b[4] * x.integral_rad_s)
        moved = x.integral_rad_s + self.sample_s * error
        integral = np.minimum(np.maximum(moved, -_INTEGRAL_RAD_S), _INTEGRAL_RAD_S)
        return LawState(integral_rad_s=integral), allocate(rudder, roll)


def allocate(rudder_deg: Rows, roll_deg: Rows) -> Rows:
    """Orders to [rudder, 4 ailerons, 8 spoilers] [deg]; odd surfaces of a kind act against the even ones."""
    more = np.abs(roll_deg) - _SPOILER_FROM_DEG
    up = _SPOILER_RATIO * np.maximum(more, 0.0)
    left = np.where(roll_deg < 0.0, up, 0.0)
    right = np.where(roll_deg > 0.0, up, 0.0)
    ailerons = column((1.0, -1.0, 1.0, -1.0)) * roll_deg
    return np.concatenate([rudder_deg[np.newaxis], ailerons, np.stack([left, right] * 4)])
