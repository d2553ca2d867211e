"""Bank-angle commands of the manoeuvres that a lateral model can fly, as breakpoint tables.

Sizes and times are our reading of the airframer's names (the command histories of the ADDSAFE benchmark are not public).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.blocks.linear import column
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.interfaces import Floats

__all__ = ["DURATIONS_S", "KNOTS", "bank_commands"]

DURATIONS_S: Mapping[str, float] = dict.fromkeys(
    ("cruise", "yaw_angle_mode", "turn_coordination_1", "turn_coordination_2", "roll_doublet"), 60.0
)
"""Manoeuvre → length of a healthy flight [s]."""

KNOTS = 9
_START_S = 5.0
_TABLES: Mapping[str, tuple[tuple[float, float], ...]] = {
    "cruise": ((0.0, 0.0),),
    # 20 deg of bank to one side at 5 deg/s, held 20 s
    "turn_coordination_1": ((5.0, 0.0), (9.0, 20.0), (29.0, 20.0), (33.0, 0.0)),
    # 33 deg at 5 deg/s, held 20 s, over to the other side and back
    "turn_coordination_2": ((5.0, 0.0), (11.6, 33.0), (31.6, 33.0), (44.8, -33.0), (51.4, 0.0)),
    # +-20 deg at 10 deg/s, 2 s on each side
    "roll_doublet": ((5.0, 0.0), (7.0, 20.0), (9.0, 20.0), (13.0, -20.0), (15.0, -20.0), (17.0, 0.0)),
}
_YAW_BANK_DEG, _YAW_ROLL_DEG_S, _YAW_HEADING_DEG, _YAW_BACK_S = 15.0, 4.0, 10.0, 30.0


def _yaw_angle_mode(v_tas_m_s: Floats) -> tuple[Floats, Floats]:
    """Heading +10 deg with at most 15 deg of bank, and back from 30 s on; faster aircraft hold the bank longer."""
    ramp_s = _YAW_BANK_DEG / _YAW_ROLL_DEG_S
    turn_deg_s = np.rad2deg(GRAVITY_M_S2 / v_tas_m_s * np.deg2rad(_YAW_BANK_DEG))
    hold_s = np.maximum(_YAW_HEADING_DEG / turn_deg_s - ramp_s, 0.0)
    none = np.zeros_like(hold_s)
    shape_s = np.stack([none, none + ramp_s, ramp_s + hold_s, 2.0 * ramp_s + hold_s])
    level = column((0.0, 1.0, 1.0, 0.0)) + none
    time_s = np.concatenate([_START_S + shape_s, _YAW_BACK_S + shape_s])
    return time_s, np.concatenate([_YAW_BANK_DEG * level, -_YAW_BANK_DEG * level])


def bank_commands(manoeuvres: Sequence[str], v_tas_m_s: Floats) -> tuple[Floats, Floats]:
    """Times [s] and bank angles [deg] of the breakpoints, (KNOTS, n_cases) each, padded with the last value."""
    time_s, bank_deg = np.empty((2, KNOTS, len(manoeuvres)))
    names = np.array(manoeuvres, dtype=object)
    for name in set(manoeuvres):
        mine = names == name
        table = _yaw_angle_mode(v_tas_m_s[mine]) if name == "yaw_angle_mode" else column(_TABLES[name]).swapaxes(0, 1)
        for rows, values in zip((time_s, bank_deg), table, strict=True):
            rows[: len(values), mine] = values
            rows[len(values) :, mine] = values[-1]
    return time_s, bank_deg
