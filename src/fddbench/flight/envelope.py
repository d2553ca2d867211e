"""Where a twin-jet of the benchmark's class can fly level: buffet, thrust, V_MO and M_MO.

One set of limits for every plant of the class: those of an aircraft's file, by default the shipped one, whose numbers are our
choice from open literature; the published aircraft is not public. A user with better ones copies the file. With two engines of
330 kN the flight of the paper's own figures (185 t, 37,000 ft, 267 kt) has 104 kN for the 102 kN that it needs; with 310 kN it
would not fly.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from fddbench.blocks.functions import interpolate
from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import GRAVITY_M_S2, density_kg_m3, dynamic_pressure_pa, mach
from fddbench.flight.transport.shipped import shipped_numbers

if TYPE_CHECKING:
    from fddbench.flight.transport.aircraft import Aircraft

__all__ = ["buffet_lift", "drag_n", "infeasible_reasons", "lift_coefficient", "thrust_available_n"]

_SEA_LEVEL_KG_M3 = 1.225


def lift_coefficient(
    mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows, *, load_factor: Rows = 1.0, aircraft: "Aircraft | None" = None
) -> Rows:
    """Lift coefficient that carries the load factor [-]."""
    area_m2 = (aircraft or shipped_numbers()).geometry.wing_area_m2
    return load_factor * mass_kg * GRAVITY_M_S2 / (dynamic_pressure_pa(v_cas_kt, altitude_ft) * area_m2)


def buffet_lift(number: Rows, aircraft: "Aircraft | None" = None) -> Rows:
    """Lift coefficient at which the buffet begins at a Mach number [-], (n_cases,)."""
    limits = (aircraft or shipped_numbers()).limits
    return interpolate(number, column(limits.buffet_mach), column(limits.buffet_c_l))


def drag_n(
    mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows, *, load_factor: Rows = 1.0, aircraft: "Aircraft | None" = None
) -> Rows:
    """Drag at a steady load factor [N], ``C_D = C_D0 + k C_L^2 + rise max(0, M - M_d + s (C_L - C_Ld))^3``."""
    aircraft = aircraft or shipped_numbers()
    polar = aircraft.drag
    lift = lift_coefficient(mass_kg, altitude_ft, v_cas_kt, load_factor=load_factor, aircraft=aircraft)
    past = mach(v_cas_kt, altitude_ft) - polar.rise_mach + polar.rise_per_lift * (lift - polar.rise_lift)
    rise = np.maximum(past, 0.0)
    drag = polar.c_d_0 + polar.induced * lift * lift + polar.rise * rise * rise * rise
    return drag * dynamic_pressure_pa(v_cas_kt, altitude_ft) * aircraft.geometry.wing_area_m2


def thrust_available_n(altitude_ft: Rows, v_cas_kt: Rows, aircraft: "Aircraft | None" = None) -> Rows:
    """Thrust of both engines [N], ``F_0 rho/rho0 (1 - c sqrt M)``."""
    engines = (aircraft or shipped_numbers()).thrust
    share = density_kg_m3(altitude_ft) / _SEA_LEVEL_KG_M3
    return engines.sea_level_n * share * (1.0 - engines.per_root_mach * np.sqrt(mach(v_cas_kt, altitude_ft)))


def infeasible_reasons(
    mass_kg: Rows, altitude_ft: Rows, v_cas_kt: Rows, *, load_factor: Rows = 1.0, aircraft: "Aircraft | None" = None
) -> tuple[str, ...]:
    """Why each case cannot fly steadily, or the empty string.

    Parameters
    ----------
    mass_kg, altitude_ft, v_cas_kt : (n_cases,) rows
        Where it shall fly; of a manoeuvre also its slowest or fastest steady speed.
    load_factor : (n_cases,) row or float
        Steady load factor of a manoeuvre [-]; 1 in level flight.
    aircraft : Aircraft, optional
        Whose limits; those of the shipped one.
    """
    aircraft = aircraft or shipped_numbers()
    more: dict[str, Any] = {"load_factor": load_factor, "aircraft": aircraft}
    factor = np.broadcast_to(load_factor, np.shape(v_cas_kt))
    number, limits = mach(v_cas_kt, altitude_ft), aircraft.limits
    lift, buffet = lift_coefficient(mass_kg, altitude_ft, v_cas_kt, **more), buffet_lift(number, aircraft)
    drag = drag_n(mass_kg, altitude_ft, v_cas_kt, **more)
    thrust = thrust_available_n(altitude_ft, v_cas_kt, aircraft)
    v_mo_kt, m_mo = np.full_like(v_cas_kt, limits.v_mo_kt), np.full_like(number, limits.m_mo)
    tests = (
        (v_cas_kt > v_mo_kt, "above V_MO: {0:.0f} kt > {1:.0f} kt", v_cas_kt, v_mo_kt),
        (number > m_mo, "above M_MO: Mach {0:.3f} > {1:.2f}", number, m_mo),
        (lift > buffet, "buffet: lift coefficient {0:.2f} > {1:.2f}{2}", lift, buffet),
        (drag > thrust, "thrust: {0:.0f} kN needed, {1:.0f} kN available{2}", drag / 1e3, thrust / 1e3),
    )
    reasons = [""] * len(number)
    for broken, text, value, limit in reversed(tests):  # of several the first has the last word
        for i in np.flatnonzero(broken).tolist():
            at = "" if factor[i] == 1.0 else f" at load factor {factor[i]:.2f}"
            reasons[i] = text.format(value[i], limit[i], at)
    return tuple(reasons)
