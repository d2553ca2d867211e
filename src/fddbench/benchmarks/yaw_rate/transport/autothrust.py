"""Autothrust: the airspeed of the trim, or another one, is held by the engines."""

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.profiles import Commands
from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.blocks.layout import Row
from fddbench.flight.atmosphere import KT_M_S
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import thrust_n

__all__ = ["autothrust"]

_GAIN_1_S, _INTEGRAL_1_S2 = 0.15, 0.012


def autothrust(
    aircraft: Aircraft,
    integral_m: Row,
    s: Sensed,
    asked: Commands,
    v_cas_kt: Row,
    rate_kt_s: Row,
    trim_ratio: Row,
    too_fast: Row,
    T: float,
) -> tuple[Row, Row]:
    """Integral of the speed error [m] at the next sample, and the share of the thrust ordered at this one [-]."""
    idle = aircraft.thrust.idle_ratio
    error = KT_M_S * (v_cas_kt - s.v_cas_kt)
    per_m_s2 = s.mass_kg / thrust_n(aircraft, s.density_kg_m3, s.mach)
    gain = rate_kt_s * (s.v_tas_m_s / s.v_cas_kt) + _GAIN_1_S * error + _INTEGRAL_1_S2 * integral_m
    order = trim_ratio + per_m_s2 * gain
    fixed = np.where(asked.thrust > 0.5, 1.0, np.where((asked.thrust < -0.5) | too_fast, idle, trim_ratio))
    held = asked.autothrust > 0.5
    stuck = ((order > 1.0) & (error > 0.0)) | ((order < idle) & (error < 0.0))
    after = integral_m + np.where(stuck | ~held, 0.0, T * error)
    within = np.minimum(np.maximum(order, idle), 1.0)
    return after, np.where(held, within, fixed)
