"""Commands of the manoeuvres as breakpoint tables: flight-path angle, airspeed, and what is added to the elevator order."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.blocks.functions import interpolate
from fddbench.blocks.layout import Row, Rows, record
from fddbench.interfaces import Floats

__all__ = ["DURATIONS_S", "KNOTS", "MANOEUVRES", "Command", "Commands", "commanded", "commands"]

KNOTS = 4
Table = tuple[tuple[float, float], ...]
_NOTHING: Table = ((0.0, 0.0),)


@dataclass(frozen=True, kw_only=True)
class Manoeuvre:
    """Breakpoints (time [s], value) of deviations from the trim; a repeated time is a step.

    Attributes
    ----------
    duration_s : float
        Length of a healthy flight [s].
    gamma_deg, speed_m_s : tables
        Flight-path angle [deg] and airspeed [m/s] that the law is commanded.
    elevator_deg : table
        Added to the law's order of the elevator [deg].
    """

    duration_s: float
    gamma_deg: Table = _NOTHING
    speed_m_s: Table = _NOTHING
    elevator_deg: Table = _NOTHING


def _step(time_s: float, size: float, until_s: float | None = None) -> Table:
    """A step, and back if it ends."""
    back = () if until_s is None else ((until_s, size), (until_s, 0.0))
    return ((time_s, 0.0), (time_s, size), *back)


MANOEUVRES: Mapping[str, Manoeuvre] = {
    "level": Manoeuvre(duration_s=150.0),
    # Figs. 4 to 7: times are the paper's, sizes are ours
    "figures": Manoeuvre(duration_s=150.0, gamma_deg=_step(25.0, 2.0, 100.0), speed_m_s=_step(30.0, 5.0)),
    # Fig. 1
    "elevator_pulse": Manoeuvre(duration_s=100.0, elevator_deg=_step(5.0, 6.0, 9.0)),
    # section V warns of trim changes over a long time: 300 s up or down, 2 deg, entered at 0.5 deg/s
    "climb": Manoeuvre(duration_s=400.0, gamma_deg=((25.0, 0.0), (29.0, 2.0), (325.0, 2.0), (329.0, 0.0))),
    "descent": Manoeuvre(duration_s=400.0, gamma_deg=((25.0, 0.0), (29.0, -2.0), (325.0, -2.0), (329.0, 0.0))),
    # one command alone, for settling times and what it does to the other quantity
    "gamma_step": Manoeuvre(duration_s=120.0, gamma_deg=_step(10.0, 2.0)),
    "speed_step": Manoeuvre(duration_s=180.0, speed_m_s=_step(10.0, 5.0)),
}
"""Manoeuvres by their names in campaigns."""

DURATIONS_S: Mapping[str, float] = {name: manoeuvre.duration_s for name, manoeuvre in MANOEUVRES.items()}
"""Manoeuvre → length of a healthy flight [s]."""


@record
class Commands:
    """Breakpoints of flights: times [s] and values, (KNOTS, n_cases) each."""

    gamma_s: Rows
    gamma_deg: Rows
    speed_s: Rows
    speed_m_s: Rows
    elevator_s: Rows
    elevator_deg: Rows


@record
class Command:
    """What is commanded at a sample, as deviations from the trim, (n_cases,) each."""

    gamma_deg: Row
    speed_m_s: Row
    elevator_deg: Row


def commands(manoeuvres: Sequence[str]) -> Commands:
    """Breakpoints of these manoeuvres, padded with the last one."""
    columns = [MANOEUVRES[name] for name in manoeuvres]
    gamma = _padded([one.gamma_deg for one in columns])
    speed, elevator = _padded([one.speed_m_s for one in columns]), _padded([one.elevator_deg for one in columns])
    return Commands(
        gamma_s=gamma[0],
        gamma_deg=gamma[1],
        speed_s=speed[0],
        speed_m_s=speed[1],
        elevator_s=elevator[0],
        elevator_deg=elevator[1],
    )


def _padded(tables: Sequence[Table]) -> Floats:
    """Times and values, (2, KNOTS, n_cases)."""
    full = [[*table, *[table[-1]] * (KNOTS - len(table))] for table in tables]
    return np.array(full, dtype=float).transpose(2, 1, 0)


def commanded(c: Commands, time_s: Row) -> Command:
    """What is commanded at a time [s]."""
    return Command(
        gamma_deg=interpolate(time_s, c.gamma_s, c.gamma_deg),
        speed_m_s=interpolate(time_s, c.speed_s, c.speed_m_s),
        elevator_deg=interpolate(time_s, c.elevator_s, c.elevator_deg),
    )
