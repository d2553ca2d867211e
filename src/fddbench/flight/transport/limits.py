"""Incidence and load factor at which buffet begins."""

from fddbench.blocks.layout import Row
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.flight.transport.aerodynamics import lift_slope
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.units import RAD_PER_DEG

__all__ = ["highest_alpha_rad"]


def highest_alpha_rad(aircraft: Aircraft, mach: Row) -> Row:
    """Incidence at which buffet begins [rad], ``alpha0 + C_L,buffet(M) / C_La(M)``."""
    axis = Grid(aircraft.limits.buffet_mach)
    lift = Lookup(aircraft.limits.buffet_c_l, axis)(axis.find(mach))
    return aircraft.lift.alpha_zero_deg * RAD_PER_DEG + lift / lift_slope(aircraft, mach * mach)
