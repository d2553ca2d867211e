"""The nine scheduling parameters, from what an aircraft measures, and their box."""

from typing import Any

import numpy as np

from fddbench.blocks.layout import Row, Rows
from fddbench.flight.b747.aerodynamics import Air, air, coefficients, drag_coefficient, scheduled_lift
from fddbench.flight.b747.airframe import DATA

__all__ = ["BOX", "PARAMETERS", "parameters"]

_RANGES: dict[str, Any] = DATA["scheduling"]

PARAMETERS: tuple[str, ...] = tuple(_RANGES)
"""Names of rho_1 ... rho_9 with their units; those of the elevator are per degree."""

BOX = np.array(list(_RANGES.values()))
"""Table B1: smallest and largest values, (9, 2)."""


def parameters(alpha_rad: Row, v_tas_m_s: Row, altitude_m: Row, gamma_rad: Row, *, around: Air | None = None) -> Rows:
    """Parameters in their units, (9, n_cases), of (n_cases,) rows; never clipped to the box.

    They are, with the dynamic pressure Q: Q, Q/V, 1/V, gamma, C_Lbasic Q/V, C_Lelevator Q/V, C_DMach Q, C_melevator Q,
    C_mbasic Q. `around` is the air at this altitude, where it is known already.

    Examples
    --------
    >>> rho = parameters(*(np.array([value]) for value in (0.0074, 241.0, 7000.0, 0.0)))
    >>> [round(float(value), 4) for value in rho[:3, 0]]
    [17134.4284, 71.0972, 0.0041]
    """
    found = coefficients(alpha_rad, v_tas_m_s, air(altitude_m) if around is None else around)
    by_v = found.q_pa / v_tas_m_s
    drag = drag_coefficient(scheduled_lift(found.basic_lift), found.mach)
    return np.stack(
        [
            found.q_pa,
            by_v,
            1.0 / v_tas_m_s,
            gamma_rad,
            found.basic_lift * by_v,
            found.elevator_lift * by_v,
            drag * found.q_pa,
            found.elevator_moment * found.q_pa,
            found.basic_moment * found.q_pa,
        ]
    )
