"""Longitudinal law: a load factor from stick or holds, bounded by protections, followed by the elevator, trimmed out."""

from typing import NamedTuple

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.gains import Gains
from fddbench.benchmarks.yaw_rate.transport.profiles import Commands
from fddbench.benchmarks.yaw_rate.transport.protections import Bounds
from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.blocks.functions import cos, exp
from fddbench.blocks.layout import Row, record
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.aircraft import Actuation
from fddbench.units import RAD_PER_DEG

__all__ = ["LongitudinalState", "PitchOrders", "load_factor_asked", "longitudinal_law"]

_LAG_S, _RATE_G_S = 0.35, 1.5
_SURFACES_S = 0.25
"""About what delay and actuators add to the lag: the integral only answers for what is off beyond that."""
_COMPENSATED, _HELD_BANK = float(np.cos(np.deg2rad(33.0))), float(np.cos(np.deg2rad(50.0)))
_ALTITUDE_1_S, _CLIMB_M_S, _CLIMB_GAIN_1_S = 0.12, 8.0, 0.45
_PITCH_GAIN_1_S, _PITCH_G = 0.8, 0.5
"""A pitch angle is held with what a pilot would pull or push for it."""
_TRIM_1_S = 0.1


@record
class LongitudinalState:
    """Load factor within its rate, behind its lag, as surfaces follow it [g], integral of the rest [g s]; stabiliser [deg]."""

    limited_g: Row
    followed_g: Row
    expected_g: Row
    integral_g_s: Row
    stabiliser_deg: Row


class PitchOrders(NamedTuple):
    """Elevator and stabiliser order [deg]."""

    elevator_deg: Row
    stabiliser_deg: Row


def load_factor_asked(s: Sensed, asked: Commands, stick_g: Row, trim_theta_rad: Row, altitude_m: Row) -> Row:
    """Load factor [g] that holds the altitude or the pitch angle, or is asked for by the stick; turns are compensated."""
    cos_theta, cos_phi = cos(s.theta_rad), cos(s.phi_rad)
    level = cos_theta / np.maximum(cos_phi, _COMPENSATED)
    climb = np.minimum(np.maximum(_ALTITUDE_1_S * (altitude_m - s.altitude_m), -_CLIMB_M_S), _CLIMB_M_S)
    by_altitude = cos_theta / np.maximum(cos_phi, _HELD_BANK) + (_CLIMB_GAIN_1_S / GRAVITY_M_S2) * (climb - s.climb_m_s)
    pitch = trim_theta_rad + RAD_PER_DEG * asked.theta - s.theta_rad
    pull = (_PITCH_GAIN_1_S / GRAVITY_M_S2) * s.v_tas_m_s * pitch
    by_pitch = level + np.minimum(np.maximum(pull, -_PITCH_G), _PITCH_G)
    by_hand = np.where(asked.theta_held > 0.5, by_pitch, level + stick_g)
    return np.where(asked.altitude_held > 0.5, by_altitude, by_hand)


def longitudinal_law(
    x: LongitudinalState, s: Sensed, asked_g: Row, bounds: Bounds, k: Gains, travel: Actuation, T: float
) -> tuple[LongitudinalState, PitchOrders]:
    """State at the next sample, and the orders at this one."""
    allowed = np.minimum(np.maximum(asked_g, bounds.least_g), bounds.most_g)
    error = s.n_z_g - x.followed_g
    level = cos(s.theta_rad) * cos(s.phi_rad)
    q_c = (GRAVITY_M_S2 * (x.followed_g - level)) / s.v_tas_m_s
    order = k.elevator_n * error + k.elevator_q * (s.q_rad_s - q_c) + k.elevator_integral * x.integral_g_s
    low, high = travel.elevator.low_deg, travel.elevator.high_deg
    elevator = np.minimum(np.maximum(order, low), high)
    # what is at its stop integrates no further
    off = s.n_z_g - x.expected_g
    stuck = ((order > high) & (off > 0.0)) | ((order < low) & (off < 0.0))
    share, later = (float(1.0 - exp(np.array(-T / lag))) for lag in (_LAG_S, _SURFACES_S))
    most = _RATE_G_S * T
    rate, stabiliser = travel.stabiliser.rate_deg_s * T, travel.stabiliser
    moved = x.stabiliser_deg + np.minimum(np.maximum((_TRIM_1_S * T) * elevator, -rate), rate)
    after = LongitudinalState(
        limited_g=x.limited_g + np.minimum(np.maximum(allowed - x.limited_g, -most), most),
        followed_g=x.followed_g + share * (x.limited_g - x.followed_g),
        expected_g=x.expected_g + later * (x.followed_g - x.expected_g),
        integral_g_s=x.integral_g_s + np.where(stuck, 0.0, T * off),
        stabiliser_deg=np.minimum(np.maximum(moved, stabiliser.low_deg), stabiliser.high_deg),
    )
    return after, PitchOrders(elevator_deg=elevator, stabiliser_deg=x.stabiliser_deg)
