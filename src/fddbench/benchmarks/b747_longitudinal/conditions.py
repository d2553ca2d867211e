"""Where the Boeing 747 of the benchmark can fly level, and what its engines give.

Limits of the envelope are the corners of Table B1. Thrust is our choice: 230 kN of an engine at sea level, and at altitude
about a fifth more than engines of the type give, so that the published manoeuvre with a loss of thrust stays below it.
"""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from fddbench.benchmarks.b747_longitudinal.plant import ELEVATOR_DEG, TrimPoint
from fddbench.blocks.functions import pow_
from fddbench.blocks.layout import Row
from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import DATA, Aircraft, aircraft
from fddbench.flight.b747.trim import Condition, Trim, condition
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["flown_aircraft", "flown_condition", "infeasible_reasons", "thrust_highest_n", "trim_point"]

_SEA_LEVEL_N, _SEA_LEVEL_KG_M3 = 230e3, 1.225


def thrust_highest_n(altitude_m: Row, v_tas_m_s: Row) -> Row:
    """Most thrust of one engine [N], ``230 kN sigma^0.75 (1 - 0.36 sqrt M)`` with the relative density sigma.

    >>> thrust_highest_n(np.array([0.0, 7000.0, 10668.0]), np.array([0.0, 241.0, 252.0])).round(-2)
    array([230000.,  90900.,  63900.])
    """
    around = air(altitude_m)
    mach = v_tas_m_s / around.sound_m_s
    return _SEA_LEVEL_N * pow_(around.density_kg_m3 / _SEA_LEVEL_KG_M3, 0.75) * (1.0 - 0.36 * np.sqrt(mach))


def flown_aircraft(parameters: Mapping[str, Floats]) -> Aircraft:
    """Aircraft of flights."""
    return aircraft(
        parameters["mass_kg"],
        x_cg_ratio=parameters["x_cg_ratio"],
        c_m_alphadot=parameters["c_m_alphadot_ratio"],
        delta_c_l_percent=parameters["delta_c_l_percent"],
        delta_c_d_percent=parameters["delta_c_d_percent"],
        delta_c_m_percent=parameters["delta_c_m_percent"],
        delta_c_m_elevator_percent=parameters["delta_c_m_elevator_percent"],
    )


def flown_condition(parameters: Mapping[str, Floats]) -> Condition:
    """Level flight that flights begin in."""
    stabiliser_deg = parameters["stabiliser_deg"]
    return condition(parameters["altitude_m"], parameters["v_tas_m_s"], stabiliser_deg=stabiliser_deg)


def trim_point(at: Condition, found: Trim) -> TrimPoint:
    """Trim of flights; not-a-number where there is none."""
    alpha, elevator, thrust = (
        np.where(found.found, row, np.nan) for row in (found.alpha_rad, found.elevator_deg, found.thrust_n)
    )
    return TrimPoint(
        altitude_m=at.altitude_m,
        v_tas_m_s=at.v_tas_m_s,
        alpha_rad=alpha,
        elevator_deg=elevator,
        stabiliser_deg=at.stabiliser_deg,
        thrust_n=thrust,
        thrust_highest_n=thrust_highest_n(at.altitude_m, at.v_tas_m_s),
    )


def infeasible_reasons(at: TrimPoint) -> tuple[str, ...]:
    """Why each flight cannot begin in level flight, or the empty string; of several reasons the first."""
    (v_low, v_high), (h_low, h_high), (a_low, a_high) = (
        DATA["envelope"][name] for name in ("v_tas_m_s", "altitude_m", "alpha_deg")
    )
    alpha_deg, elevator_deg = DEG_PER_RAD * at.alpha_rad, at.elevator_deg
    tests = (
        (np.isnan(at.alpha_rad), "no trim: nothing balances the aircraft here", at.v_tas_m_s),
        (
            _outside(at.v_tas_m_s, v_low, v_high),
            f"airspeed {{0:.0f}} m/s, not in {v_low:g} ... {v_high:g}",
            at.v_tas_m_s,
        ),
        (
            _outside(at.altitude_m, h_low, h_high),
            f"altitude {{0:.0f}} m, not in {h_low:g} ... {h_high:g}",
            at.altitude_m,
        ),
        (
            _outside(alpha_deg, a_low, a_high),
            f"angle of attack {{0:.1f}} deg, not in {a_low:g} ... {a_high:g}",
            alpha_deg,
        ),
        (
            _outside(elevator_deg, *ELEVATOR_DEG),
            f"elevator {{0:.1f}} deg, not in {ELEVATOR_DEG[0]:g} ... {ELEVATOR_DEG[1]:g}",
            elevator_deg,
        ),
        (at.thrust_n > at.thrust_highest_n, "thrust {0:.0f} N of an engine, which gives {1:.0f}", at.thrust_n),
        (at.thrust_n < 0.0, "thrust {0:.0f} N: it would have to brake", at.thrust_n),
    )
    reasons = [""] * len(alpha_deg)
    for broken, text, value in reversed(tests):  # of several the first has the last word
        for i in np.flatnonzero(broken).tolist():
            reasons[i] = text.format(value[i], at.thrust_highest_n[i])
    return tuple(reasons)


def _outside(value: Floats, low: float, high: float) -> npt.NDArray[np.bool_]:
    outside: npt.NDArray[np.bool_] = (value < low) | (value > high)
    return outside
