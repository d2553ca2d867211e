"""The keys of a recipe that makes a `sliding_mode_observer`, for faults of outputs or of inputs of any affine model."""

from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from fddbench.campaign.rules.model import Name, Strict
from fddbench.design.geometric.affine import Box, at
from fddbench.design.recipes.model_keys import ModelRecipe, channel_data
from fddbench.design.recipes.recipe import Made, short
from fddbench.design.recipes.sliding_mode import PairEntry, found_of
from fddbench.design.sliding_mode import (
    FaultyPlant,
    SlidingDesign,
    Weights,
    analyse,
    largest_fault,
    observer_gains,
    synthesise,
    with_sensor_faults,
)
from fddbench.detection.lpv_filter.gains import TrimEntry
from fddbench.detection.sliding_mode.gains import TwistingEntry
from fddbench.errors import DesignError, did_you_mean
from fddbench.interfaces import AffineModel, Channel, Floats

__all__ = ["SlidingModeObserverRecipe"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Sizes = Annotated[tuple[NonNegative, ...], Field(min_length=1)]
Faults = Annotated[dict[Name, str], Field(min_length=1)]
_WEAKEST = 0.05
"""Least strength of a fault anywhere in the box, beside that at its centre."""


class SizesEntry(Strict):
    """Sizes that the reconstruction is designed for.

    Attributes
    ----------
    uncertainty : numbers, one per column of `uncertainty`
    corruption : numbers, one per output, in its unit in the model
        Of suspect outputs it is no corruption, but the size in which their error is measured.
    fault : mapping of fault to number, in the unit of its site
    """

    uncertainty: Sizes
    corruption: Annotated[tuple[Positive, ...], Field(min_length=1)]
    fault: dict[Name, Positive]


class SlidingModeObserverRecipe(ModelRecipe):
    """How the numbers of a `sliding_mode_observer` come about; see `fddbench.design.sliding_mode`.

    Attributes
    ----------
    suspects : mapping of name to the signal of an output
        Sensors that may be faulty; or instead
    faults : mapping of name to the signal of an input
        Actuators that may be.
    isolates : bool
        Whether the names are sites of the benchmark.
    filter_pole_1_s : float
        A_f of every suspect output [1/s].
    corruption_pole_1_s : float
        a_f of eq (22) [1/s].
    uncertainty : rows of numbers, one row per state
        M of eq (1).
    weights : SizesEntry
    pair : PairEntry or None
        L and W in the coordinates of the canonical form; designed when left out.
    error_pole_1_s, k : float
        Of every output, k in units of its size.
    delta, injection, twisting, newton_steps, trim, confirm_s
        As in the gains.
    smooth_s : mapping of fault to float
        Lag on its estimate [s]; none where nothing is said.
    eta_0 : float
        What condition (15) leaves for everything but the fault.
    solver, relax
        As of a `sliding_mode` recipe.
    """

    suspects: Faults | None = None
    faults: Faults | None = None
    isolates: bool = True
    filter_pole_1_s: Positive | None = None
    corruption_pole_1_s: Positive
    uncertainty: Annotated[tuple[tuple[Number, ...], ...], Field(min_length=1)]
    weights: SizesEntry
    pair: PairEntry | None = None
    error_pole_1_s: Annotated[float, Field(lt=0.0, allow_inf_nan=False)]
    k: Positive
    delta: Positive
    injection: Literal["sigmoid", "unit_vector", "super_twisting"] = "sigmoid"
    twisting: TwistingEntry | None = None
    newton_steps: Annotated[int, Field(ge=1, le=20)] = 3
    smooth_s: dict[Name, NonNegative] = Field(default_factory=dict)
    confirm_s: NonNegative
    trim: TrimEntry | None = None
    eta_0: Positive = 1.0
    solver: Literal["CLARABEL", "SCS", "MOSEK"] = "CLARABEL"
    relax: Annotated[float, Field(gt=0.0, le=1.0)] = 0.02

    @model_validator(mode="after")
    def _sensors_or_actuators(self) -> Self:
        if (self.suspects is None) == (self.faults is None):
            raise ValueError("suspects or faults: the outputs that may be faulty, or the inputs, one of both")
        if (self.suspects is None) != (self.filter_pole_1_s is None):
            raise ValueError("filter_pole_1_s: suspect outputs pass a filter with this pole, faulty inputs none")
        return self

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the faults."""
        return tuple(self.suspects or self.faults or ())

    def make(self) -> Made:
        """Observer of the recipe, and what is known of it."""
        model = self.affine()
        places = self._places(model)
        plant, outputs = self._plant(model, places)
        units = self._units(model, places)
        weights = self._weights(plant, outputs, units)
        if self.pair is None:
            design = synthesise(plant, weights, solver=self.solver, relax=self.relax)
        else:
            design = analyse(plant, weights, self.pair.pair(), solver=self.solver)
        scale = np.array([self.weights.corruption[row] for row in outputs])
        strength, astray = self._strength(model, places, design, units)
        found = found_of(design) | {"largest_fault": self._largest(design, scale, units)}
        if self.faults is not None:
            found["direction_astray"] = short(astray)
        gains = self._gains(model, plant, outputs, design, units, scale)
        return Made(gains=gains | ({"strength": strength} if strength else {}), found=found)

    def _places(self, model: AffineModel) -> list[int]:
        """Row of C or column of B of every fault."""
        channels, word = (model.outputs, "output") if self.suspects is not None else (model.inputs, "input")
        signals = [channel.signal for channel in channels]
        places = []
        for name, signal in (self.suspects or self.faults or {}).items():
            if signals.count(signal) != 1:
                raise DesignError(
                    f"recipe: fault {name!r} is of {word} {signal!r}, which the model has {signals.count(signal)} times. "
                    f"{did_you_mean(signal, signals)} Its {word}s are {', '.join(filter(None, signals))}"
                )
            places.append(signals.index(signal))
        return places

    def _plant(self, model: AffineModel, places: list[int]) -> tuple[FaultyPlant, list[int]]:
        """Plant with its faults, and the rows of C in the order of its outputs."""
        box, M = Box.of(model.box.tolist() or None, len(model.A) - 1), np.array(self.uncertainty, dtype=float)
        if M.ndim != 2 or len(M) != model.A.shape[1]:
            raise DesignError(f"recipe.uncertainty needs {model.A.shape[1]} rows, one per state, got {len(M)}")
        if len(self.weights.corruption) != len(model.C):
            raise DesignError(f"recipe.weights.corruption needs {len(model.C)} numbers, one per output")
        rows = [row for row in range(len(model.C)) if row not in places]
        if self.suspects is not None:
            poles = [float(self.filter_pole_1_s or 0.0)] * len(places)
            plant = with_sensor_faults(model.A, model.C, suspects=places, filter_poles=poles, M=M, box=box)
            return plant, rows + places
        F = at(model.B, box.centre)[:, places]
        everything = list(range(len(model.C)))
        if len(places) >= len(model.C):
            raise DesignError(
                f"recipe.faults: {len(places)} faults and {len(model.C)} outputs; there must be more outputs"
            )
        return FaultyPlant(A=model.A, C=model.C, F=F, M=M, corrupted=(True,) * len(model.C), box=box), everything

    def _units(self, model: AffineModel, places: list[int]) -> Floats:
        """Unit of the site per unit in the model, of every fault."""
        channels: tuple[Channel, ...] = model.outputs if self.suspects is not None else model.inputs
        return np.array([1.0 / channels[place].scale for place in places])

    def _weights(self, plant: FaultyPlant, outputs: list[int], units: Floats) -> Weights:
        missing = [name for name in self.names if name not in self.weights.fault]
        if missing or len(self.weights.fault) > len(self.names):
            raise DesignError(
                f"recipe.weights.fault needs a size for each of {', '.join(self.names)}, and for no other"
            )
        sizes = np.array([self.weights.corruption[row] for row in outputs])
        return Weights(
            uncertainty=np.array(self.weights.uncertainty, dtype=float),
            corruption=np.where(plant.corrupted, sizes, 0.0),
            corruption_pole_1_s=self.corruption_pole_1_s,
            fault=np.abs(np.array([self.weights.fault[name] for name in self.names]) / units),
        )

    def _strength(
        self, model: AffineModel, places: list[int], design: SlidingDesign, units: Floats
    ) -> tuple[list[Any], float]:
        """Diagonal of ``W F2(rho)`` as an affine family, and the largest estimate, in sizes, of another fault of its size.

        Raises
        ------
        DesignError
            Somewhere in the box a fault has next to no effect in the direction that W looks at.
        """
        if self.faults is None:
            return [], 0.0
        told = design.pair.W @ model.C @ model.B[:, :, places]
        strength = np.stack([np.diag(member) for member in told])[:, :, np.newaxis]
        box = Box.of(model.box.tolist() or None, len(model.A) - 1)
        points = box.looked_at(box.active(model.B[:, :, places]))
        seen = np.array([at(strength, rho)[:, 0] for rho in points])
        for name, weakest in zip(self.names, seen.min(axis=0), strict=True):
            if weakest < _WEAKEST:
                raise DesignError(
                    f"recipe: fault '{name}' has {100.0 * weakest:.3g} % of its strength somewhere in the box, in the "
                    "direction that W looks at: no fixed W serves there. Make the box smaller, or design at one condition"
                )
        size = np.array([self.weights.fault[name] for name in self.names]) / np.abs(units)
        off = [at(told, rho) / at(strength, rho) * size / size[:, np.newaxis] - np.eye(len(places)) for rho in points]
        return strength.tolist(), max(float(np.abs(part).max()) for part in off)

    def _largest(self, design: SlidingDesign, scale: Floats, units: Floats) -> dict[str, float]:
        """Largest fault of each for which condition (15) holds in units of the outputs, in the unit of its site."""
        found = {}
        for j, name in enumerate(self.names):
            F2 = design.form.F2[:, [j]] / scale[:, np.newaxis]
            found[name] = short(abs(units[j]) * largest_fault(F2, np.array([self.k]), self.eta_0))
        return found

    def _gains(
        self,
        model: AffineModel,
        plant: FaultyPlant,
        outputs: list[int],
        design: SlidingDesign,
        units: Floats,
        scale: Floats,
    ) -> dict[str, Any]:
        p, q = len(plant.C), len(self.names)
        flown = observer_gains(design.form, design.pair.L, self.error_pole_1_s * np.eye(p))
        n_filtered = 0 if self.suspects is None else q
        B = np.concatenate([model.B, np.zeros((len(model.B), n_filtered, model.B.shape[2]))], axis=1)
        gains: dict[str, Any] = {
            "scheduling": self.flown_scheduling,
            "outputs": [channel_data(model.outputs[row]) for row in outputs],
            "inputs": [channel_data(channel) for channel in model.inputs],
            "filter_poles_1_s": [self.filter_pole_1_s] * n_filtered,
            "A": plant.A.tolist(),
            "B": B.tolist(),
            "G_l": flown.G_l.tolist(),
            "C": plant.C.tolist(),
            "G_n": flown.G_n.tolist(),
            "start": np.vstack([np.linalg.pinv(model.C[outputs]), np.eye(p)[p - n_filtered :]]).tolist(),
            "output_scale": scale.tolist(),
            "error_pole_1_s": [self.error_pole_1_s] * p,
            "injection": self.injection,
            "k": [self.k] * p,
            "delta": self.delta,
            "newton_steps": self.newton_steps,
            "W": design.pair.W.tolist(),
            "sites": list(self.names),
            "isolates": self.isolates,
            "unit_per_fault": units.tolist(),
            "smooth_s": [self.smooth_s.get(name, 0.0) for name in self.names],
            "thresholds": [1.0] * q,
            "confirm_s": self.confirm_s,
        }
        gains |= {} if self.twisting is None else {"twisting": self.twisting.model_dump(mode="json")}
        return gains | ({} if self.trim is None else {"trim": self.trim.model_dump(mode="json")})
