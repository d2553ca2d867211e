"""The keys of a recipe that makes an `lpv_filter`, and the bank that they give."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench.campaign.rules.model import Name, Strict
from fddbench.design.geometric import ResidualGenerator, residual_generator
from fddbench.design.geometric.affine import Box, family
from fddbench.design.recipes.model_keys import Family, ModelRecipe, as_family, channel_data
from fddbench.design.recipes.recipe import Made, RecipeError, short
from fddbench.detection.lpv_filter.gains import NonZero, TrimEntry
from fddbench.errors import DesignError
from fddbench.interfaces import AffineModel, Floats

__all__ = ["DirectionEntry", "LpvFilterRecipe"]

_NOISE = 1e-13
"""What over the box is smaller than this share of the largest number of its column is rounding, and written as 0."""


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
    """

    input: str | None = None
    direction: Family | None = None
    unit_per_fault: NonZero = 1.0


Directions = dict[Name, DirectionEntry]


class LpvFilterRecipe(ModelRecipe):
    """How the numbers of an `lpv_filter` design come about; see `fddbench.design.geometric.residual_generator`.

    Attributes
    ----------
    faults : mapping of site to DirectionEntry, or to the signal of an input
        A filter for each, blind to the others.
    blind_to : mapping of name to DirectionEntry, or to the signal of an input
        What no filter shall see.
    decay : float
        Decay rate of the filters [1/s].
    one_state : bool
        Whether to take filters of one state where there are such.
    smooth_s : mapping of site to float
        Time constant of a lag on the estimate [s]; none where nothing is said.
    confirm_s : float
        Copied into the gains [s].
    trim : TrimEntry
        Copied into the gains.
    """

    faults: Annotated[Directions, Field(min_length=1)]
    blind_to: Directions = Field(default_factory=dict)
    decay: Annotated[float, Field(gt=0.0)]
    one_state: bool = True
    smooth_s: dict[Name, Annotated[float, Field(ge=0.0)]] = Field(default_factory=dict)
    confirm_s: Annotated[float, Field(ge=0.0)]
    trim: TrimEntry | None = None

    @classmethod
    def spelled_out(cls, written: Mapping[str, Any]) -> dict[str, Any]:
        """The recipe with the signal of an input as the entry that it is short for."""
        whole = super().spelled_out(written)
        for key in ("faults", "blind_to"):
            if isinstance(whole.get(key), dict):
                whole[key] = {name: _entry(value) for name, value in whole[key].items()}
        return whole

    def make(self) -> Made:
        """Bank of the recipe, and what is known of each filter."""
        model = self.affine()
        directions = self._directions(model)
        box = Box.of(model.box.tolist() or None, len(model.A) - 1)
        bank = residual_generator(
            model.A, model.B, model.C, {name: L for name, (L, _) in directions.items()},
            box=model.box.tolist() or None, decay=self.decay, watch=list(self.faults), one_state=self.one_state,
        )  # fmt: skip
        gains: dict[str, Any] = {
            "scheduling": self.flown_scheduling,
            "outputs": [channel_data(channel) for channel in model.outputs],
            "inputs": [channel_data(channel) for channel in model.inputs],
            "bend": _members(model.C @ model.A @ np.linalg.pinv(model.C), box),
            "filters": [
                _filter(found, model, box, directions[name][1]) | self._smoothed(name) for name, found in bank.items()
            ],
            "thresholds": [1.0] * len(bank),
            "confirm_s": self.confirm_s,
        }
        gains |= {} if self.trim is None else {"trim": self.trim.model_dump(mode="json")}
        moving = box.active(model.A)
        found = {"parameters_in_A": [j + 1 for j in moving], "corners": 2 ** len(moving)}
        return Made(gains=gains, found=found | {name: _findings(one) for name, one in bank.items()})

    def _directions(self, model: AffineModel) -> dict[str, tuple[Floats, float]]:
        """Direction of every fault, and the unit of its site per unit in the model; all that is wrong at once."""
        twice = sorted(set(self.faults) & set(self.blind_to))
        unknown = sorted(set(self.smooth_s) - set(self.faults))
        wrong = [f"recipe.blind_to: {name!r} has a filter; take it away there or from faults" for name in twice]
        known = ", ".join(self.faults)
        wrong += [f"recipe.smooth_s: no filter for {name!r}; there are {known}" for name in unknown]
        directions = {}
        for name, entry in (self.faults | self.blind_to).items():
            try:
                directions[name] = _direction(name, entry, model)
            except DesignError as error:
                wrong.append(error.message)
        if wrong:
            raise RecipeError(tuple(wrong))
        return directions

    def _smoothed(self, name: str) -> dict[str, float]:
        return {"smooth_s": self.smooth_s[name]} if self.smooth_s.get(name) else {}


def _entry(value: Any) -> Any:
    """The block that a fault's short form stands for."""
    if isinstance(value, dict) and "direction" in value:
        return value | {"direction": as_family(value["direction"])}
    return {"input": value} if isinstance(value, str) else value


def _direction(name: str, entry: DirectionEntry, model: AffineModel) -> tuple[Floats, float]:
    """Direction of a fault, and the unit of its site per unit in the model."""
    if (entry.input is None) == (entry.direction is None):
        raise DesignError(f"recipe: fault {name!r} has an input or a direction, one of both")
    if entry.direction is not None:
        shape, lone = (model.A.shape[1], 1), len(entry.direction) == 1
        given = entry.direction[0] if lone else entry.direction
        return family(f"the direction of fault {name!r}", given, shape, len(model.A) - 1), entry.unit_per_fault
    signals = [channel.signal for channel in model.inputs]
    if signals.count(entry.input or "") != 1:
        raise DesignError(
            f"recipe: fault {name!r} enters as input {entry.input!r}, which the model has {signals.count(entry.input or '')} "
            f"times; its inputs are {', '.join(filter(None, signals))}"
        )
    column = signals.index(entry.input or "")
    return model.B[:, :, [column]], 1.0 / model.inputs[column].scale


def _filter(found: ResidualGenerator, model: AffineModel, box: Box, unit_per_fault: float) -> dict[str, Any]:
    """Numbers of one filter as its design writes them."""
    points = box.looked_at(box.active(found.N, found.PL))
    least = min(float(np.linalg.norm(found.steady_gain(rho))) for rho in points)
    return {
        "site": found.fault,
        "N": _members(found.N, box),
        "G": _members(found.G, box),
        "F": _members(found.F, box, np.abs(found.P) @ np.abs(model.B)),
        "M": _members(found.M[np.newaxis], box)[0],
        "H": _members(found.H[np.newaxis], box)[0],
        "PL": _members(found.PL, box),
        "start": _members((found.P @ np.linalg.pinv(model.C))[np.newaxis], box)[0],
        "unit_per_fault": unit_per_fault,
        "least_gain": 0.5 * least,
    }


def _members(table: Floats, box: Box, terms: Floats | None = None) -> list[list[list[float]]]:
    """A family as lists without rounding and negative zeros; the constant matrix alone where nothing else moves it.

    `terms` is the size of what its numbers were summed of, by default they themselves.
    """
    largest = np.concatenate([[1.0], np.maximum(np.abs(box.low), np.abs(box.high))])[: len(table), None, None]
    size = (np.abs(table) if terms is None else terms) * largest
    kept = np.where(np.abs(table) * largest > _NOISE * size.max(axis=(0, 1), initial=0.0), table, 0.0)
    return [matrix.tolist() for matrix in (kept if np.any(kept[1:]) else kept[:1])]


def _findings(found: ResidualGenerator) -> dict[str, Any]:
    """What is known of a filter."""
    how = found.solvability
    return {
        "order": found.order,
        "parameters": [j + 1 for j in found.active],
        "smallest_angle_deg": short(how.smallest_angle_deg),
        "condition_number": short(how.condition_number),
        "sum_condition": how.sum_condition,
        "identity_kept": bool(found.identity_error < 1e-9),
    }
