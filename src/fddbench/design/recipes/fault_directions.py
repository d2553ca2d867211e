"""How a recipe says by which way a fault enters: as an input of the model, in a direction of its states, or on an output."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.campaign.rules.model import Strict
from fddbench.design.geometric.affine import family
from fddbench.design.recipes.model_keys import Family, as_family
from fddbench.detection.lpv_filter.gains import ChannelEntry, NonZero
from fddbench.errors import DesignError
from fddbench.interfaces import AffineModel, Floats

__all__ = ["Direction", "DirectionEntry", "direction_of", "spelled_out"]


class DirectionEntry(Strict):
    """How a fault, or a disturbance, enters the states.

    Attributes
    ----------
    input : str
        As this input of the model does: an actuator. The estimate is in the unit of its signal.
    direction : matrix or list of matrices of one column
        Instead: L, or L_0, L_1, ....
    unit_per_fault : float
        Unit of the site per unit of the fault, with `direction`.
    sensor : str
        Instead: it adds to the output of the model that has this signal. A fault f of output row c is two directions of the
        states, of f' and of f: ``C^-1 c`` and ``-A C^-1 c`` in coordinates in which the reading is right. A filter is made for
        the first, the fresh fault; a filter that shall be blind must be so to both.
    reads : ChannelEntry
        With `sensor`, signal and row that stand in its place in this filter alone: one of several sensors whose voted signal
        the model has.
    """

    input: str | None = None
    direction: Family | None = None
    unit_per_fault: NonZero = 1.0
    sensor: str | None = None
    reads: ChannelEntry | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Direction:
    """A fault in the states of a model.

    Attributes
    ----------
    seen : (n_parameters + 1, n, 1) array
        Direction for which a filter of its own is made.
    hidden : (n_parameters + 1, n, m) array
        Directions to which the filters of other faults must be blind.
    unit_per_fault : float
        Unit of the site per unit in the model.
    output : int or None
        Output that a fault of a sensor adds to.
    """

    seen: Floats
    hidden: Floats
    unit_per_fault: float
    output: int | None = None


def spelled_out(value: Any) -> Any:
    """The block that a fault's short form stands for."""
    if isinstance(value, dict) and "direction" in value:
        return value | {"direction": as_family(value["direction"])}
    return {"input": value} if isinstance(value, str) else value


def direction_of(name: str, entry: DirectionEntry, model: AffineModel) -> Direction:
    """Direction of a fault in the states of a model.

    Raises
    ------
    DesignError
        The model does not have its input or output, or its outputs do not give the states.
    """
    ways = [each for each in (entry.input, entry.direction, entry.sensor) if each is not None]
    if len(ways) != 1:
        raise DesignError(
            f"recipe: fault {name!r} has an input or a direction or a sensor, one of them; got {len(ways)}"
        )
    if entry.reads is not None and entry.sensor is None:
        raise DesignError(f"recipe: fault {name!r} reads something in place of an output, which goes with sensor alone")
    if entry.sensor is not None:
        return _of_sensor(name, entry.sensor, model)
    if entry.direction is not None:
        shape, lone = (model.A.shape[1], 1), len(entry.direction) == 1
        given = entry.direction[0] if lone else entry.direction
        L = family(f"the direction of fault {name!r}", given, shape, len(model.A) - 1)
        return Direction(seen=L, hidden=L, unit_per_fault=entry.unit_per_fault)
    place = _only(name, "enters as input", "inputs", entry.input or "", [channel.signal for channel in model.inputs])
    L = model.B[:, :, [place]]
    return Direction(seen=L, hidden=L, unit_per_fault=1.0 / model.inputs[place].scale)


def _of_sensor(name: str, sensor: str, model: AffineModel) -> Direction:
    """With x + C^-1 c f for x the outputs are right: f' enters by C^-1 c, and f by -A C^-1 c."""
    place = _only(name, "is of output", "outputs", sensor, [channel.signal for channel in model.outputs])
    n = model.A.shape[1]
    if len(model.C) != n or np.linalg.matrix_rank(model.C) < n:
        raise DesignError(
            f"recipe: fault {name!r} of a sensor needs a model whose outputs give its state: C square and regular"
        )
    fresh = np.linalg.solve(model.C, np.eye(n)[:, [place]])
    rate = np.concatenate([fresh[np.newaxis], np.zeros((len(model.A) - 1, n, 1))])
    both = np.concatenate([rate, -(model.A @ fresh)], axis=2)
    return Direction(seen=rate, hidden=both, unit_per_fault=1.0 / model.outputs[place].scale, output=place)


def _only(name: str, how: str, what: str, signal: str, signals: list[str]) -> int:
    """Place of the one channel that has a signal."""
    if signals.count(signal) != 1:
        raise DesignError(
            f"recipe: fault {name!r} {how} {signal!r}, which the model has {signals.count(signal)} times; its {what} are "
            f"{', '.join(filter(None, signals))}"
        )
    return signals.index(signal)
