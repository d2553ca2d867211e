"""The laws together: from signals and commands to the order of every surface and of the engines, 60 ms late."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from fddbench.benchmarks.yaw_rate.control_law import allocate
from fddbench.benchmarks.yaw_rate.transport.autothrust import autothrust
from fddbench.benchmarks.yaw_rate.transport.gains import Gains, Schedule
from fddbench.benchmarks.yaw_rate.transport.lateral_law import LateralState, balance, lateral_law
from fddbench.benchmarks.yaw_rate.transport.longitudinal_law import (
    LongitudinalState,
    PitchOrders,
    load_factor_asked,
    longitudinal_law,
)
from fddbench.benchmarks.yaw_rate.transport.profiles import Commands, commanded
from fddbench.benchmarks.yaw_rate.transport.protections import Bounds, bounds
from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.ring import ring
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.units import DEG_PER_RAD

__all__ = ["GUIDANCE", "LawConstants", "LawState", "Orders", "TransportLaw"]

DELAY_S = 0.06


@record
class LawState:
    """States of the laws, integral of the airspeed [m], and orders on their way."""

    lateral: LateralState
    longitudinal: LongitudinalState
    speed_integral_m: Row
    roll: Rows
    rudder: Rows
    elevator: Rows
    stabiliser: Rows
    thrust: Rows


@record
class LawConstants:
    """Number of the manoeuvre; trim: incidence [rad], stabiliser [deg], share of the thrust, altitude [m], airspeed [kt].

    What the manoeuvre is cut down to in this flight: step of the stick [g], of the airspeed [kt], and sideslip [deg].
    """

    manoeuvre: Row
    alpha_rad: Row
    cos_theta: Row
    stabiliser_deg: Row
    thrust_ratio: Row
    altitude_m: Row
    v_cas_kt: Row
    stick_ratio: Row
    speed_kt: Row
    sideslip_deg: Row


class Orders(NamedTuple):
    """Orders to 13 lateral surfaces, both elevators and the stabiliser [deg], (16, n_cases), and to the engines [-].

    `guidance` is what they follow and within which bounds, by the names of `GUIDANCE`, to be looked at.
    """

    surface_deg: Rows
    thrust_ratio: Row
    guidance: Mapping[str, Row]


GUIDANCE = (
    *("bank_command_deg", "sideslip_command_deg", "track_command_deg", "n_z_command_g", "v_cas_command_kt"),
    *("n_z_least_g", "n_z_most_g", "alpha_limit_deg", "theta_limit_deg", "v_cas_limit_kt"),
)
"""Commands, then limits. Where no track, or no airspeed, is held, its command is what is flown."""


_ONE = LongitudinalState(limited_g=ROW, followed_g=ROW, expected_g=ROW, integral_g_s=ROW, stabiliser_deg=ROW)


class TransportLaw:
    """Block of all laws.

    Parameters
    ----------
    aircraft : Aircraft
        What it is for: limits, travel, and the surfaces of a steady sideslip.
    gains : Schedule
        Gains over dynamic pressure.
    sample_s : float
        Sample time [s]; the delay is 60 ms to the nearest sample, at least one.
    """

    constants = Layout(LawConstants(**dict.fromkeys(LawConstants.__dataclass_fields__, ROW)))
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, aircraft: Aircraft, gains: Schedule, sample_s: float) -> None:
        self.aircraft, self.gains, self.sample_s = aircraft, gains, sample_s
        self.steady = balance(aircraft)
        late = max(round(DELAY_S / sample_s), 1)
        self.states = Layout(
            LawState(
                lateral=LateralState(asked_rad=ROW, followed_rad=ROW, expected_rad=ROW, integral_rad_s=ROW), longitudinal=_ONE,
                speed_integral_m=ROW, roll=late, rudder=late, elevator=late, stabiliser=late, thrust=late,
            )
        )  # fmt: skip

    def start(self, c: LawConstants) -> LawState:
        """In trim, with its orders on their way."""
        late = np.ones((self.states.shape.stabiliser, 1))
        begun = LongitudinalState(
            limited_g=c.cos_theta,
            followed_g=c.cos_theta,
            expected_g=c.cos_theta,
            integral_g_s=0.0,
            stabiliser_deg=c.stabiliser_deg,
        )
        return LawState(
            lateral=LateralState(asked_rad=0.0, followed_rad=0.0, expected_rad=0.0, integral_rad_s=0.0), longitudinal=begun,
            speed_integral_m=0.0, roll=0.0, rudder=0.0, elevator=0.0, stabiliser=late * c.stabiliser_deg,
            thrust=late * c.thrust_ratio,
        )  # fmt: skip

    def step(self, x: LawState, c: LawConstants, n: Nothing, s: Sensed, sample: Row) -> tuple[LawState, Orders]:
        """State at the next sample, and the orders that leave at this one."""
        del n
        T, aircraft = self.sample_s, self.aircraft
        asked = commanded(c.manoeuvre, sample * T)
        k = self.gains.at(s.scheduled_pa)
        pedals = np.minimum(np.maximum(asked.pedals, -c.sideslip_deg), c.sideslip_deg)
        lateral, across = lateral_law(x.lateral, s, asked, pedals, k, self.steady, T)
        longitudinal, along, allowed, wanted_g = self._pitch(x, c, s, asked, k)
        speed, rate = c.v_cas_kt + asked.speed * c.speed_kt, asked.speed_rate * c.speed_kt
        integral, thrust = autothrust(
            aircraft, x.speed_integral_m, s, asked, speed, rate, c.thrust_ratio, allowed.too_fast, T
        )
        roll, roll_deg = ring(x.roll, across.roll_deg, sample)
        rudder, rudder_deg = ring(x.rudder, across.rudder_deg, sample)
        elevator, elevator_deg = ring(x.elevator, along.elevator_deg, sample)
        stabiliser, stabiliser_deg = ring(x.stabiliser, along.stabiliser_deg + asked.stabiliser_trim, sample)
        thrusts, thrust_ratio = ring(x.thrust, thrust, sample)
        after = LawState(
            lateral=lateral, longitudinal=longitudinal, speed_integral_m=integral, roll=roll, rudder=rudder,
            elevator=elevator, stabiliser=stabiliser, thrust=thrusts,
        )  # fmt: skip
        surfaces = np.concatenate(
            [allocate(rudder_deg, roll_deg), np.stack([elevator_deg, elevator_deg, stabiliser_deg])]
        )
        guidance = (
            DEG_PER_RAD * across.bank_rad,
            pedals,
            np.where(asked.track_held > 0.5, asked.track, DEG_PER_RAD * s.track_rad),
            wanted_g,
            np.where(asked.autothrust > 0.5, speed, s.v_cas_kt),
            allowed.least_g,
            allowed.most_g,
            DEG_PER_RAD * allowed.alpha_rad,
            DEG_PER_RAD * allowed.theta_rad,
            allowed.v_cas_kt,
        )
        return after, Orders(surfaces, thrust_ratio, dict(zip(GUIDANCE, guidance, strict=True)))

    def _pitch(
        self, x: LawState, c: LawConstants, s: Sensed, asked: Commands, k: Gains
    ) -> tuple[LongitudinalState, PitchOrders, Bounds, Row]:
        stick = asked.stick * c.stick_ratio
        wanted = load_factor_asked(s, asked, stick, c.alpha_rad, c.altitude_m)
        allowed = bounds(self.aircraft, s, stick, c.alpha_rad)
        after, orders = longitudinal_law(x.longitudinal, s, wanted, allowed, k, self.aircraft.actuators, self.sample_s)
        return after, orders, allowed, wanted
