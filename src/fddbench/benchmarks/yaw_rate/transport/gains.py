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
from fddbench.errors import DesignError

__all__ = ["LAW", "Gains", "Schedule", "read_law", "shipped_law"]

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


class Schedule:
    """Gains over dynamic pressure.

    Parameters
    ----------
    data : mapping
        ``reference_pressure_pa`` and ``gains``, a ``value`` and an ``exponent`` for each name of `Gains`.

    Raises
    ------
    DesignError
        A gain is missing.
    """

    def __init__(self, data: Mapping[str, Any]) -> None:
        missing = [name for name in Gains._fields if name not in data.get("gains", {})]
        if missing or "reference_pressure_pa" not in data:
            raise DesignError(
                f"a law needs reference_pressure_pa and the gains {', '.join(Gains._fields)}; no {missing}"
            )
        self._axis, share = Grid(_KNOTS_PA), _KNOTS_PA / float(data["reference_pressure_pa"])
        powers = {name: data["gains"][name] for name in Gains._fields}
        values = {name: float(p["value"]) * pow_(share, float(p["exponent"])) for name, p in powers.items()}
        self._tables = {name: Lookup(each, self._axis) for name, each in values.items()}

    def at(self, pressure_pa: Row) -> Gains:
        """Gains at a dynamic pressure [Pa]."""
        place = self._axis.find(pressure_pa)
        return Gains(**{name: table(place) for name, table in self._tables.items()})


def read_law(path: Path) -> Schedule:
    """Gains of a file of power laws, as `data/law.yaml` is one."""
    return Schedule(yaml.safe_load(path.read_text(encoding="utf-8")))


@cache
def shipped_law() -> Schedule:
    """Gains for the shipped aircraft, read once."""
    return read_law(LAW)
