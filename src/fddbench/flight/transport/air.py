"""The standard atmosphere around an altitude, to second order: cheap inside a step, where the altitude moves by metres."""

import numpy as np

from fddbench.blocks.layout import Row, record
from fddbench.flight.atmosphere import FT_M, GRAVITY_M_S2, density_kg_m3, temperature_k

__all__ = ["AirAround", "air_around"]

_GAS_J_KG_K, _LAPSE_K_M, _TROPOPAUSE_M = 287.05287, 0.0065, 11000.0
_POWER = GRAVITY_M_S2 / (_GAS_J_KG_K * _LAPSE_K_M) - 1.0


@record
class AirAround:
    """Air at an altitude, (n_cases,) each, and how it changes near it.

    ``rho = density (1 + first h + second h^2)`` and ``T = temperature + lapse h`` with h above `altitude_m`; what is left out
    of the density is below 2e-13 of it within a metre, 2e-10 within ten.
    """

    altitude_m: Row
    density_kg_m3: Row
    temperature_k: Row
    first: Row
    second: Row
    lapse_k_m: Row

    def at(self, altitude_m: Row) -> tuple[Row, Row]:
        """Density [kg/m^3] and temperature [K] near there."""
        h = altitude_m - self.altitude_m
        return self.density_kg_m3 * (1.0 + h * (self.first + h * self.second)), self.temperature_k + self.lapse_k_m * h


def air_around(altitude_m: Row) -> AirAround:
    """Air of the standard atmosphere around an altitude [m], (n_cases,)."""
    altitude_ft = altitude_m / FT_M
    temperature = temperature_k(altitude_ft)
    below = altitude_m < _TROPOPAUSE_M
    # ISO 2533: density goes with T^n below the tropopause, exponentially above
    x = _LAPSE_K_M / temperature
    y = GRAVITY_M_S2 / (_GAS_J_KG_K * temperature)
    return AirAround(
        altitude_m=altitude_m,
        density_kg_m3=density_kg_m3(altitude_ft),
        temperature_k=temperature,
        first=np.where(below, -_POWER * x, -y),
        second=np.where(below, (0.5 * _POWER * (_POWER - 1.0)) * x * x, 0.5 * y * y),
        lapse_k_m=np.where(below, -_LAPSE_K_M, 0.0),
    )
