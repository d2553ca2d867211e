"""Bounds of the load factor that protect the flight: incidence, pitch angle, speed, and the load factor itself."""

from typing import NamedTuple

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.blocks.functions import cos
from fddbench.blocks.layout import Row
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.aerodynamics import lift_slope
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.limits import highest_alpha_rad
from fddbench.units import RAD_PER_DEG

__all__ = ["Bounds", "bounds", "protected_alpha_rad"]

_MOST_G, _LEAST_G = 2.5, 0.0
_UP, _UP_SLOW, _DOWN = (RAD_PER_DEG * each for each in (30.0, 25.0, -15.0))
_SLOW_KT, _NOT_SLOW_KT = 200.0, 220.0
_ABOVE_TRIM = RAD_PER_DEG * 1.0
_SHARE = 0.85
"""Where the incidence is protected, as a share of the way from zero lift to buffet."""
_ALPHA_GAIN, _LEAD_S, _PITCH_GAIN = 0.5, 1.0, 0.8
"""Gain 1 and a lead of 0.5 s hold the incidence too, but let the elevator work by up to 6 deg at the slowest points."""
_SPEED_MARGIN_KT, _MACH_MARGIN, _SPEED_LEAD_S, _SPEED_GAIN_G_KT = 6.0, 0.01, 6.0, 0.05


class Bounds(NamedTuple):
    """Load factor that is allowed [g], and whether the airspeed asks for idle; what it comes from.

    That is the highest incidence and pitch angle [rad] and airspeed [kt].
    """

    least_g: Row
    most_g: Row
    too_fast: Row
    alpha_rad: Row
    theta_rad: Row
    v_cas_kt: Row


def protected_alpha_rad(aircraft: Aircraft, mach: Row, trim_alpha_rad: Row) -> tuple[Row, Row]:
    """Incidences [rad] that a free stick, and one at its stop, are kept below."""
    zero = aircraft.lift.alpha_zero_deg * RAD_PER_DEG
    most = highest_alpha_rad(aircraft, mach)
    free = np.maximum(zero + _SHARE * (most - zero), trim_alpha_rad + _ABOVE_TRIM)
    return free, np.maximum(most, free)


def bounds(aircraft: Aircraft, s: Sensed, stick_g: Row, trim_alpha_rad: Row) -> Bounds:
    """Bounds of a sample; the upper ones win."""
    free, stop = protected_alpha_rad(aircraft, s.mach, trim_alpha_rad)
    pulled = np.minimum(np.maximum(stick_g, 0.0), 1.0)
    highest = free + pulled * (stop - free)
    area = aircraft.geometry.wing_area_m2
    per_rad = s.pressure_pa * (area / GRAVITY_M_S2) * lift_slope(aircraft, s.mach * s.mach) / s.mass_kg
    cos_theta = cos(s.theta_rad)
    alpha_dot = s.q_rad_s - (GRAVITY_M_S2 * (s.n_z_g - cos_theta * cos(s.phi_rad))) / s.v_tas_m_s
    by_alpha = s.n_z_g + (_ALPHA_GAIN * per_rad) * (highest - s.alpha_rad - _LEAD_S * alpha_dot)
    per_pitch = (_PITCH_GAIN / GRAVITY_M_S2) * s.v_tas_m_s
    fast = np.minimum(np.maximum((s.v_cas_kt - _SLOW_KT) * (1.0 / (_NOT_SLOW_KT - _SLOW_KT)), 0.0), 1.0)
    up = _UP_SLOW + fast * (_UP - _UP_SLOW)
    by_pitch = cos_theta + per_pitch * (up - s.theta_rad)
    by_dive = cos_theta + per_pitch * (_DOWN - s.theta_rad)
    limits = aircraft.limits
    at_mach = s.v_cas_kt * ((limits.m_mo + _MACH_MARGIN) / s.mach)
    fastest = np.minimum(limits.v_mo_kt + _SPEED_MARGIN_KT, at_mach)
    beyond = s.v_cas_kt + _SPEED_LEAD_S * s.v_cas_dot_kt_s - fastest
    by_speed = cos_theta + _SPEED_GAIN_G_KT * beyond
    return Bounds(
        least_g=np.maximum(np.maximum(by_dive, by_speed), _LEAST_G),
        most_g=np.minimum(np.minimum(by_alpha, by_pitch), _MOST_G),
        too_fast=beyond > 0.0,
        alpha_rad=highest,
        theta_rad=up,
        v_cas_kt=fastest,
    )
