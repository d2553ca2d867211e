"""What the pilot does in each manoeuvre: command histories as breakpoints, in tables that all flights share.

Names are the airframer's (Tables 2 and 9 of the paper); sizes and times are our reading of them, the histories are not public.
Every flight starts in trim, lasts 60 s and gets its first input at 5 s. Orders that jump do so within 10 ms.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from fddbench.blocks.layout import Row
from fddbench.blocks.lookup import Grid, Lookup

__all__ = ["CHANNELS", "DURATIONS_S", "MANOEUVRES", "Commands", "commanded", "number_of"]

Points = tuple[tuple[float, float], ...]


class Commands(NamedTuple):
    """What is asked for at a sample, (n_cases,) each.

    Lateral: stick [deg/s of roll], pedals [deg of sideslip], whether the track is held [-] and at which angle [deg].
    Longitudinal: stick [g], pitch angle over that of the trim [deg], whether altitude, or pitch angle, is held [-]. Airspeed
    over that of the trim in steps of the flight [-] and its rate [1/s], whether autothrust holds it [-], else the thrust: -1
    idle, 0 as trimmed, 1 full. Trims of stabiliser, rudder and ailerons [deg].
    """

    roll_stick: Row
    pedals: Row
    track_held: Row
    track: Row
    stick: Row
    theta: Row
    altitude_held: Row
    theta_held: Row
    speed: Row
    speed_rate: Row
    autothrust: Row
    thrust: Row
    stabiliser_trim: Row
    rudder_trim: Row
    roll_trim: Row


CHANNELS = Commands._fields
_REST = {"track_held": 1.0, "altitude_held": 1.0, "autothrust": 1.0}
_JUMP_S = 0.01
FULL_G = 9.0
"""Stick at its stop: the protections say what comes of it."""


def _steps(*changes: tuple[float, float]) -> Points:
    """Jumps to these values at these times, from 0."""
    points, before = [(0.0, 0.0)], 0.0
    for time_s, value in changes:
        points += [(time_s - _JUMP_S, before), (time_s, value)]
        before = value
    return tuple(points)


def _off(time_s: float) -> Points:
    """Held up to a time."""
    return ((0.0, 1.0), (time_s - _JUMP_S, 1.0), (time_s, 0.0))


_ALWAYS: Points = ((0.0, 1.0),)
_NEVER: Points = ((0.0, 0.0),)


def _three_two_one_one(start_s: float, sign: float) -> tuple[tuple[float, float], ...]:
    """3-2-1-1 of unit size, unit 1 s."""
    return ((start_s, sign), (start_s + 3, -sign), (start_s + 5, sign), (start_s + 6, -sign), (start_s + 7, 0.0))


def _trimmed(start_s: float, size: float) -> Points:
    """5 s to one side and 5 s to the other, ramps of 1 s."""
    shape = ((0, 0), (1, 1), (5, 1), (6, -1), (9, -1), (10, 0))
    return tuple((start_s + t, size * value) for t, value in shape)


_LEVEL_WINGS = {"track_held": _NEVER}
_BY_HAND = {"altitude_held": _NEVER}
MANOEUVRES: Mapping[str, Mapping[str, Points]] = {
    "cruise": {},
    "turn_coordination_1": {**_LEVEL_WINGS, "roll_stick": _steps((5, 5), (9, 0), (29, -5), (33, 0))},
    # 33 deg at 5 deg/s, held 20 s, over to the other side and back
    "turn_coordination_2": {**_LEVEL_WINGS, "roll_stick": _steps((5, 5), (11.6, 0), (31.6, -5), (44.8, 5), (51.4, 0))},
    "yaw_angle_mode": {"track": _steps((5, 10), (30, 0))},
    "nose_up": {
        **_BY_HAND,
        "theta_held": _ALWAYS,
        "theta": ((5, 0), (7.5, 5), (17.5, 5), (20, 0)),
    },
    "nose_up_2": {
        **_BY_HAND,
        "theta_held": _ALWAYS,
        "theta": ((5, 0), (5 + 10 / 3, 10), (11 + 10 / 3, 10), (11 + 20 / 3, 0)),
    },
    "nose_down": {
        **_BY_HAND,
        "theta_held": _off(22.5),
        "theta": ((5, 0), (7.5, -5), (60, -5)),
        "stick": _steps((22.5, 0.3), (27.5, 0.0)),
        "altitude_held": ((0.0, 0.0), (27.49, 0.0), (27.5, 0.0)),
    },
    "pitch_protection_1": {
        **_BY_HAND,
        "stick": _steps((5, FULL_G), (13, 0)),
        "autothrust": _off(5),
        "thrust": _steps((5, 1)),
        # then the nose comes down to the attitude of the trim
        "theta_held": _steps((20, 1)),
        "theta": ((0, 25), (20, 25), (45, 0)),
    },
    "aoa_protection_1": {
        "autothrust": _off(5),
        "thrust": _steps((5, -1)),
        "altitude_held": _off(45),
        "stick": _steps((45, FULL_G), (50, 0)),
    },
    "n_z_limitation_1": {
        **_BY_HAND,
        "stick": _steps((5, FULL_G), (9, -FULL_G), (11, 0)),
        "theta_held": _steps((14, 1)),  # then back to the attitude of the trim
    },
    "speed_mach_protection": {
        **_BY_HAND,
        "autothrust": _off(5),
        "stick": _steps((5, -0.5)),
    },
    "roll_protection": {
        **_BY_HAND,
        **_LEVEL_WINGS,
        "roll_stick": _steps((5, 15), (5 + 67 / 15 + 5, 0)),
        "theta_held": _steps((17, 1)),  # then back to the attitude of the trim
    },
    "dqm": {**_BY_HAND, "stick": _steps(*_three_two_one_one(5, 1.0), *_three_two_one_one(30, -1.0))},
    "dpm": {
        **_LEVEL_WINGS,
        "roll_stick": _steps((5, 10), (7, -10), (9, 0), (25, 15), (27, -15), (29, 0)),
    },
    "drm": {"pedals": _steps((5, 2), (7, -2), (9, 0))},
    "all_trim_mode": {
        "stabiliser_trim": _trimmed(5, 0.5),
        "rudder_trim": _trimmed(20, 1.0),
        "roll_trim": _trimmed(35, 2.0),
    },
    "side_slip_mode": {"pedals": ((5, 0), (9, 4), (24, 4), (28, 0))},
    # 0.45 kt/s: idle slows by 0.5 to 1.1 kt/s only
    "speed_change": {
        "speed": ((5, 0), (27, 1), (33, 1), (55, 0)),
        "speed_rate": _steps((5, 1 / 22), (27, 0), (33, -1 / 22), (55, 0)),
    },
}
"""Manoeuvre → breakpoints (time [s], value) of what differs from level flight on track at the airspeed of the trim."""

DURATIONS_S: Mapping[str, float] = dict.fromkeys(MANOEUVRES, 60.0)
"""Manoeuvre → length of a healthy flight [s]."""


def number_of(manoeuvre: str) -> float:
    """Row of a manoeuvre in the tables."""
    return float(list(MANOEUVRES).index(manoeuvre))


def _tables() -> tuple[Grid, Grid, dict[str, Lookup]]:
    found = {
        (name, channel): np.array(given.get(channel, ((0.0, _REST.get(channel, 0.0)),)), dtype=float)
        for name, given in MANOEUVRES.items()
        for channel in CHANNELS
    }
    times = np.unique(np.round(np.concatenate([points[:, 0] for points in found.values()] + [[0.0, 60.0]]), 9))
    rows, columns = Grid(np.arange(len(MANOEUVRES) + 1.0)), Grid(times)
    tables = {}
    for channel in CHANNELS:
        values = [np.interp(times, *found[name, channel].T) for name in MANOEUVRES]
        tables[channel] = Lookup([*values, values[-1]], rows, columns)  # the last row is never met
    return rows, columns, tables


_ROWS, _TIMES, _LOOKUPS = _tables()


def commanded(number: Row, time_s: Row) -> Commands:
    """Commands of manoeuvres by their numbers at a time [s]."""
    places = _ROWS.find(number), _TIMES.find(time_s)
    return Commands(**{channel: table(*places) for channel, table in _LOOKUPS.items()})
