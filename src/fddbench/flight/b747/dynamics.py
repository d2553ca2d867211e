"""Nonlinear longitudinal motion in body axes, equations (17) to (25) of the paper, with wind.

States are x = [alpha, q, V_T, theta, h_e] in rad, rad/s, m/s, rad, m. In wind, alpha and V_T are those of the motion over
ground and forces come from the motion through the air; in calm air both are the same. The moment of alphadot is linear in
alphadot, which does not depend on it, so it is solved exactly.

Reference: Szaszi, Marcos, Balas, Bokor (2005), Linear Parameter-Varying Detection Filter Design for a Boeing 747-100/200
Aircraft, J. Guidance, Control, and Dynamics 28(3), 461-470.
"""

import numpy as np

from fddbench.blocks.functions import atan2, cos, sin
from fddbench.blocks.layout import Row, Rows, record
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.b747.aerodynamics import Air, coefficients, drag_coefficient
from fddbench.flight.b747.airframe import DATA, Aircraft

__all__ = ["ENGINES", "INPUTS", "STATES", "Airflow", "airflow", "cg_factor", "derivative"]

STATES = ("alpha_rad", "q_rad_s", "v_tas_m_s", "theta_rad", "altitude_m")
"""States in their order."""
INPUTS = ("elevator_deg", "stabiliser_deg", "thrust_n")
"""Inputs in their order; thrust is that of one engine of four. A positive elevator pitches down."""
ENGINES = 4.0
_GEOMETRY, _LIFT, _MOMENT = DATA["geometry"], DATA["lift"], DATA["moment"]


@record
class Airflow:
    """Motion through the air: angle of attack [rad], airspeed [m/s], pitch rate [rad/s]."""

    alpha_rad: Row
    v_tas_m_s: Row
    q_rad_s: Row


def airflow(x: Rows, wind: Rows) -> Airflow:
    """Motion through the air of a state, (5, n_cases), in wind, (3, n_cases).

    The wind is u_g [m/s] along the body's x axis, w_g [m/s] along its z axis (down), both of the air, and q_g [rad/s].
    """
    u_m_s = x[2] * cos(x[0]) - wind[0]
    w_m_s = x[2] * sin(x[0]) - wind[1]
    speed = np.sqrt(u_m_s * u_m_s + w_m_s * w_m_s)
    return Airflow(alpha_rad=atan2(w_m_s, u_m_s), v_tas_m_s=speed, q_rad_s=x[1] - wind[2])


def cg_factor(x_cg_ratio: Row) -> Row:
    """Lift due to pitch rate at a centre of gravity, of that at a quarter of the chord [-]; equation (B1)."""
    return 1.45 - 1.8 * x_cg_ratio


def derivative(x: Rows, u: Rows, wind: Rows, aircraft: Aircraft, around: Air) -> Rows:
    """Time derivative of the states, (5, n_cases).

    Parameters
    ----------
    x, u : (5, n_cases) and (3, n_cases) rows
        `STATES` and `INPUTS`.
    wind : (3, n_cases) rows
        As `airflow` takes it.
    aircraft, around : Aircraft, Air
        What flies, and in which air.
    """
    flow = airflow(x, wind)
    F_x, F_z, moment, lever = _loads(flow, u, aircraft, around)
    s, c = sin(x[0]), cos(x[0])
    m, weight = aircraft.mass_kg, aircraft.mass_kg * GRAVITY_M_S2
    F_x, F_z = F_x - weight * sin(x[3]), F_z + weight * cos(x[3])
    alphadot = (F_z * c - F_x * s) / (m * x[2]) + x[1]
    qdot = (moment + lever * alphadot) / aircraft.iyy_kg_m2
    return np.stack([alphadot, qdot, (F_x * c + F_z * s) / m, x[1], x[2] * sin(x[3] - x[0])])


def _loads(flow: Airflow, u: Rows, aircraft: Aircraft, around: Air) -> tuple[Row, Row, Row, Row]:
    """Forces F_x, F_z [N] of air and engines, moment [N m] without alphadot, and moment per alphadot [N m s]."""
    found = coefficients(flow.alpha_rad, flow.v_tas_m_s, around)
    area_n = found.q_pa * _GEOMETRY["wing_area_m2"]
    turn = 0.5 * _GEOMETRY["chord_m"] * flow.q_rad_s / flow.v_tas_m_s
    lift = aircraft.c_l_ratio * (
        found.basic_lift
        + found.elevator_lift * u[0]
        + _LIFT["stabiliser_per_deg"] * u[1]
        + _LIFT["pitch_rate"] * cg_factor(aircraft.x_cg_ratio) * turn
    )
    drag = aircraft.c_d_ratio * drag_coefficient(lift, found.mach)
    s, c = sin(flow.alpha_rad), cos(flow.alpha_rad)
    normal = drag * s + lift * c
    moment = (
        aircraft.c_m_ratio * (found.basic_moment + _MOMENT["pitch_rate"] * turn)
        + aircraft.c_m_elevator_ratio * found.elevator_moment * u[0]
        + _MOMENT["stabiliser_per_deg"] * u[1]
        + (aircraft.x_cg_ratio - _GEOMETRY["reference_cg_ratio"]) * normal
    )
    thrust_n = ENGINES * u[2]
    arm_n_m = area_n * _GEOMETRY["chord_m"]
    return (
        thrust_n - area_n * (drag * c - lift * s),
        -area_n * normal - _GEOMETRY["thrust_incidence_ratio"] * thrust_n,
        arm_n_m * moment + _GEOMETRY["thrust_line_below_cg_m"] * thrust_n,
        arm_n_m * (_GEOMETRY["chord_m"] / flow.v_tas_m_s) * aircraft.c_m_ratio * aircraft.c_m_alphadot,
    )
