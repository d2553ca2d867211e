"""Level, straight flight: incidence, thrust and stabiliser at which nothing accelerates."""

from typing import NamedTuple

import numpy as np

from fddbench.blocks.functions import cos, sin
from fddbench.blocks.layout import Row, Rows
from fddbench.blocks.solve import solve
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.transport.aerodynamics import Controls, lift_slope
from fddbench.flight.transport.air import air_around
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import Body, derivative, thrust_n
from fddbench.flight.wind import still
from fddbench.units import RAD_PER_DEG

__all__ = ["Trim", "neutral", "residual", "trim"]

_STEPS, _MOVE = 6, 1e-6


class Trim(NamedTuple):
    """A flight in level trim, (n_cases,) each: incidence and pitch angle, share of the thrust, stabiliser, speed, altitude."""

    alpha_rad: Row
    thrust_ratio: Row
    stabiliser_rad: Row
    v_tas_m_s: Row
    altitude_m: Row

    def rows(self) -> Rows:
        """State of the rigid body, (13, n_cases), heading north."""
        zero = np.zeros_like(self.alpha_rad)
        half = 0.5 * self.alpha_rad
        speed = (self.v_tas_m_s * cos(self.alpha_rad), zero, self.v_tas_m_s * sin(self.alpha_rad))
        attitude = (cos(half), zero, sin(half), zero)
        return np.stack([*speed, zero, zero, zero, *attitude, zero, zero, self.altitude_m + zero])


def neutral(stabiliser_rad: Row) -> Controls:
    """All surfaces at zero but the stabiliser."""
    zero = np.zeros_like(stabiliser_rad)
    return Controls(
        rudder=zero, aileron_1=zero, aileron_3=zero, spoiler=zero, elevator=zero, elevator_difference=zero,
        stabiliser=stabiliser_rad,
    )  # fmt: skip


def residual(aircraft: Aircraft, body: Body, at: Trim) -> Rows:
    """What still accelerates: along x and z [m/s^2] and in pitch [rad/s^2], (3, n_cases)."""
    found = derivative(
        aircraft, body, air_around(at.altitude_m), at.rows(), neutral(at.stabiliser_rad), still(at.alpha_rad),
        at.thrust_ratio,
    )  # fmt: skip
    return np.stack([found[0], found[2], found[4]])


def trim(aircraft: Aircraft, body: Body, v_tas_m_s: Row, altitude_m: Row) -> Trim:
    """Level trim of every case by Newton's method, in a fixed number of steps; about 1e-14 is left after three.

    A case that no thrust or lift can hold has a solution all the same; whether it may fly is for `limits` to say.
    """
    air = air_around(altitude_m)
    mach_squared = v_tas_m_s * v_tas_m_s / (1.4 * 287.05287 * air.temperature_k)
    pressure = 0.5 * air.density_kg_m3 * v_tas_m_s * v_tas_m_s
    weight = body.mass_kg * GRAVITY_M_S2
    lift = weight / (pressure * aircraft.geometry.wing_area_m2)
    alpha = aircraft.lift.alpha_zero_deg * RAD_PER_DEG + lift / lift_slope(aircraft, mach_squared)
    most = thrust_n(aircraft, air.density_kg_m3, np.sqrt(mach_squared))
    unknown = np.stack([alpha, 0.06 * weight / most, np.full_like(alpha, -0.05)])

    def left(unknown: Rows) -> Rows:
        at = Trim(unknown[0], unknown[1], unknown[2], v_tas_m_s, altitude_m)
        return residual(aircraft, body, at)

    for _ in range(_STEPS):
        here = left(unknown)
        columns = []
        for j in range(3):
            moved = np.stack([unknown[i] + (_MOVE if i == j else 0.0) for i in range(3)])
            columns.append((left(moved) - here) / _MOVE)
        unknown = unknown - solve(np.stack(columns, axis=1), here)
    return Trim(unknown[0], unknown[1], unknown[2], v_tas_m_s, altitude_m)
