"""Lateral law: the stick is a roll rate, bank is held, sideslip follows the pedals, yaw is damped, turns are coordinated."""

from typing import NamedTuple

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.gains import Gains
from fddbench.benchmarks.yaw_rate.transport.profiles import Commands
from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.blocks.functions import cos, exp, sin
from fddbench.blocks.layout import Row, record
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.units import DEG_PER_RAD, RAD_PER_DEG

__all__ = ["LateralOrders", "LateralState", "balance", "lateral_law"]

_LAG_S, _SURFACES_S = 0.35, 0.25
"""Of the order, and about what delay and actuators add: the integral only answers for what is off beyond that."""
_MOST_BANK, _FREE_BANK, _BACK_RATE = (RAD_PER_DEG * each for each in (67.0, 33.0, 8.0))
_TRACK_BANK, _TRACK_RATE, _TRACK_GAIN_S = RAD_PER_DEG * 15.0, RAD_PER_DEG * 4.0, 0.12
_DAMPER_DEG = 5.0
"""Authority of the yaw damper: what the yaw rate alone may ask of the rudder [deg]."""
_INTEGRAL_RAD_S = 0.35


@record
class LateralState:
    """Bank angle asked for, behind its lag, as surfaces can follow it [rad]; integral of what is left [rad s]."""

    asked_rad: Row
    followed_rad: Row
    expected_rad: Row
    integral_rad_s: Row


class LateralOrders(NamedTuple):
    """Roll and rudder order [deg], and the bank angle asked for [rad]."""

    roll_deg: Row
    rudder_deg: Row
    bank_rad: Row


class Balance(NamedTuple):
    """Orders that hold a steady flight at the reference.

    Roll and rudder for a sideslip [deg/deg], and rudder for the yaw rate of a turn over the true airspeed [deg m].
    """

    roll_of_sideslip: float
    rudder_of_sideslip: float
    rudder_of_turn: float


def balance(aircraft: Aircraft) -> Balance:
    """Orders that balance both moments of a sideslip, and the yaw damping of a turn."""
    d, s = aircraft.lateral, aircraft.surfaces
    roll_l, roll_n = 2.0 * (s.aileron_1.c_l + s.aileron_3.c_l), 2.0 * (s.aileron_1.c_n + s.aileron_3.c_n)
    whole = roll_l * s.rudder.c_n - roll_n * s.rudder.c_l
    roll = -(d.c_l_beta.value * s.rudder.c_n - d.c_n_beta.value * s.rudder.c_l) / whole
    rudder = -(roll_l * d.c_n_beta.value - roll_n * d.c_l_beta.value) / whole
    turn = -d.c_n_r.value / s.rudder.c_n * 0.5 * aircraft.geometry.span_m * DEG_PER_RAD
    return Balance(roll, rudder, turn)


def _limited(x: Row, most: Row | float) -> Row:
    return np.minimum(np.maximum(x, -most), most)


def _bank_rate(x: LateralState, s: Sensed, asked: Commands) -> Row:
    """Rate of the bank angle asked for [rad/s]: by the stick, or to hold the track; above 33 deg a free stick comes back."""
    stick = RAD_PER_DEG * asked.roll_stick
    over = np.abs(x.asked_rad) - _FREE_BANK
    back = np.minimum(np.maximum(2.0 * over, 0.0), _BACK_RATE)
    free = np.where(x.asked_rad > 0.0, -back, back)
    by_hand = np.where(np.abs(stick) > 0.01, stick, free)
    wanted = (_TRACK_GAIN_S / GRAVITY_M_S2) * s.v_tas_m_s * (RAD_PER_DEG * asked.track - s.track_rad)
    held = _limited(2.0 * (_limited(wanted, _TRACK_BANK) - x.asked_rad), _TRACK_RATE)
    return np.where(asked.track_held > 0.5, held, by_hand)


def lateral_law(
    x: LateralState, s: Sensed, asked: Commands, pedals_deg: Row, k: Gains, steady: Balance, T: float
) -> tuple[LateralState, LateralOrders]:
    """State at the next sample, and the orders at this one; `pedals_deg` is the sideslip within the travel of the rudder."""
    beta_c = RAD_PER_DEG * pedals_deg
    rate = _bank_rate(x, s, asked)
    p_c = (1.0 / _LAG_S) * (x.asked_rad - x.followed_rad)
    error = s.phi_rad - x.followed_rad
    # of a coordinated turn, and of a roll about the velocity
    turn = (GRAVITY_M_S2 * (cos(s.theta_rad) * sin(s.phi_rad))) / s.v_tas_m_s
    r_c = turn + s.p_rad_s * s.alpha_rad
    beta, p, r = s.beta_rad - beta_c, s.p_rad_s - p_c, s.r_rad_s - r_c
    roll = k.roll_phi * error + k.roll_beta * beta + k.roll_p * p + k.roll_r * r + k.roll_integral * x.integral_rad_s
    damper = _limited(k.rudder_r * r, _DAMPER_DEG)
    rudder = (
        k.rudder_phi * error + k.rudder_beta * beta + k.rudder_p * p + damper + k.rudder_integral * x.integral_rad_s
    )
    share, later = (float(1.0 - exp(np.array(-T / lag))) for lag in (_LAG_S, _SURFACES_S))
    off = s.phi_rad - x.expected_rad
    after = LateralState(
        asked_rad=_limited(x.asked_rad + T * rate, _MOST_BANK),
        followed_rad=x.followed_rad + share * (x.asked_rad - x.followed_rad),
        expected_rad=x.expected_rad + later * (x.followed_rad - x.expected_rad),
        integral_rad_s=_limited(x.integral_rad_s + T * off, _INTEGRAL_RAD_S),
    )
    steadily = steady.rudder_of_sideslip * pedals_deg + steady.rudder_of_turn * turn / s.v_tas_m_s
    orders = LateralOrders(
        roll_deg=steady.roll_of_sideslip * pedals_deg + asked.roll_trim - roll,
        rudder_deg=steadily + asked.rudder_trim - rudder,
        bank_rad=x.asked_rad,
    )
    return after, orders
