"""The keys by which a recipe says for which affine model, at which flight condition, a detector is designed."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Field, Tag

from fddbench import kinds
from fddbench.design.geometric.affine import family
from fddbench.design.recipes.linearisation import linearised
from fddbench.design.recipes.recipe import Recipe
from fddbench.detection.lpv_filter.gains import ChannelEntry
from fddbench.errors import DesignError, FddbenchError, did_you_mean
from fddbench.interfaces import AffineModel, Channel

__all__ = ["Family", "ModelRecipe", "as_family", "channel_data"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Matrix = Annotated[tuple[Annotated[tuple[Number, ...], Field(min_length=1)], ...], Field(min_length=1)]
Family = Annotated[tuple[Matrix, ...], Field(min_length=1)]


class ModelRecipe(Recipe):
    """What a recipe says of the model.

    Attributes
    ----------
    scheduling : str or None
        Registered, or ``mine.py:Mine`` beside the design; None: the model has no parameters.
    model : str, or mapping of str to matrices
        Name of a model of the scheduling, or A, B and C: matrices, or lists of them, the constant one first.
    box : rows [low, high], one per parameter
        In place of that of the scheduling's model.
    outputs, inputs : channels
        What y and u are on the bus; those of the scheduling's model when left out.
    at : mapping of signal to number
        Flight condition; the model is linearised there, and the detector has no parameters.
    """

    scheduling: str | None = None
    model: Annotated[
        Annotated[str, Tag("name")] | Annotated[dict[str, Family], Tag("matrices")],
        Discriminator(lambda given: "matrices" if isinstance(given, dict) else "name"),
    ]
    box: Matrix | None = None
    outputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)] | None = None
    inputs: tuple[ChannelEntry, ...] | None = None
    at: dict[str, Number] | None = None

    @classmethod
    def spelled_out(cls, written: Mapping[str, Any]) -> dict[str, Any]:
        """The recipe with the matrices of its model as families of one."""
        whole = dict(written)
        if isinstance(whole.get("model"), dict):
            whole["model"] = {name: as_family(value) for name, value in whole["model"].items()}
        return whole

    def affine(self) -> AffineModel:
        """The model that the detector is designed for; one of constant matrices with `at`."""
        scheduling = None if self.scheduling is None else self._scheduling()
        named = self._named(scheduling) if isinstance(self.model, str) else self._own(self.model, scheduling)
        if self.at is None:
            return named
        if scheduling is None:
            raise DesignError("recipe.at: it linearises a model that has scheduling parameters; this one has none")
        return linearised(named, scheduling, self.at)

    @property
    def flown_scheduling(self) -> str | None:
        """Scheduling of the detector: none for one that was designed at a flight condition."""
        return None if self.at is not None else self.scheduling

    def _scheduling(self) -> Any:
        assert self.scheduling is not None
        try:
            return kinds.find("scheduling", self.scheduling, beside=self.beside).member()
        except FddbenchError as error:
            raise DesignError(f"recipe.scheduling: {error}") from error

    def _named(self, scheduling: Any) -> AffineModel:
        models = getattr(scheduling, "models", {})
        if self.model not in models:
            raise DesignError(
                f"recipe.model: scheduling {self.scheduling!r} has no model {self.model!r}. "
                f"{did_you_mean(str(self.model), models)} It has: {', '.join(models) or 'none'}; or give A, B and C"
            )
        found: AffineModel = models[self.model]()
        idle = [key for key in ("outputs", "inputs", "box") if getattr(self, key) is not None]
        if idle:
            raise DesignError(f"recipe.{idle[0]}: model {self.model!r} brings its own; take the key away")
        return found

    def _own(self, given: Mapping[str, Any], scheduling: Any) -> AffineModel:
        if set(given) != {"A", "B", "C"} or self.outputs is None or self.inputs is None:
            raise DesignError(
                "recipe.model: a model of one's own is model: {A, B, C} with outputs and inputs, a channel for each row of C "
                f"and column of B; got {', '.join(given)}"
            )
        n_rho = 0 if scheduling is None else len(scheduling.parameters)
        A = family("recipe.model.A", _lone(given["A"]), (None, None), n_rho)
        B = family("recipe.model.B", _lone(given["B"]), (A.shape[1], len(self.inputs)), n_rho)
        C = family("recipe.model.C", _lone(given["C"]), (len(self.outputs), A.shape[1]), 0)
        box = np.array(self.box if self.box is not None else getattr(scheduling, "box", np.zeros((0, 2))), dtype=float)
        outputs, inputs = (tuple(map(_channel, entries)) for entries in (self.outputs, self.inputs))
        return AffineModel(A=A, B=B, C=C[0], outputs=outputs, inputs=inputs, box=box.reshape(-1, 2))


def as_family(value: Any) -> Any:
    """A matrix as a family of one; anything else as it is."""
    flat = isinstance(value, list) and value and isinstance(value[0], list) and value[0]
    return [value] if flat and not isinstance(value[0][0], list) else value


def _lone(given: Family) -> Any:
    """A family of one as the matrix that it is, which any number of parameters may leave alone."""
    return given[0] if len(given) == 1 else given


def _channel(entry: ChannelEntry) -> Channel:
    if entry.signal is None:
        return Channel(scale=float(entry.constant or 0.0))
    return Channel(
        signal=entry.signal,
        scale=entry.scale,
        offset=entry.offset,
        row=entry.row,
        held=entry.held,
        times=entry.times or "",
    )


def channel_data(channel: Channel) -> dict[str, Any]:
    """A channel as a design file writes it, without what is left out."""
    if not channel.signal:
        return {"constant": channel.scale}
    written: dict[str, Any] = {"signal": channel.signal}
    written |= {"scale": channel.scale} if channel.scale != 1.0 else {}
    written |= {"offset": channel.offset} if channel.offset else {}
    written |= {"row": channel.row} if channel.row is not None else {}
    written |= {"times": channel.times} if channel.times else {}
    return written | ({"held": True} if channel.held else {})
