"""Gains of the laws over dynamic pressure: a power law each, as tables in constant memory."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from fddbench.blocks.functions import pow_
from fddbench.blocks.layout import Row
from fddbench.blocks.lookup import Grid, Lookup

__all__ = ["LAW", "Gains", "gains_at", "read_gains"]

LAW = Path(__file__).parent / "data" / "law.yaml"


class Gains(NamedTuple):
    """Feedback gains, (n_cases,) each; orders in deg of surface.

    Roll and rudder order on bank angle [rad], sideslip [rad], roll rate, yaw rate [rad/s] and the integral of the bank angle
    [rad s]; elevator order on load factor [g], pitch rate [rad/s] and the integral of the load factor [g s].
    """

    roll_phi: Row
    roll_beta: Row
    roll_p: Row
    roll_r: Row
    roll_integral: Row
    rudder_phi: Row
    rudder_beta: Row
    rudder_p: Row
    rudder_r: Row
    rudder_integral: Row
    elevator_n: Row
    elevator_q: Row
    elevator_integral: Row


_KNOTS_PA = np.geomspace(2000.0, 24000.0, 16)


@cache
def read_gains(path: Path = LAW) -> tuple[Grid, Mapping[str, Lookup]]:
    """Axis of dynamic pressure [Pa], and the table of each gain, of a file of power laws."""
    data: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    axis, share = Grid(_KNOTS_PA), _KNOTS_PA / float(data["reference_pressure_pa"])
    powers = {name: data["gains"][name] for name in Gains._fields}
    tables = {name: float(p["value"]) * pow_(share, float(p["exponent"])) for name, p in powers.items()}
    return axis, {name: Lookup(values, axis) for name, values in tables.items()}


def gains_at(pressure_pa: Row) -> Gains:
    """Gains at a dynamic pressure [Pa]."""
    axis, tables = read_gains()
    place = axis.find(pressure_pa)
    return Gains(**{name: table(place) for name, table in tables.items()})
