"""Forces and moments of the air as coefficients in body axes."""

import numpy as np

from fddbench.blocks.layout import Row, record
from fddbench.flight.transport.aircraft import Aircraft, Slopes
from fddbench.units import RAD_PER_DEG

__all__ = ["Coefficients", "Controls", "Flow", "Longitudinal", "lateral", "lift_slope", "longitudinal"]


@record
class Controls:
    """Control surfaces as the air meets them [rad], (n_cases,) each.

    Ailerons 1 − 2 and 3 − 4, odd − even spoilers, mean and left − right elevator.
    """

    rudder: Row
    aileron_1: Row
    aileron_3: Row
    spoiler: Row
    elevator: Row
    elevator_difference: Row
    stabiliser: Row


@record
class Flow:
    """How the air meets the aircraft, (n_cases,) each.

    Cosine and sine of the incidence and its angle [rad], sine of the sideslip (what derivatives per rad of sideslip are
    multiplied with) and what the gust alone makes of it, Mach number and its square, dynamic pressure [Pa], rates ``p b/2V``,
    ``q c/2V``, ``r b/2V`` [-].
    """

    cos_alpha: Row
    sin_alpha: Row
    alpha_rad: Row
    sin_beta: Row
    gust_sin_beta: Row
    mach: Row
    mach_squared: Row
    pressure_pa: Row
    p: Row
    q: Row
    r: Row


@record
class Longitudinal:
    """C_X, C_Z, and C_m but for its part of alphadot; lift slope and lift of the wing [-]."""

    c_x: Row
    c_z: Row
    c_m: Row
    c_l_wing: Row


@record
class Coefficients:
    """Side force, rolling and yawing moment [-] about the centre of gravity."""

    c_y: Row
    c_l: Row
    c_n: Row


def lift_slope(aircraft: Aircraft, mach_squared: Row) -> Row:
    """Slope of the lift [1/rad] by Prandtl and Glauert with a factor of its own, held above a Mach number."""
    lift = aircraft.lift
    scale = lift.c_l_alpha * float(np.sqrt(1.0 - lift.compressibility * lift.mach_reference**2))
    return scale / np.sqrt(1.0 - lift.compressibility * np.minimum(mach_squared, lift.mach_held**2))


def longitudinal(aircraft: Aircraft, flow: Flow, controls: Controls, x_cg_ratio: Row) -> Longitudinal:
    """Coefficients in the plane of symmetry; lift and drag lie along the stability axes."""
    lift, pitch, drag = aircraft.lift, aircraft.pitch, aircraft.drag
    zero, stabiliser_zero = lift.alpha_zero_deg * RAD_PER_DEG, lift.stabiliser_zero_deg * RAD_PER_DEG
    wing = lift_slope(aircraft, flow.mach_squared) * (flow.alpha_rad - zero)
    c_l = (
        wing
        + lift.c_l_q * flow.q
        + lift.c_l_elevator * controls.elevator
        + lift.c_l_stabiliser * (controls.stabiliser - stabiliser_zero)
    )
    rise = np.maximum(flow.mach - drag.rise_mach + drag.rise_per_lift * (c_l - drag.rise_lift), 0.0)
    c_d = drag.c_d_0 + drag.induced * c_l * c_l + drag.rise * rise * rise * rise
    aft = np.maximum(flow.mach - pitch.neutral_point_mach, 0.0)
    neutral = pitch.neutral_point_ratio + pitch.neutral_point_per_mach * aft
    c_m = (
        pitch.c_m_0
        - wing * (neutral - x_cg_ratio)
        + pitch.c_m_q * flow.q
        + pitch.c_m_elevator * controls.elevator
        + pitch.c_m_stabiliser * controls.stabiliser
    )
    c_x = c_l * flow.sin_alpha - c_d * flow.cos_alpha
    c_z = -(c_l * flow.cos_alpha) - c_d * flow.sin_alpha
    return Longitudinal(c_x=c_x, c_z=c_z, c_m=c_m, c_l_wing=wing)


def lateral(
    aircraft: Aircraft, flow: Flow, controls: Controls, c_l_wing: Row, x_cg_ratio: Row, gust_yaw: Row
) -> Coefficients:
    """Lateral coefficients; the whole side force acts at the reference point.

    `gust_yaw` [-] is by how much the yawing moment of the sideslip that a gust makes is larger than C_n_beta says.
    """
    reference, d, s = aircraft.reference, aircraft.lateral, aircraft.surfaces
    more_lift = c_l_wing * (1.0 / reference.c_l) - 1.0
    more_mach = flow.mach - reference.mach
    more_pressure = flow.pressure_pa * (1.0 / reference.dynamic_pressure_pa) - 1.0

    def sloped(value: float, slopes: Slopes) -> Row:
        change = (
            (value * slopes.lift) * more_lift
            + (value * slopes.mach) * more_mach
            + (value * slopes.pressure) * more_pressure
        )
        return value + change

    def motion(beta: Row, p: Row, r: Row) -> Row:
        return beta * flow.sin_beta + p * flow.p + r * flow.r

    rudder, aileron_1, aileron_3, spoiler = (
        sloped(1.0, surface) * angle
        for surface, angle in (
            (s.rudder, controls.rudder),
            (s.aileron_1, controls.aileron_1),
            (s.aileron_3, controls.aileron_3),
            (s.spoiler, controls.spoiler),
        )
    )

    def control(of_rudder: float, of_aileron_1: float, of_aileron_3: float, of_spoiler: float) -> Row:
        return of_rudder * rudder + of_aileron_1 * aileron_1 + of_aileron_3 * aileron_3 + of_spoiler * spoiler

    geometry = aircraft.geometry
    c_y = motion(*(sloped(each.value, each) for each in (d.c_y_beta, d.c_y_p, d.c_y_r))) + control(
        s.rudder.c_y, s.aileron_1.c_y, s.aileron_3.c_y, s.spoiler.c_y
    )
    # half of the tail's lift on each side
    tail = 0.5 * aircraft.lift.c_l_elevator * geometry.elevator_arm_m / geometry.span_m
    c_l = (
        motion(*(sloped(each.value, each) for each in (d.c_l_beta, d.c_l_p, d.c_l_r)))
        + control(s.rudder.c_l, s.aileron_1.c_l, s.aileron_3.c_l, s.spoiler.c_l)
        + tail * controls.elevator_difference
    )
    off_model = gust_yaw * (sloped(d.c_n_beta.value, d.c_n_beta) * flow.gust_sin_beta)
    at_reference = motion(*(sloped(each.value, each) for each in (d.c_n_beta, d.c_n_p, d.c_n_r))) + control(
        s.rudder.c_n, s.aileron_1.c_n, s.aileron_3.c_n, s.spoiler.c_n
    )
    arm = (geometry.chord_m / geometry.span_m) * (x_cg_ratio - geometry.x_cg_reference_ratio)
    return Coefficients(c_y=c_y, c_l=c_l, c_n=at_reference + c_y * arm + off_model)
