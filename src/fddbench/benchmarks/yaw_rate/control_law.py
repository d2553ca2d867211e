"""Lateral control law: bank-angle hold with integral action, yaw damping and turn coordination on the voted yaw rate.

A linear-quadratic regulator designed on the published model at the centre of its box, with fixed gains; `tests` repeat the
design and show that the loop with actuators is stable over the whole box. The published law is not public.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import GRAVITY_M_S2

__all__ = ["AILERON_GAINS", "Q_DIAGONAL", "RUDDER_GAINS", "R_DIAGONAL", "LateralLaw"]

_DEG = float(np.deg2rad(1.0))
# Bryson's rule: tolerated phi 5 deg, V_y of 2 deg of sideslip at 199 m/s, p 20 deg/s, r 2 deg/s, integral 8 deg s;
# roll order 5 deg, rudder 2 deg
Q_DIAGONAL = (
    1 / (5 * _DEG) ** 2,
    1 / (199 * 2 * _DEG) ** 2,
    1 / (20 * _DEG) ** 2,
    1 / (2 * _DEG) ** 2,
    1 / (8 * _DEG) ** 2,
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


@dataclass(frozen=True, kw_only=True)
class LateralLaw:
    """Surface orders from measured signals.

    Attributes
    ----------
    sample_s : float
        Sample time [s].
    """

    sample_s: float

    def step(self, integral_rad_s: Rows, measured: SimpleNamespace, bank_command_deg: Rows) -> tuple[Rows, Rows]:
        """Integral at the next sample, (n_cases,), and orders to the 13 surfaces [deg], (13, n_cases)."""
        phi, p, r = _DEG * measured.phi_deg, _DEG * measured.p_deg_s, _DEG * measured.r_voted_deg_s
        error = phi - _DEG * bank_command_deg
        # yaw rate of a coordinated turn at this bank angle
        r_error = r - GRAVITY_M_S2 / measured.v_tas_m_s * phi
        v_y = measured.v_tas_m_s * (_DEG * measured.beta_deg)
        a, b = AILERON_GAINS, RUDDER_GAINS
        roll = -(a[0] * error + a[1] * v_y + a[2] * p + a[3] * r_error + a[4] * integral_rad_s)
        damper = np.minimum(np.maximum(-b[3] * r_error, -_DAMPER_DEG), _DAMPER_DEG)
        rudder = damper - (b[0] * error + b[1] * v_y + b[2] * p + b[4] * integral_rad_s)
        integral = np.minimum(np.maximum(integral_rad_s + self.sample_s * error, -_INTEGRAL_RAD_S), _INTEGRAL_RAD_S)
        return integral, _allocate(rudder, roll)


def _allocate(rudder_deg: Rows, roll_deg: Rows) -> Rows:
    """Orders to [rudder, 4 ailerons, 8 spoilers] [deg]; odd surfaces of a kind act against the even ones."""
    more = np.abs(roll_deg) - _SPOILER_FROM_DEG
    up = _SPOILER_RATIO * np.maximum(more, 0.0)
    left = np.where(roll_deg < 0.0, up, 0.0)
    right = np.where(roll_deg > 0.0, up, 0.0)
    ailerons = column((1.0, -1.0, 1.0, -1.0)) * roll_deg
    return np.concatenate([rudder_deg[np.newaxis], ailerons, np.stack([left, right] * 4)])
