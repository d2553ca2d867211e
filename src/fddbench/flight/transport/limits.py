"""Where the aircraft can fly: buffet, thrust, V_MO and M_MO; what a manoeuvre needs more than its trim."""

import numpy as np

from fddbench.blocks.layout import Row
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.flight.atmosphere import GRAVITY_M_S2, density_kg_m3, dynamic_pressure_pa, mach
from fddbench.flight.transport.aerodynamics import lift_slope
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import thrust_n
from fddbench.units import RAD_PER_DEG

__all__ = ["buffet_lift", "buffet_load_factor", "highest_alpha_rad", "infeasible_reasons", "level_drag_n"]


def buffet_lift(aircraft: Aircraft, number: Row) -> Row:
    """Lift coefficient at which buffet begins, of a Mach number [-]."""
    axis = Grid(aircraft.limits.buffet_mach)
    return Lookup(aircraft.limits.buffet_c_l, axis)(axis.find(number))


def highest_alpha_rad(aircraft: Aircraft, number: Row) -> Row:
    """Incidence at which buffet begins [rad], ``alpha0 + C_L,buffet(M) / C_La(M)``."""
    slope = lift_slope(aircraft, number * number)
    return aircraft.lift.alpha_zero_deg * RAD_PER_DEG + buffet_lift(aircraft, number) / slope


def _lift(aircraft: Aircraft, mass_kg: Row, altitude_ft: Row, v_cas_kt: Row) -> Row:
    """Lift coefficient of level flight at 1 g [-]."""
    pressure = dynamic_pressure_pa(v_cas_kt, altitude_ft)
    return mass_kg * GRAVITY_M_S2 / (pressure * aircraft.geometry.wing_area_m2)


def buffet_load_factor(aircraft: Aircraft, mass_kg: Row, altitude_ft: Row, v_cas_kt: Row) -> Row:
    """Load factor at which buffet begins [g]."""
    number = mach(v_cas_kt, altitude_ft)
    return buffet_lift(aircraft, number) / _lift(aircraft, mass_kg, altitude_ft, v_cas_kt)


def level_drag_n(aircraft: Aircraft, mass_kg: Row, altitude_ft: Row, v_cas_kt: Row, load_factor_g: Row) -> Row:
    """Drag [N] at a load factor, all lift from the wing."""
    drag, lift = aircraft.drag, load_factor_g * _lift(aircraft, mass_kg, altitude_ft, v_cas_kt)
    rise = np.maximum(mach(v_cas_kt, altitude_ft) - drag.rise_mach + drag.rise_per_lift * (lift - drag.rise_lift), 0.0)
    c_d = drag.c_d_0 + drag.induced * lift * lift + drag.rise * rise * rise * rise
    return c_d * dynamic_pressure_pa(v_cas_kt, altitude_ft) * aircraft.geometry.wing_area_m2


def infeasible_reasons(
    aircraft: Aircraft, mass_kg: Row, altitude_ft: Row, v_cas_kt: Row, *, load_factor_g: Row, slower_kt: Row
) -> tuple[str, ...]:
    """Why each case cannot fly level, or not what its manoeuvre holds for long; the empty string where it can.

    Parameters
    ----------
    load_factor_g, slower_kt : rows
        Load factor that the manoeuvre holds, and by how much it flies slower than the trim.
    """
    limits, one = aircraft.limits, np.ones_like(mass_kg)
    tests = [
        ("above V_MO: {0:.0f} kt > {1:.0f} kt", v_cas_kt, limits.v_mo_kt * one),
        ("above M_MO: Mach {0:.3f} > {1:.2f}", mach(v_cas_kt, altitude_ft), limits.m_mo * one),
    ]
    for what, n, speed in (
        ("", one, v_cas_kt),
        (" at {n:.2f} g and {v:.0f} kt, which the manoeuvre holds", load_factor_g, v_cas_kt - slower_kt),
    ):
        number = mach(speed, altitude_ft)
        lift, buffet = n * _lift(aircraft, mass_kg, altitude_ft, speed), buffet_lift(aircraft, number)
        drag = level_drag_n(aircraft, mass_kg, altitude_ft, speed, n)
        most = thrust_n(aircraft, density_kg_m3(altitude_ft), number)
        words = [what.format(n=a, v=b) for a, b in zip(n.tolist(), speed.tolist(), strict=True)] if what else [""]
        tests += [
            ("buffet: lift coefficient {0:.2f} > {1:.2f}", lift, buffet, words),
            ("thrust: {0:.0f} kN needed, {1:.0f} kN available", drag / 1e3, most / 1e3, words),
        ]
    reasons = [""] * len(mass_kg)
    for text, value, limit, *more in reversed(tests):  # of several the first has the last word
        words = more[0] if more else [""]
        for i in np.flatnonzero(value > limit).tolist():
            reasons[i] = text.format(value[i], limit[i]) + words[i if len(words) > 1 else 0]
    return tuple(reasons)
