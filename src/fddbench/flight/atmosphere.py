"""International Standard Atmosphere, and calibrated airspeed to Mach number and true airspeed.

Reference: ISO 2533:1975; the calibrated airspeed is the one of an instrument calibrated with the isentropic pitot formula
at sea level.
"""

import numpy as np

from fddbench.blocks.functions import exp, pow_
from fddbench.blocks.layout import Rows

__all__ = [
    "FT_M", "GRAVITY_M_S2", "KT_M_S", "density_kg_m3", "dynamic_pressure_pa", "mach", "pressure_pa", "sound_speed_m_s",
    "temperature_k", "true_airspeed_m_s",
]  # fmt: skip

FT_M = 0.3048
KT_M_S = 1852.0 / 3600.0
GRAVITY_M_S2 = 9.80665
_T0_K, _P0_PA, _LAPSE_K_M, _TROPOPAUSE_M, _GAS_J_KG_K, _GAMMA = 288.15, 101325.0, 0.0065, 11000.0, 287.05287, 1.4
_EXPONENT = GRAVITY_M_S2 / (_GAS_J_KG_K * _LAPSE_K_M)
_SOUND0_M_S = float(np.sqrt(_GAMMA * _GAS_J_KG_K * _T0_K))


def temperature_k(altitude_ft: Rows) -> Rows:
    """Static temperature [K] at a pressure altitude [ft] below 65,600 ft.

    >>> round(float(temperature_k(np.array(36089.24))), 3)
    216.65
    """
    return _T0_K - _LAPSE_K_M * np.minimum(altitude_ft * FT_M, _TROPOPAUSE_M)


def pressure_pa(altitude_ft: Rows) -> Rows:
    """Static pressure [Pa] at a pressure altitude [ft] below 65,600 ft.

    >>> round(float(pressure_pa(np.array(20000.0))))
    46563
    """
    height_m = altitude_ft * FT_M
    troposphere = _P0_PA * pow_(temperature_k(altitude_ft) / _T0_K, _EXPONENT)
    above_m = np.maximum(height_m - _TROPOPAUSE_M, 0.0)
    return troposphere * exp(-GRAVITY_M_S2 / (_GAS_J_KG_K * (_T0_K - _LAPSE_K_M * _TROPOPAUSE_M)) * above_m)


def density_kg_m3(altitude_ft: Rows) -> Rows:
    """Air density [kg/m^3] at a pressure altitude [ft].

    >>> round(float(density_kg_m3(np.array(20000.0))), 4)
    0.6527
    """
    return pressure_pa(altitude_ft) / (_GAS_J_KG_K * temperature_k(altitude_ft))


def sound_speed_m_s(altitude_ft: Rows) -> Rows:
    """Speed of sound [m/s] at a pressure altitude [ft]."""
    return np.sqrt(_GAMMA * _GAS_J_KG_K * temperature_k(altitude_ft))


def mach(v_cas_kt: Rows, altitude_ft: Rows) -> Rows:
    """Mach number [-] of a calibrated airspeed [kt] at a pressure altitude [ft]; subsonic.

    >>> round(float(mach(np.array(290.0), np.array(20000.0))), 4)
    0.6306
    """
    ratio = v_cas_kt * KT_M_S / _SOUND0_M_S
    impact_pa = _P0_PA * (pow_(1.0 + 0.2 * ratio * ratio, 3.5) - 1.0)
    return np.sqrt(5.0 * (pow_(impact_pa / pressure_pa(altitude_ft) + 1.0, 2.0 / 7.0) - 1.0))


def true_airspeed_m_s(v_cas_kt: Rows, altitude_ft: Rows) -> Rows:
    """True airspeed [m/s] of a calibrated airspeed [kt] at a pressure altitude [ft].

    >>> round(float(true_airspeed_m_s(np.array(290.0), np.array(20000.0))), 2)
    199.28
    """
    return mach(v_cas_kt, altitude_ft) * sound_speed_m_s(altitude_ft)


def dynamic_pressure_pa(v_cas_kt: Rows, altitude_ft: Rows) -> Rows:
    """Dynamic pressure [Pa], ``gamma/2 p M^2``."""
    number = mach(v_cas_kt, altitude_ft)
    return 0.5 * _GAMMA * pressure_pa(altitude_ft) * number * number
