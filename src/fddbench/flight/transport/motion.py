"""What there is to see of an aircraft at an instant: angles, speeds, load factor, track."""

import numpy as np

from fddbench.blocks.functions import atan2, pow_
from fddbench.blocks.layout import Row, record
from fddbench.flight.atmosphere import GRAVITY_M_S2, KT_M_S
from fddbench.flight.transport.air import AirAround
from fddbench.flight.transport.equations import Forces, State, euler_rad, gravity, to_earth

__all__ = ["Motion", "calibrated_kt", "motion_of"]

_P0_PA, _SOUND0_M_S, _GAS_J_KG_K = 101325.0, float(np.sqrt(1.4 * 287.05287 * 288.15)), 287.05287


@record
class Motion:
    """True motion, (n_cases,) each: angles [rad], rates [rad/s], load factor down the body axis [g], speeds, position [m].

    `drag_n` is the force of the air against the airspeed, that of a sideslip in it;
    `v_cas_dot_kt_s` is the rate of the calibrated airspeed in air at rest; `pressure_pa` the dynamic pressure.
    """

    phi_rad: Row
    theta_rad: Row
    psi_rad: Row
    track_rad: Row
    alpha_rad: Row
    beta_rad: Row
    p_rad_s: Row
    q_rad_s: Row
    r_rad_s: Row
    n_z_g: Row
    v_tas_m_s: Row
    v_cas_kt: Row
    v_cas_dot_kt_s: Row
    mach: Row
    pressure_pa: Row
    density_kg_m3: Row
    altitude_m: Row
    climb_m_s: Row
    east_m: Row
    drag_n: Row


def calibrated_kt(mach: Row, pressure_pa: Row) -> Row:
    """Calibrated airspeed [kt] of a Mach number at a static pressure [Pa]; subsonic.

    >>> round(float(calibrated_kt(np.array(0.630574), np.array(46563.26))), 2)
    290.0
    """
    ratio = 1.0 + 0.2 * mach * mach
    impact_pa = pressure_pa * (ratio * ratio * ratio * np.sqrt(ratio) - 1.0)
    at_sea_level = pow_(impact_pa * (1.0 / _P0_PA) + 1.0, 2.0 / 7.0) - 1.0
    return (_SOUND0_M_S / KT_M_S) * np.sqrt(5.0 * at_sea_level)


def motion_of(x: State, air: AirAround, f: Forces, wind_north_m_s: Row, wind_east_m_s: Row, *, mass_kg: Row) -> Motion:
    """Motion of a state in the air around it, with the forces there; a steady wind is in the track only."""
    phi, theta, psi = euler_rad(x)
    density, temperature = air.at(x.altitude)
    north, east, down = to_earth(x)
    g_x, g_y, g_z = gravity(x)
    flow = f.flow
    speed = flow.mach * np.sqrt((1.4 * _GAS_J_KG_K) * temperature)
    # along the path through the air; wind is taken to be steady
    squared = x.u * x.u + x.v * x.v + x.w * x.w
    gained = (x.u * (f.x + g_x) + x.v * (f.y + g_y) + x.w * (f.z + g_z)) / squared
    v_cas_kt = calibrated_kt(flow.mach, density * (_GAS_J_KG_K * temperature))
    return Motion(
        phi_rad=phi,
        theta_rad=theta,
        psi_rad=psi,
        track_rad=atan2(east + wind_east_m_s, north + wind_north_m_s),
        alpha_rad=flow.alpha_rad,
        # arc sine to the fifth order: 1e-6 deg at 5 deg
        beta_rad=_small_asin(flow.sin_beta),
        p_rad_s=x.p,
        q_rad_s=x.q,
        r_rad_s=x.r,
        n_z_g=f.z * (-1.0 / GRAVITY_M_S2),
        v_tas_m_s=speed,
        v_cas_kt=v_cas_kt,
        v_cas_dot_kt_s=v_cas_kt * (gained - 0.5 * air.first * down),
        mach=flow.mach,
        pressure_pa=flow.pressure_pa,
        density_kg_m3=density,
        altitude_m=x.altitude,
        climb_m_s=-down,
        east_m=x.east,
        drag_n=mass_kg * _drag_m_s2(f),
    )


def _drag_m_s2(f: Forces) -> Row:
    """Force of the air against the airspeed over mass [m/s^2]."""
    flow = f.flow
    in_plane = (f.x - f.thrust) * flow.cos_alpha + f.z * flow.sin_alpha
    return -(np.sqrt(1.0 - flow.sin_beta * flow.sin_beta) * in_plane + f.y * flow.sin_beta)


def _small_asin(x: Row) -> Row:
    """Arc sine of a small number, to its fifth power: off by 2e-7 rad at 10 degrees."""
    z = x * x
    return x * (1.0 + z * (1.0 / 6.0 + z * (3.0 / 40.0)))
