"""The affine LPV model with nine parameters and a fictitious input held at one, Appendix B.

``xdot = A(rho) x + B(rho) u`` with the states of `fddbench.flight.b747.dynamics.STATES`. What is not affine is frozen at the
design point (7000 m, 241 m/s, level): sine and cosine of alpha in the thrust's direction, the air density in lift due to
pitch rate, and the drag of the tail's lift. The moment of alphadot is a product of two states' derivatives and a parameter:
``"fold"`` takes alphadot as q in it, ``"approx"`` keeps alphadot and freezes the parameter Q/V.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

from fddbench.blocks.functions import cos, sin
from fddbench.blocks.layout import Row, Rows
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.b747.aerodynamics import air, coefficients, drag_coefficient, scheduled_lift
from fddbench.flight.b747.airframe import DATA, Aircraft, aircraft
from fddbench.flight.b747.dynamics import ENGINES, cg_factor
from fddbench.flight.b747.scheduling import BOX, PARAMETERS
from fddbench.flight.b747.trim import condition, trim
from fddbench.systems import AffineLpv

__all__ = ["Frozen", "Terms", "Variant", "affine_model", "evaluated", "frozen", "per_alphadot", "slope", "terms"]

Variant = Literal["fold", "approx"]
Terms = Mapping[tuple[int, int], Mapping[int, Row]]
"""Entries of a matrix, (row, column) → parameter number (0: constant) → factor in the parameter's unit."""

_GEOMETRY, _LIFT, _MOMENT = DATA["geometry"], DATA["lift"], DATA["moment"]
_ALPHA, _Q, _V, _THETA, _H = range(5)
_ELEVATOR, _STABILISER, _THRUST, _FICTITIOUS = range(4)


@dataclass(frozen=True, kw_only=True)
class Frozen:
    """What the model holds at one point.

    Attributes
    ----------
    thrust_along_ratio, thrust_up_ratio : float
        Direction of the thrust: its share along the path, and across it, up [-].
    v_tas_m_s, density_kg_m3, q_by_v_pa_s_m : float
        Airspeed, air density, and dynamic pressure by airspeed.
    tail_drag : float
        Drag coefficient of what the tail adds to the basic lift [-].
    """

    thrust_along_ratio: float
    thrust_up_ratio: float
    v_tas_m_s: float
    density_kg_m3: float
    q_by_v_pa_s_m: float
    tail_drag: float


_POINT = DATA["design_point"]


@cache
def frozen(altitude_m: float = _POINT["altitude_m"], v_tas_m_s: float = _POINT["v_tas_m_s"]) -> Frozen:
    """What is frozen, from the trim of the nominal aircraft in level flight: at the design point by default."""
    at = condition(altitude_m, v_tas_m_s)
    trimmed, around = trim(aircraft(), at), air(at.altitude_m)
    found = coefficients(trimmed.alpha_rad, at.v_tas_m_s, around)
    tail = found.elevator_lift * trimmed.elevator_deg + _LIFT["stabiliser_per_deg"] * at.stabiliser_deg
    whole = drag_coefficient(found.basic_lift + tail, found.mach)
    s, c, incidence = sin(trimmed.alpha_rad), cos(trimmed.alpha_rad), _GEOMETRY["thrust_incidence_ratio"]
    return Frozen(
        thrust_along_ratio=float((c - incidence * s)[0]),
        thrust_up_ratio=float((s + incidence * c)[0]),
        v_tas_m_s=v_tas_m_s,
        density_kg_m3=float(around.density_kg_m3[0]),
        q_by_v_pa_s_m=float((found.q_pa / at.v_tas_m_s)[0]),
        tail_drag=float((whole - drag_coefficient(scheduled_lift(found.basic_lift), found.mach))[0]),
    )


def terms(own: Aircraft, held: Frozen, variant: Variant) -> tuple[Terms, Terms]:
    """Entries of A and B that are not zero, for the rows of an aircraft."""
    A, B = _forces(own, held)
    moments = _moments(own, held)
    if variant == "fold":
        moments[0][_Q, _Q][2] = moments[0][_Q, _Q][2] + per_alphadot(own)
    else:
        share = per_alphadot(own) * held.q_by_v_pa_s_m
        for matrix, lift_row in zip(moments, (A, B), strict=True):
            for (row, column), entry in lift_row.items():
                if row == _ALPHA:
                    place = matrix.setdefault((_Q, column), {})
                    for j, value in entry.items():
                        place[j] = place.get(j, 0.0) + share * value
    return {**A, **moments[0]}, {**B, **moments[1]}


def per_alphadot(own: Aircraft) -> Row:
    """Pitch acceleration per alphadot and per Q/V [m/(Pa s^2)]."""
    return _moment_scale(own) * _GEOMETRY["chord_m"] * own.c_m_ratio * own.c_m_alphadot


_Entries = dict[tuple[int, int], dict[int, Row]]


def _forces(own: Aircraft, held: Frozen) -> tuple[_Entries, _Entries]:
    """Rows of alpha, V, theta and h."""
    m, one, g = own.mass_kg, np.ones_like(own.mass_kg), GRAVITY_M_S2
    area = _GEOMETRY["wing_area_m2"] / m
    per_lift, per_thrust = own.c_l_ratio * area, ENGINES / m
    A: _Entries = {
        (_ALPHA, _Q): {0: one - per_lift * _turn_lift(own) * (0.5 * held.density_kg_m3)},
        (_V, _ALPHA): {0: g * one},
        (_V, _THETA): {0: -g * one},
        (_THETA, _Q): {0: one},
        (_H, _V): {4: one},
    }
    B: _Entries = {
        (_ALPHA, _ELEVATOR): {6: -per_lift},
        (_ALPHA, _STABILISER): {2: -per_lift * _LIFT["stabiliser_per_deg"]},
        (_ALPHA, _THRUST): {3: -per_thrust * held.thrust_up_ratio},
        (_ALPHA, _FICTITIOUS): {3: g * one, 5: -per_lift},
        (_V, _THRUST): {0: per_thrust * held.thrust_along_ratio},
        (_V, _FICTITIOUS): {1: -area * own.c_d_ratio * held.tail_drag, 7: -area * own.c_d_ratio},
    }
    return A, B


def _moments(own: Aircraft, held: Frozen) -> tuple[_Entries, _Entries]:
    """Row of q, without alphadot; the lift's moment about another centre of gravity keeps V where it is frozen."""
    scale = _moment_scale(own)
    aft = scale * (own.x_cg_ratio - _GEOMETRY["reference_cg_ratio"]) * own.c_l_ratio
    turn = scale * own.c_m_ratio * _MOMENT["pitch_rate"] * (0.5 * _GEOMETRY["chord_m"])
    A: _Entries = {(_Q, _Q): {2: turn + aft * _turn_lift(own)}}
    B: _Entries = {
        (_Q, _ELEVATOR): {6: aft * held.v_tas_m_s, 8: scale * own.c_m_elevator_ratio},
        (_Q, _STABILISER): {1: scale * _MOMENT["stabiliser_per_deg"] + aft * _LIFT["stabiliser_per_deg"]},
        (_Q, _THRUST): {0: ENGINES * _GEOMETRY["thrust_line_below_cg_m"] / own.iyy_kg_m2},
        (_Q, _FICTITIOUS): {5: aft * held.v_tas_m_s, 9: scale * own.c_m_ratio},
    }
    return A, B


def _moment_scale(own: Aircraft) -> Row:
    """Pitch acceleration per moment coefficient and dynamic pressure [rad/s^2/Pa]."""
    return _GEOMETRY["wing_area_m2"] * _GEOMETRY["chord_m"] / own.iyy_kg_m2


def _turn_lift(own: Aircraft) -> Row:
    """Lift coefficient per pitch rate, times V [m]."""
    return _LIFT["pitch_rate"] * cg_factor(own.x_cg_ratio) * (0.5 * _GEOMETRY["chord_m"])


def evaluated(entries: Terms, rho: Rows) -> dict[tuple[int, int], Row]:
    """Entries of a matrix at parameters in their units, (9, n_cases), summed in the order of the parameters."""
    found: dict[tuple[int, int], Row] = {}
    for place, entry in entries.items():
        values = [factor if j == 0 else factor * rho[j - 1] for j, factor in sorted(entry.items())]
        total = values[0]
        for value in values[1:]:
            total = total + value
        found[place] = total
    return found


def slope(A: Mapping[tuple[int, int], Row], B: Mapping[tuple[int, int], Row], x: Rows, u: Rows) -> Rows:
    """``A x + B u``, (5, n_cases), from entries that are not zero; x is (5, n_cases), u (4, n_cases)."""
    rows: list[Row] = [None] * len(x)
    for matrix, vector in ((A, x), (B, u)):
        for (row, column), value in sorted(matrix.items()):
            part = value * vector[column]
            rows[row] = part if rows[row] is None else rows[row] + part
    return np.stack(rows)


def affine_model(variant: Variant = "fold", *, own: Aircraft | None = None, held: Frozen | None = None) -> AffineLpv:
    """The model of one aircraft over the box of Table B1: tables A, (10, 5, 5, 1), and B, (10, 5, 4, 1).

    Inputs are elevator and stabiliser [deg], thrust per engine [N] and the fictitious input, one. `own` has rows of one
    aircraft, (1,), the nominal one by default; `held` is what is frozen, that of the design point by default.

    Examples
    --------
    >>> model = affine_model("approx")
    >>> model.tables["A"].shape, model.tables["B"].shape, model.names[0]
    ((10, 5, 5, 1), (10, 5, 4, 1), 'q_pa')
    """
    found = terms(aircraft() if own is None else own, frozen() if held is None else held, variant)
    low, high = BOX[:, :1], BOX[:, 1:]
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    tables = {}
    for name, entries, columns in zip("AB", found, (5, 4), strict=True):
        table = np.zeros((len(PARAMETERS) + 1, 5, columns, 1))
        for (row, column), entry in entries.items():
            for j, factor in entry.items():
                table[j, row, column] += factor
        for j in range(len(PARAMETERS)):
            table[0] += middle[j] * table[j + 1]
            table[j + 1] *= half[j]
        tables[name] = table
    return AffineLpv(tables=tables, names=PARAMETERS, trim=middle, scale=half)
