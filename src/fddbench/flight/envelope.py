"""Where a twin-jet of the benchmark's class can fly level: buffet, thrust, V_MO and M_MO.

All numbers are our choice from open literature for the class (S 361.6 m^2, two engines of 310 kN); the published aircraft
is not public. A user with better ones changes them here.
"""

import numpy as np

from fddbench.blocks.functions import interpolate
from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import GRAVITY_M_S2, density_kg_m3, dynamic_pressure_pa, mach

__all__ = ["infeasible_reasons", "level_flight_drag_n", "thrust_available_n"]

WING_AREA_M2 = 361.6
V_MO_KT, M_MO = 330.0, 0.86
_THRUST_SEA_LEVEL_N = 2.0 * 310e3
_BUFFET_MACH = (0.3, 0.5, 0.6, 0.7, 0.75, 0.8, 0.82, 0.84, 0.86)
_BUFFET_LIFT = (1.38, 1.20, 1.06, 0.94, 0.88, 0.78, 0.72, 0.64, 0.54)


def lift_coefficient(mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows) -> Rows:
    """Lift coefficient of level flight at 1 g [-]."""
    return mass_kg * GRAVITY_M_S2 / (dynamic_pressure_pa(v_cas_kt, altitude_ft) * WING_AREA_M2)


def level_flight_drag_n(mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows) -> Rows:
    """Drag in level flight [N], ``C_D = 0.0165 + 0.041 C_L^2 + 20 max(0, M - 0.785 + 0.10 (C_L - 0.45))^3``."""
    lift = lift_coefficient(mass_kg, altitude_ft, v_cas_kt)
    rise = np.maximum(mach(v_cas_kt, altitude_ft) - 0.785 + 0.10 * (lift - 0.45), 0.0)
    drag = 0.0165 + 0.041 * lift * lift + 20.0 * rise * rise * rise
    return drag * dynamic_pressure_pa(v_cas_kt, altitude_ft) * WING_AREA_M2


def thrust_available_n(altitude_ft: Rows, v_cas_kt: Rows) -> Rows:
    """Thrust of both engines [N], ``2 310 kN rho/rho0 (1 - 0.49 sqrt M)``."""
    share = density_kg_m3(altitude_ft) / 1.225
    return _THRUST_SEA_LEVEL_N * share * (1.0 - 0.49 * np.sqrt(mach(v_cas_kt, altitude_ft)))


def infeasible_reasons(mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows) -> tuple[str, ...]:
    """Why each case cannot fly level, or the empty string."""
    number = mach(v_cas_kt, altitude_ft)
    lift = lift_coefficient(mass_kg, altitude_ft, v_cas_kt)
    buffet = interpolate(number, column(_BUFFET_MACH), column(_BUFFET_LIFT))
    drag, thrust = level_flight_drag_n(mass_kg, altitude_ft, v_cas_kt), thrust_available_n(altitude_ft, v_cas_kt)
    tests = (
        (v_cas_kt > V_MO_KT, "above V_MO: {0:.0f} kt > {1:.0f} kt", v_cas_kt, np.full_like(v_cas_kt, V_MO_KT)),
        (number > M_MO, "above M_MO: Mach {0:.3f} > {1:.2f}", number, np.full_like(number, M_MO)),
        (lift > buffet, "buffet: lift coefficient {0:.2f} > {1:.2f}", lift, buffet),
        (drag > thrust, "thrust: {0:.0f} kN needed, {1:.0f} kN available", drag / 1e3, thrust / 1e3),
    )
    reasons = [""] * len(number)
    for broken, text, value, limit in reversed(tests):  # of several the first has the last word
        for i in np.flatnonzero(broken).tolist():
            reasons[i] = text.format(value[i], limit[i])
    return tuple(reasons)
