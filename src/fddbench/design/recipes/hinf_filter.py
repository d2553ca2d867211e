"""The keys of a recipe that makes a `hinf_filter`, and what values they take."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from fddbench.design.recipes.hinf_entries import (
    Matrix,
    ReferenceEntry,
    Row,
    UncertaintyEntry,
    WeightsEntry,
    spelled_out,
)
from fddbench.design.recipes.hinf_making import gains_of, made
from fddbench.design.recipes.hinf_model import ModelEntry
from fddbench.design.recipes.recipe import Made, Recipe
from fddbench.detection.lpv_filter.gains import SensorsEntry
from fddbench.errors import DesignError

__all__ = ["HinfRecipe"]

_SECOND_STEP = 0.02
_TAKES = {
    "fixed_reference": {"reference", "uncertainty", "weights", "solver", "relax"},
    "free_reference": {"reference", "uncertainty", "weights", "solver", "relax"},
    "fixed_poles": {"fixed_poles", "uncertainty", "weights", "solver", "relax"},
    "two_step": {"uncertainty", "weights", "solver", "relax"},
    "exact_inverse": set(),
    "unknown_input_observer": set(),
    "kalman": {"weights"},
}
"""Keys that mean something to a method; others are refused with it."""


class HinfRecipe(Recipe):
    """How the numbers of a `hinf_filter` design come about.

    Attributes
    ----------
    plant : str, or mapping of str to matrix
        A benchmark with `matrices`, or the fields of `fddbench.systems.UncertainPlant` themselves.
    model : ModelEntry
        In place of a plant the affine model of a scheduling: its corners or flight conditions are a polytope (Lemma 6).
    method : {"fixed_reference", "free_reference", "fixed_poles", "two_step", "exact_inverse", ...}
        `synthesize`, `optimize_reference` (Algorithm 1 from this reference), `optimize_fixed_poles`, `synthesize` for the
        `nominal_reference`. For the plant as if it were known: ``r = Df⁻¹ (y - C x̂ - D u)``, ``unknown_input_observer`` for
        `observer_bank`, ``kalman`` for `bias_filter`.
    reference : ReferenceEntry
        The identity when left out. What is free in Algorithm 1 is its diagonal, or its triangle if it has one.
    fixed_poles : numbers, one per fault
        Poles of the diagonal reference [rad/s].
    uncertainty : UncertaintyEntry
        What is not known about the plant; norm-bounded when left out.
    weights : WeightsEntry
        Sizes of faults, disturbances and inputs; one when left out.
    solver : {"CLARABEL", "SCS", "MOSEK"}
        For the linear matrix inequalities.
    relax : float
        How much larger than the optimum γ of the filter that flies may be [-].
    window_s, confirm_s : float
        Evaluation of the residuals, copied into the gains.
    about_first : bool
        Copied into the gains.
    sensors : SensorsEntry
        Decision among redundant sensors, copied into the gains.
    found : mapping
        γ of this filter, the optimum, the lower bound, margins of the certificate.
    """

    plant: str | dict[str, Matrix] | None = None
    model: ModelEntry | None = None
    method: Literal[
        "fixed_reference",
        "free_reference",
        "fixed_poles",
        "two_step",
        "exact_inverse",
        "unknown_input_observer",
        "kalman",
    ]
    reference: ReferenceEntry | None = None
    fixed_poles: Row | None = None
    uncertainty: UncertaintyEntry | None = None
    weights: WeightsEntry | None = None
    solver: Literal["CLARABEL", "SCS", "MOSEK"] = "CLARABEL"
    relax: Annotated[float, Field(gt=0.0, le=1.0)] = _SECOND_STEP
    window_s: Annotated[float, Field(gt=0.0)]
    confirm_s: Annotated[float, Field(ge=0.0)]
    about_first: bool = False
    sensors: SensorsEntry | None = None

    @classmethod
    def spelled_out(cls, written: Mapping[str, Any]) -> dict[str, Any]:
        """The recipe with its short forms as blocks."""
        return spelled_out(written)

    def make(self) -> Made:
        """Filter of the recipe, and what is known of it."""
        self.require_keys()
        filter_, found, signals = made(self)
        return Made(gains=signals | gains_of(filter_, self), found=found)

    def require_keys(self) -> None:
        """Refuse keys that the method does not look at, and a method without what it needs."""
        if (self.plant is None) == (self.model is None):
            raise DesignError("recipe has a plant or a model, one of both")
        if self.model is not None and self.uncertainty is not None:
            raise DesignError(
                "recipe.uncertainty: the corners or conditions of recipe.model are the set of plants; take it away"
            )
        about = {"reference", "fixed_poles", "uncertainty", "weights", "solver", "relax"}
        idle = (about & self.model_fields_set) - _TAKES[self.method]
        if idle:
            takes = ", ".join(sorted(_TAKES[self.method])) or "none of these keys"
            raise DesignError(
                f"recipe.method {self.method} does not look at {', '.join(sorted(idle))}; it takes {takes}. "
                "Take the key away, or choose another method"
            )
        if self.method == "fixed_poles" and self.fixed_poles is None:
            raise DesignError(
                "recipe.method fixed_poles needs fixed_poles: [a_1, ...], one negative pole per fault [rad/s]"
            )
