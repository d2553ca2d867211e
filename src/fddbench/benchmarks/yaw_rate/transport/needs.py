"""What a manoeuvre needs more than its trim, and what it is cut down to in a flight that cannot do all of it."""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.lateral_law import balance
from fddbench.flight.atmosphere import mach
from fddbench.flight.envelope import buffet_lift, infeasible_reasons, lift_coefficient
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.travel import rudder_travel_deg
from fddbench.interfaces import Floats

__all__ = ["reasons", "sizes"]

_HELD_G = {
    "turn_coordination_1": 1.0 / float(np.cos(np.deg2rad(20.0))),
    "turn_coordination_2": 1.0 / float(np.cos(np.deg2rad(33.0))),
    "yaw_angle_mode": 1.0 / float(np.cos(np.deg2rad(15.0))),
}
_SPEED_KT = 10.0
_STICK_G, _SIDESLIP_SHARE, _LEAST_BUFFET_G = 0.3, 0.9, 1.1


def _faster_first(aircraft: Aircraft, mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats) -> Floats:
    """1 where 10 kt slower would be near buffet, so that the change of speed begins upward; else 0."""
    return np.where(_buffet_g(aircraft, mass_kg, altitude_ft, v_cas_kt - _SPEED_KT) < _LEAST_BUFFET_G, 1.0, 0.0)


def _buffet_g(aircraft: Aircraft, mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats) -> Floats:
    """Load factor at which buffet begins [g]."""
    at_one_g = lift_coefficient(mass_kg, altitude_ft, v_cas_kt, aircraft=aircraft)
    found: Floats = buffet_lift(mach(v_cas_kt, altitude_ft), aircraft) / at_one_g
    return found


def reasons(
    aircraft: Aircraft, manoeuvres: Sequence[str], mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats
) -> tuple[str, ...]:
    """Why each flight cannot hold its trim, or not the load factor or airspeed of its manoeuvre; "" where it can."""
    in_trim = infeasible_reasons(mass_kg, altitude_ft, v_cas_kt, aircraft=aircraft)
    slower = np.array([name == "speed_change" for name in manoeuvres])
    first = _faster_first(aircraft, mass_kg, altitude_ft, v_cas_kt)
    held_kt = v_cas_kt - np.where(slower, _SPEED_KT * (1.0 - 2.0 * first), 0.0)
    held_g = np.array([_HELD_G.get(name, 1.0) for name in manoeuvres])
    in_manoeuvre = infeasible_reasons(mass_kg, altitude_ft, held_kt, load_factor=held_g, aircraft=aircraft)
    return tuple(
        trim or (f"{name}: {held}" if held else "")
        for trim, name, held in zip(in_trim, manoeuvres, in_manoeuvre, strict=True)
    )


def sizes(
    aircraft: Aircraft, manoeuvres: Sequence[str], mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats
) -> Mapping[str, Floats]:
    """Share of the stick [-], step of the airspeed [kt] and largest sideslip [deg] of each flight."""
    to_buffet = _buffet_g(aircraft, mass_kg, altitude_ft, v_cas_kt) - 1.0
    gentle = np.array([name == "dqm" for name in manoeuvres])
    stick = np.where(gentle, np.minimum(_STICK_G, np.maximum(to_buffet, 0.0)), 1.0)
    first = _faster_first(aircraft, mass_kg, altitude_ft, v_cas_kt)
    sideslip = (
        _SIDESLIP_SHARE * rudder_travel_deg(aircraft.actuators, v_cas_kt) / abs(balance(aircraft).rudder_of_sideslip)
    )
    return {"stick_ratio": stick, "speed_kt": _SPEED_KT * (2.0 * first - 1.0), "sideslip_deg": sideslip}
