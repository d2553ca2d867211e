"""Equations of motion of a rigid aircraft over a flat earth, and what its sensors feel.

Attitude is a quaternion: the four evaluations of a Runge-Kutta step then need no sine or cosine, and no attitude is singular.
Its length is set to one after every step. Axes: body, x forward, y right, z down; earth, north, east, down.

Reference: Stevens, Lewis, Johnson (2016), Aircraft Control and Simulation, 3rd edition, sections 1.7 and 1.8.
"""

from typing import NamedTuple

import numpy as np

from fddbench.blocks.functions import asin, atan2, cos, sin
from fddbench.blocks.layout import Row, Rows, record
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.aerodynamics import Controls, Flow, lateral, longitudinal
from fddbench.flight.transport.air import AirAround
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.wind import AirMotion

__all__ = [
    "ROWS", "Body", "Forces", "State", "attitude", "derivative", "euler_rad", "flow_of", "forces", "gravity",
    "normalised", "thrust_n", "to_earth",
]  # fmt: skip

_GAMMA_R = 1.4 * 287.05287
_SEA_LEVEL_KG_M3 = 1.225


class State(NamedTuple):
    """Rows of the rigid body: velocity [m/s], rates [rad/s], attitude, position [m]; (n_cases,) each."""

    u: Row
    v: Row
    w: Row
    p: Row
    q: Row
    r: Row
    q0: Row
    q1: Row
    q2: Row
    q3: Row
    north: Row
    east: Row
    altitude: Row


ROWS = len(State._fields)


@record
class Body:
    """What of an aircraft differs from flight to flight, (n_cases,) each.

    Mass [kg], centre of gravity [-], moments of inertia and the three terms of their inverse in roll and yaw; ``1 + delta`` of
    the total coefficients [-]; by how much the yawing moment of a gust is larger than its sideslip says [-].
    """

    mass_kg: Row
    x_cg_ratio: Row
    i_xx: Row
    i_yy: Row
    i_zz: Row
    i_xz: Row
    roll_of_roll: Row
    roll_of_yaw: Row
    yaw_of_yaw: Row
    one_c_x: Row
    one_c_y: Row
    one_c_z: Row
    one_c_l: Row
    one_c_m: Row
    one_c_n: Row
    gust_yaw: Row


class Forces(NamedTuple):
    """Force over mass without gravity [m/s^2], that of the engines in it, moments about the centre of gravity [N m]."""

    x: Row
    y: Row
    z: Row
    thrust: Row
    roll: Row
    pitch: Row
    yaw: Row
    flow: Flow


def gravity(x: State) -> tuple[Row, Row, Row]:
    """Gravity in body axes [m/s^2]; `x` has an attitude of length one."""
    return (
        (2.0 * GRAVITY_M_S2) * (x.q1 * x.q3 - x.q0 * x.q2),
        (2.0 * GRAVITY_M_S2) * (x.q2 * x.q3 + x.q0 * x.q1),
        GRAVITY_M_S2 - (2.0 * GRAVITY_M_S2) * (x.q1 * x.q1 + x.q2 * x.q2),
    )


def thrust_n(aircraft: Aircraft, density_kg_m3: Row, mach: Row) -> Row:
    """Most thrust [N], ``T0 rho / rho0 (1 - k sqrt M)``."""
    thrust = aircraft.thrust
    return (thrust.sea_level_n / _SEA_LEVEL_KG_M3) * density_kg_m3 * (1.0 - thrust.per_root_mach * np.sqrt(mach))


def flow_of(
    aircraft: Aircraft, x: State, wind: AirMotion, density_kg_m3: Row, temperature_k: Row
) -> tuple[Flow, Row, Row]:
    """How the air meets the aircraft; squared speed in the plane of symmetry [m^2/s^2] and true airspeed [m/s] beside it."""
    u, v, w = x.u - wind.u_m_s, x.v - wind.v_m_s, x.w - wind.w_m_s
    plane = u * u + w * w
    squared = plane + v * v
    speed, in_plane = np.sqrt(squared), np.sqrt(plane)
    mach_squared = squared / (_GAMMA_R * temperature_k)
    half = 0.5 / speed
    span, chord = half * aircraft.geometry.span_m, half * aircraft.geometry.chord_m
    flow = Flow(
        cos_alpha=u / in_plane,
        sin_alpha=w / in_plane,
        alpha_rad=atan2(w, u),
        sin_beta=v / speed,
        gust_sin_beta=-(2.0 * half) * wind.v_m_s,
        mach=np.sqrt(mach_squared),
        mach_squared=mach_squared,
        pressure_pa=(0.5 * density_kg_m3) * squared,
        p=span * (x.p - wind.p_rad_s),
        q=chord * (x.q - wind.q_rad_s),
        r=span * (x.r - wind.r_rad_s),
    )
    return flow, plane, chord


def forces(
    aircraft: Aircraft, body: Body, air: AirAround, x: State, controls: Controls, wind: AirMotion, thrust_ratio: Row
) -> Forces:
    """Forces of air and engines, and moments about the centre of gravity."""
    density, temperature = air.at(x.altitude)
    flow, plane, chord = flow_of(aircraft, x, wind, density, temperature)
    along = longitudinal(aircraft, flow, controls, body.x_cg_ratio)
    across = lateral(aircraft, flow, controls, along.c_l_wing, body.x_cg_ratio, body.gust_yaw)
    area = flow.pressure_pa * aircraft.geometry.wing_area_m2
    per_mass = area / body.mass_kg
    thrust = thrust_ratio * thrust_n(aircraft, density, flow.mach)
    pushed = thrust / body.mass_kg
    a_x = per_mass * (body.one_c_x * along.c_x) + pushed
    a_z = per_mass * (body.one_c_z * along.c_z)
    g_x, _, g_z = gravity(x)
    # incidence changes with the accelerations of this instant; the air itself is held
    u_dot = a_x + g_x + x.r * x.v - x.q * x.w
    w_dot = a_z + g_z + x.q * x.u - x.p * x.v
    alpha_dot = ((x.u - wind.u_m_s) * w_dot - (x.w - wind.w_m_s) * u_dot) / plane
    c_m = body.one_c_m * (along.c_m + aircraft.pitch.c_m_alpha_dot * (chord * alpha_dot))
    span_area, chord_area = area * aircraft.geometry.span_m, area * aircraft.geometry.chord_m
    return Forces(
        x=a_x,
        y=per_mass * (body.one_c_y * across.c_y),
        z=a_z,
        thrust=pushed,
        roll=span_area * (body.one_c_l * across.c_l),
        pitch=chord_area * c_m + aircraft.geometry.thrust_arm_m * thrust,
        yaw=span_area * (body.one_c_n * across.c_n),
        flow=flow,
    )


def derivative(
    aircraft: Aircraft, body: Body, air: AirAround, rows: Rows, controls: Controls, wind: AirMotion, thrust_ratio: Row
) -> Rows:
    """``xdot`` of the rows of `State`, (13, n_cases), with surfaces, wind and engines held."""
    x = State(*rows)
    f = forces(aircraft, body, air, x, controls, wind, thrust_ratio)
    g_x, g_y, g_z = gravity(x)
    roll = f.roll + body.i_xz * (x.p * x.q) + (body.i_yy - body.i_zz) * (x.q * x.r)
    yaw = f.yaw - body.i_xz * (x.q * x.r) + (body.i_xx - body.i_yy) * (x.p * x.q)
    pitch = f.pitch + (body.i_zz - body.i_xx) * (x.p * x.r) - body.i_xz * (x.p * x.p - x.r * x.r)
    north, east, down = to_earth(x)
    return np.stack(
        [
            f.x + g_x + x.r * x.v - x.q * x.w,
            f.y + g_y + x.p * x.w - x.r * x.u,
            f.z + g_z + x.q * x.u - x.p * x.v,
            body.roll_of_roll * roll + body.roll_of_yaw * yaw,
            pitch / body.i_yy,
            body.roll_of_yaw * roll + body.yaw_of_yaw * yaw,
            -0.5 * (x.q1 * x.p + x.q2 * x.q + x.q3 * x.r),
            0.5 * (x.q0 * x.p + x.q2 * x.r - x.q3 * x.q),
            0.5 * (x.q0 * x.q + x.q3 * x.p - x.q1 * x.r),
            0.5 * (x.q0 * x.r + x.q1 * x.q - x.q2 * x.p),
            north,
            east,
            -down,
        ]
    )


def to_earth(x: State) -> tuple[Row, Row, Row]:
    """Velocity north, east and down [m/s]: ``v + 2 q x (q x v + q0 v)`` with the vector part of the attitude."""
    a = x.q2 * x.w - x.q3 * x.v + x.q0 * x.u
    b = x.q3 * x.u - x.q1 * x.w + x.q0 * x.v
    c = x.q1 * x.v - x.q2 * x.u + x.q0 * x.w
    return (
        x.u + 2.0 * (x.q2 * c - x.q3 * b),
        x.v + 2.0 * (x.q3 * a - x.q1 * c),
        x.w + 2.0 * (x.q1 * b - x.q2 * a),
    )


def attitude(phi_rad: Row, theta_rad: Row, psi_rad: Row) -> tuple[Row, Row, Row, Row]:
    """Quaternion of bank, pitch and heading angle."""
    (a, b), (c, d), (e, f) = ((cos(0.5 * angle), sin(0.5 * angle)) for angle in (phi_rad, theta_rad, psi_rad))
    return (
        a * c * e + b * d * f,
        b * c * e - a * d * f,
        a * d * e + b * c * f,
        a * c * f - b * d * e,
    )


def euler_rad(x: State) -> tuple[Row, Row, Row]:
    """Bank, pitch and heading angle [rad] of an attitude of length one."""
    phi = atan2(2.0 * (x.q0 * x.q1 + x.q2 * x.q3), 1.0 - 2.0 * (x.q1 * x.q1 + x.q2 * x.q2))
    theta = asin(np.minimum(np.maximum(2.0 * (x.q0 * x.q2 - x.q1 * x.q3), -1.0), 1.0))
    psi = atan2(2.0 * (x.q0 * x.q3 + x.q1 * x.q2), 1.0 - 2.0 * (x.q2 * x.q2 + x.q3 * x.q3))
    return phi, theta, psi


def normalised(rows: Rows) -> Rows:
    """Rows with an attitude of length one."""
    x = State(*rows)
    scale = 1.0 / np.sqrt(x.q0 * x.q0 + x.q1 * x.q1 + x.q2 * x.q2 + x.q3 * x.q3)
    return np.stack([*rows[:6], *(scale * each for each in rows[6:10]), *rows[10:]])
