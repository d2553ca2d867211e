"""The keys of a recipe that makes an `lpv_filter`, and the bank that they give."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench.campaign.rules.model import Name
from fddbench.design.geometric import ResidualGenerator, residual_generator
from fddbench.design.geometric.affine import Box
from fddbench.design.recipes.fault_directions import Direction, DirectionEntry, direction_of, spelled_out
from fddbench.design.recipes.flown_outputs import FlownOutputs
from fddbench.design.recipes.model_keys import ModelRecipe, channel_data
from fddbench.design.recipes.recipe import Made, RecipeError, short
from fddbench.detection.lpv_filter.gains import SensorsEntry, TrimEntry
from fddbench.errors import DesignError
from fddbench.interfaces import AffineModel, Floats

__all__ = ["DirectionEntry", "LpvFilterRecipe"]

_NOISE = 1e-13
"""What over the box is smaller than this share of the largest number of its column is rounding, and written as 0."""


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
    sensors : SensorsEntry
        Copied into the gains.
    """

    faults: Annotated[Directions, Field(min_length=1)]
    blind_to: Directions = Field(default_factory=dict)
    decay: Annotated[float, Field(gt=0.0)]
    one_state: bool = True
    smooth_s: dict[Name, Annotated[float, Field(ge=0.0)]] = Field(default_factory=dict)
    confirm_s: Annotated[float, Field(ge=0.0)]
    trim: TrimEntry | None = None
    sensors: SensorsEntry | None = None

    @classmethod
    def spelled_out(cls, written: Mapping[str, Any]) -> dict[str, Any]:
        """The recipe with the signal of an input as the entry that it is short for."""
        whole = super().spelled_out(written)
        for key in ("faults", "blind_to"):
            if isinstance(whole.get(key), dict):
                whole[key] = {name: spelled_out(value) for name, value in whole[key].items()}
        return whole

    def make(self) -> Made:
        """Bank of the recipe, and what is known of each filter."""
        model = self.affine()
        directions = self._directions(model)
        box = Box.of(model.box.tolist() or None, len(model.A) - 1)
        bank = {name: self._generator(model, directions, name) for name in self.faults}
        flown = FlownOutputs.of(
            model, {name: (d.output, self.faults[name].reads) for name, d in directions.items() if name in self.faults}
        )
        gains: dict[str, Any] = {
            "scheduling": self.flown_scheduling,
            "outputs": [channel_data(channel) for channel in flown.channels],
            "inputs": [channel_data(channel) for channel in model.inputs],
            "bend": _members(flown.bend(model), box),
            "filters": [
                _filter(found, model, box, directions[name], flown, name) | self._smoothed(name)
                for name, found in bank.items()
            ],
            "thresholds": [1.0] * len(bank),
            "confirm_s": self.confirm_s,
        }
        gains |= {} if self.trim is None else {"trim": self.trim.model_dump(mode="json")}
        gains |= {} if self.sensors is None else {"sensors": self.sensors.model_dump(mode="json")}
        moving = box.active(model.A)
        found = {"parameters_in_A": [j + 1 for j in moving], "corners": 2 ** len(moving)}
        return Made(gains=gains, found=found | {name: _findings(one) for name, one in bank.items()})

    def _generator(self, model: AffineModel, directions: Mapping[str, Direction], name: str) -> ResidualGenerator:
        """Filter of one fault; other sensors of the same output are no part of what it sees."""
        own = directions[name]
        others = {
            other: one.hidden
            for other, one in directions.items()
            if other != name and not (other in self.faults and one.output is not None and one.output == own.output)
        }
        return residual_generator(
            model.A, model.B, model.C, {name: own.seen, **others},
            box=model.box.tolist() or None, decay=self.decay, watch=[name], one_state=self.one_state,
        )[name]  # fmt: skip

    def _directions(self, model: AffineModel) -> dict[str, Direction]:
        """Direction of every fault; all that is wrong at once."""
        twice = sorted(set(self.faults) & set(self.blind_to))
        unknown = sorted(set(self.smooth_s) - set(self.faults))
        wrong = [f"recipe.blind_to: {name!r} has a filter; take it away there or from faults" for name in twice]
        known = ", ".join(self.faults)
        wrong += [f"recipe.smooth_s: no filter for {name!r}; there are {known}" for name in unknown]
        directions = {}
        for name, entry in (self.faults | self.blind_to).items():
            try:
                directions[name] = direction_of(name, entry, model)
            except DesignError as error:
                wrong.append(error.message)
        if wrong:
            raise RecipeError(tuple(wrong))
        return directions

    def _smoothed(self, name: str) -> dict[str, float]:
        return {"smooth_s": self.smooth_s[name]} if self.smooth_s.get(name) else {}


def _filter(
    found: ResidualGenerator, model: AffineModel, box: Box, own: Direction, flown: FlownOutputs, name: str
) -> dict[str, Any]:
    """Numbers of one filter as its design writes them."""
    points = box.looked_at(box.active(found.N, found.PL))
    least = min(float(np.linalg.norm(found.steady_gain(rho))) for rho in points)
    start = (found.P @ np.linalg.pinv(model.C))[np.newaxis]
    written = {
        "site": found.fault,
        "N": _members(found.N, box),
        "G": _members(flown.placed(found.G, name), box),
        "F": _members(found.F, box, np.abs(found.P) @ np.abs(model.B)),
        "M": _members(found.M[np.newaxis], box)[0],
        "H": _members(flown.placed(found.H[np.newaxis], name), box)[0],
        "PL": _members(found.PL, box),
        "start": _members(flown.placed(start, name), box)[0],
        "unit_per_fault": own.unit_per_fault,
        "least_gain": 0.5 * least,
    }
    return written if own.output is None else written | {"output": flown.places[name][own.output]}


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
