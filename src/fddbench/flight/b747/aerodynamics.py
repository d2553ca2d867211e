"""Coefficients of the compact model, and the air they are made in.

The forms are ours (see ``data/b747.yaml``): basic lift of angle of attack and Mach number, a cubic basic moment, elevator
effectiveness of Mach number and dynamic pressure, parabolic drag with a wave part.
"""

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, record
from fddbench.flight.atmosphere import FT_M, density_kg_m3, sound_speed_m_s
from fddbench.flight.b747.airframe import DATA
from fddbench.units import DEG_PER_RAD

__all__ = ["AIR", "Air", "Coefficients", "air", "coefficients", "drag_coefficient", "scheduled_lift"]

_EARTH_M = 6356766.0  # ISO 2533: radius that turns geometric into geopotential altitude
_LIFT, _MOMENT, _ELEVATOR, _DRAG = (DATA[name] for name in ("lift", "moment", "elevator", "drag"))


@record
class Air:
    """Density [kg/m^3] and speed of sound [m/s]."""

    density_kg_m3: Row
    sound_m_s: Row


AIR = Layout(Air(density_kg_m3=ROW, sound_m_s=ROW))
"""A row each."""


@record
class Coefficients:
    """Dynamic pressure [Pa], Mach number, and coefficients [-]; those of the elevator per degree."""

    q_pa: Row
    mach: Row
    basic_lift: Row
    elevator_lift: Row
    basic_moment: Row
    elevator_moment: Row


def air(altitude_m: Row) -> Air:
    """Standard air at a geometric altitude [m], (n_cases,).

    >>> found = air(np.array([9000.0]))
    >>> round(float(found.density_kg_m3[0]), 4), round(float(found.sound_m_s[0]), 2)
    (0.4671, 303.85)
    """
    pressure_altitude_ft = altitude_m * _EARTH_M / (_EARTH_M + altitude_m) / FT_M
    return Air(density_kg_m3=density_kg_m3(pressure_altitude_ft), sound_m_s=sound_speed_m_s(pressure_altitude_ft))


def coefficients(alpha_rad: Row, v_tas_m_s: Row, around: Air) -> Coefficients:
    """Coefficients at an angle of attack [rad] and an airspeed [m/s], (n_cases,) each."""
    mach = v_tas_m_s / around.sound_m_s
    q_pa = 0.5 * around.density_kg_m3 * v_tas_m_s * v_tas_m_s
    wing_deg = DEG_PER_RAD * alpha_rad + _LIFT["wing_incidence_deg"]
    share, reference = _LIFT["compressibility"]
    compressibility = np.sqrt((1.0 - share * reference * reference) / (1.0 - share * mach * mach))
    cube = wing_deg * wing_deg * wing_deg
    c0, c1, c2, c3 = _MOMENT["basic"]
    return Coefficients(
        q_pa=q_pa,
        mach=mach,
        basic_lift=_LIFT["constant"]
        + _LIFT["per_mach"] * (mach - _LIFT["mach_reference"])
        + _LIFT["per_deg"] * compressibility * wing_deg
        + _LIFT["per_deg3"] * cube,
        elevator_lift=_elevator("lift", mach, q_pa),
        basic_moment=c0 + c1 * wing_deg + c2 * wing_deg * wing_deg + c3 * cube,
        elevator_moment=_elevator("moment", mach, q_pa),
    )


def _elevator(name: str, mach: Row, q_pa: Row) -> Row:
    """Effectiveness of the elevator [1/deg]."""
    Q = 1e-4 * q_pa
    a, b, c, d, e = _ELEVATOR[name]
    k0, k1 = _ELEVATOR[f"{name}_factor"]
    return (a + b * mach + c * mach * mach + d * Q + e * Q * mach) * (k0 + k1 * Q)


def drag_coefficient(lift: Row, mach: Row) -> Row:
    """C_D [-] of a lift coefficient and a Mach number, (n_cases,)."""
    over = np.maximum(mach - _DRAG["wave_mach"], 0.0)
    return _DRAG["parasite"] + _DRAG["induced"] * lift * lift + _DRAG["wave"] * over * over * over


def scheduled_lift(basic_lift: Row) -> Row:
    """C_L* [-] of the scheduling parameter of drag: the basic lift, within the limits that Table B1 shows."""
    low, high = _DRAG["lift_limits"]
    return np.minimum(np.maximum(basic_lift, low), high)
