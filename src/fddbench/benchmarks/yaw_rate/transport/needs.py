"""What a manoeuvre needs more than its trim, and what it is cut down to in a flight that cannot do all of it."""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.lateral_law import sideslip_orders
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.limits import buffet_load_factor
from fddbench.flight.transport.travel import rudder_travel_deg
from fddbench.interfaces import Floats

__all__ = ["held_load_factor_g", "held_slower_kt", "sizes"]

_HELD_G = {
    "turn_coordination_1": 1.0 / float(np.cos(np.deg2rad(20.0))),
    "turn_coordination_2": 1.0 / float(np.cos(np.deg2rad(33.0))),
    "yaw_angle_mode": 1.0 / float(np.cos(np.deg2rad(15.0))),
}
_SPEED_KT = 10.0
_STICK_G, _SIDESLIP_SHARE, _LEAST_BUFFET_G = 0.3, 0.9, 1.1


def held_load_factor_g(manoeuvres: Sequence[str]) -> Floats:
    """Load factor that each manoeuvre holds for long [g]; those of protections are what the protection allows."""
    return np.array([_HELD_G.get(name, 1.0) for name in manoeuvres])


def _faster_first(aircraft: Aircraft, mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats) -> Floats:
    """Whether 10 kt slower would be near buffet, so that the change of speed begins upward."""
    slower = buffet_load_factor(aircraft, mass_kg, altitude_ft, v_cas_kt - _SPEED_KT)
    return np.where(slower < _LEAST_BUFFET_G, 1.0, 0.0)


def held_slower_kt(
    aircraft: Aircraft, manoeuvres: Sequence[str], mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats
) -> Floats:
    """By how much each manoeuvre flies slower than its trim [kt]."""
    changes = np.array([name == "speed_change" for name in manoeuvres])
    return np.where(changes, _SPEED_KT * (1.0 - _faster_first(aircraft, mass_kg, altitude_ft, v_cas_kt)), 0.0)


def sizes(
    aircraft: Aircraft, manoeuvres: Sequence[str], mass_kg: Floats, altitude_ft: Floats, v_cas_kt: Floats
) -> Mapping[str, Floats]:
    """Share of the stick, step of the airspeed [kt] and largest sideslip [deg] of each flight."""
    to_buffet = buffet_load_factor(aircraft, mass_kg, altitude_ft, v_cas_kt) - 1.0
    gentle = np.array([name == "dqm" for name in manoeuvres])
    stick = np.where(gentle, np.minimum(_STICK_G, np.maximum(to_buffet, 0.0)), 1.0)
    first = _faster_first(aircraft, mass_kg, altitude_ft, v_cas_kt)
    sideslip = _SIDESLIP_SHARE * rudder_travel_deg(aircraft.actuators, v_cas_kt) / abs(sideslip_orders(aircraft)[1])
    return {"stick_ratio": stick, "speed_kt": _SPEED_KT * (2.0 * first - 1.0), "sideslip_deg": sideslip}
