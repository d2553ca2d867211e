"""Plants of a `hinf_filter` recipe that come of the affine model of a scheduling: corners of its box, or flight conditions."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench import kinds
from fddbench.campaign.rules.model import Name, Strict
from fddbench.design.geometric.affine import Box, at
from fddbench.design.recipes.linearisation import linearised
from fddbench.design.recipes.model_keys import channel_data
from fddbench.errors import DesignError, FddbenchError, did_you_mean
from fddbench.interfaces import AffineModel, Floats, Scheduling
from fddbench.systems import UncertainPlant

__all__ = ["ModelEntry", "ModelPlants", "model_plants"]

Number = Annotated[float, Field(allow_inf_nan=False)]


class EnteringEntry(Strict):
    """Where a fault enters: `input`, the signal of an input of the model, or `output`, the number of an output from 0."""

    input: str | None = None
    output: Annotated[int, Field(ge=0)] | None = None


class ModelEntry(Strict):
    """A model of which a robust filter is made.

    Disturbances are an unknown rate of every state and noise of every output, in this order: W_d gives them their sizes.

    Attributes
    ----------
    scheduling, name : str
        Which model: registered, or ``mine.py:Mine`` beside the design, and its name there.
    at : list of mapping of signal to number
        Flight conditions: the model is linearised at each, and the hull of what comes of it is the set of plants. Channels are
        about the first. The corners of the box of the model when left out.
    taken_as_inputs : list of str
        Signals of outputs that are states by themselves: what they drive is known since they are measured, and their own rows
        are left out. So a slow or unstable part of the plant that a filter need not model is none of its business.
    units : mapping of signal to number
        Of a model whose outputs are its states, the unit that the filter takes of a signal in the unit of the bus: 10000 for a
        thrust in 10 kN, 1 where nothing is said. A solver needs numbers of one size. Faults of inputs are in it too.
    faults : mapping of site to EnteringEntry
        In the order of the residuals.
    """

    scheduling: str
    name: str
    at: Annotated[tuple[dict[str, Number], ...], Field(min_length=1)] | None = None
    taken_as_inputs: tuple[str, ...] = ()
    units: dict[str, Annotated[float, Field(gt=0.0)]] | None = None
    faults: Annotated[dict[Name, EnteringEntry], Field(min_length=1)]


@dataclass(frozen=True, kw_only=True)
class ModelPlants:
    """Vertices, and what the design file says of the signals: ``outputs``, ``inputs`` and ``sites``."""

    vertices: tuple[UncertainPlant, ...]
    keys: dict[str, Any]


def model_plants(entry: ModelEntry, beside: Path) -> ModelPlants:
    """Vertices of a model.

    Raises
    ------
    DesignError
        There is no such model, or it lacks what a fault enters by.
    """
    try:
        scheduling = kinds.find("scheduling", entry.scheduling, beside=beside).member()
    except FddbenchError as error:
        raise DesignError(f"recipe.model.scheduling: {error}") from error
    models = getattr(scheduling, "models", {})
    if entry.name not in models:
        raise DesignError(
            f"recipe.model.name: scheduling {entry.scheduling!r} has no model {entry.name!r}. "
            f"{did_you_mean(entry.name, models)} It has: {', '.join(models) or 'none'}"
        )
    model = models[entry.name]()
    members = [
        _reduced(_in_units(each, entry.units), entry.taken_as_inputs) for each in _members(model, entry, scheduling)
    ]
    # a constant is no input that could have a size, and moves nothing about a trim
    signals = [j for j, channel in enumerate(members[0].inputs) if channel.signal]
    plants = tuple(_plant(own.A[0], own.B[0], own, entry, signals) for own in members)
    keys = {
        "outputs": [channel_data(channel) for channel in members[0].outputs],
        "inputs": [channel_data(members[0].inputs[j]) for j in signals],
        "sites": list(entry.faults),
    }
    return ModelPlants(vertices=plants, keys=keys)


def _members(model: AffineModel, entry: ModelEntry, scheduling: Scheduling) -> list[AffineModel]:
    """Models without parameters: at the corners of the box, or at flight conditions."""
    if entry.at is not None:
        return [linearised(model, scheduling, condition) for condition in entry.at]
    box = Box.of(model.box.tolist() or None, len(model.A) - 1)
    corners = box.corners(box.active(model.A, model.B))
    return [
        AffineModel(
            A=at(model.A, rho)[np.newaxis], B=at(model.B, rho)[np.newaxis], C=model.C, outputs=model.outputs,
            inputs=model.inputs, box=np.zeros((0, 2)),
        )
        for rho in corners
    ]  # fmt: skip


def _in_units(model: AffineModel, units: Mapping[str, float] | None) -> AffineModel:
    """A model whose outputs are its states with these, and its inputs, in units of the signals; as it is without any."""
    if units is None:
        return model
    channels = (*model.outputs, *model.inputs)
    unknown = [name for name in units if name not in {channel.signal for channel in channels}]
    if unknown or not np.array_equal(model.C, np.eye(model.A.shape[1])):
        known = ", ".join(dict.fromkeys(channel.signal for channel in channels if channel.signal))
        raise DesignError(
            f"recipe.model.units: {', '.join(unknown) or 'they'} must belong to signals of a model whose outputs are its "
            f"states; it has {known}"
        )
    size = [channel.scale * units.get(channel.signal, 1.0) if channel.signal else 1.0 for channel in channels]
    x, u = np.split(np.array(size), [len(model.outputs)])
    outputs, inputs = (
        tuple(replace(c, scale=1.0 / units.get(c.signal, 1.0)) if c.signal else c for c in each)
        for each in (model.outputs, model.inputs)
    )
    A, B = model.A * x / x[:, np.newaxis], model.B * u / x[:, np.newaxis]
    return replace(model, A=A, B=B, outputs=outputs, inputs=inputs)


def _reduced(model: AffineModel, names: tuple[str, ...]) -> AffineModel:
    """The model with some of its states, which are outputs, as inputs in front of the others."""
    if not names:
        return model
    signals = [channel.signal for channel in model.outputs]
    wrong = [name for name in names if signals.count(name) != 1]
    if wrong or not np.array_equal(model.C, np.eye(len(model.A[0]))):
        raise DesignError(
            f"recipe.model.taken_as_inputs: {', '.join(wrong or names)} must be an output that is a state by itself; the "
            f"outputs are {', '.join(signals)}"
        )
    moved = [signals.index(name) for name in names]
    kept = [j for j in range(len(signals)) if j not in moved]
    return replace(
        model,
        A=model.A[:, kept][:, :, kept],
        B=np.concatenate([model.A[:, kept][:, :, moved], model.B[:, kept]], axis=2),
        C=np.eye(len(kept)),
        outputs=tuple(model.outputs[j] for j in kept),
        inputs=(*(model.outputs[j] for j in moved), *model.inputs),
    )


def _plant(A: Floats, B: Floats, model: AffineModel, entry: ModelEntry, signals: list[int]) -> UncertainPlant:
    """One vertex."""
    n, n_y, n_f = len(A), len(model.C), len(entry.faults)
    Bf, Df = np.zeros((n, n_f)), np.zeros((n_y, n_f))
    names = [model.inputs[j].signal for j in signals]
    for column, (site, entering) in enumerate(entry.faults.items()):
        if (entering.input is None) == (entering.output is None):
            raise DesignError(f"recipe.model.faults: {site!r} has an input or an output, one of both")
        if entering.output is not None:
            if entering.output >= n_y:
                raise DesignError(f"recipe.model.faults: {site!r}: output {entering.output}, there are 0 to {n_y - 1}")
            Df[entering.output, column] = 1.0
        elif names.count(entering.input or "") != 1:
            raise DesignError(
                f"recipe.model.faults: {site!r} enters as input {entering.input!r}; the inputs are {', '.join(names)}"
            )
        else:
            place = signals[names.index(entering.input or "")]
            unit = 1.0 if entry.units is not None else model.inputs[place].scale
            Bf[:, column] = B[:, place] * unit
    return UncertainPlant(
        A=A, Bf=Bf, Bd=np.hstack([np.eye(n), np.zeros((n, n_y))]), B=B[:, signals], C=model.C, Df=Df,
        Dd=np.hstack([np.zeros((n_y, n)), np.eye(n_y)]), D=np.zeros((n_y, len(signals))),
    )  # fmt: skip
