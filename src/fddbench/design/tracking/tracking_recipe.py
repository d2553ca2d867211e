"""The keys of a recipe that makes a `tracking_law`, and what values they take: what ``fddbench design`` runs for a law."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field

from fddbench.design.recipes.recipe import Made, Recipe, RecipeError
from fddbench.design.tracking.law_entries import HandoverEntry, Positive, TolerancesEntry, Values, WeightsEntry
from fddbench.design.tracking.making import made
from fddbench.errors import DesignError
from fddbench.flight.b747.airframe import DATA

__all__ = ["TrackingRecipe"]

_TAKES = {
    "hinf": {"weights", "fastest_rad_s", "largest_loss"},
    "lqi": {"tolerances"},
    "scheduled_lqi": {"tolerances", "dynamic_pressure_pa"},
}
"""Keys that mean something to a method; others are refused with it."""


class TrackingRecipe(Recipe):
    """How the numbers of a `tracking_law` come about.

    Attributes
    ----------
    method : {"hinf", "lqi", "scheduled_lqi"}
        H∞ synthesis (needs the extra ``synthesis``), linear-quadratic with integrals, or the latter at many points.
    altitude_m, v_tas_m_s : numbers
        One point; a grid of points for a scheduled law, of which those that cannot be flown are left out.
    weights : WeightsEntry
        Sizes of the H∞ problem.
    fastest_rad_s : float
        Faster modes of the optimal controller are replaced by their steady state [rad/s].
    largest_loss : float
        By what share the norm may rise in the reduction of the controller's order [-].
    tolerances : TolerancesEntry
        Sizes of the linear-quadratic problem.
    dynamic_pressure_pa : numbers
        Where a scheduled law has gains of its own, in rising order [Pa].
    unwind_s : float
        Time in which integrals go back while a stop holds an order [s].
    handover : HandoverEntry
        How the stabiliser takes the pitch over.
    found : mapping
        Norms, margins, settling times and coupling on the nonlinear model.
    """

    method: Literal["hinf", "lqi", "scheduled_lqi"]
    altitude_m: Values
    v_tas_m_s: Values
    weights: WeightsEntry | None = None
    fastest_rad_s: Positive | None = None
    largest_loss: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    tolerances: TolerancesEntry | None = None
    dynamic_pressure_pa: Annotated[tuple[Positive, ...], Field(min_length=2)] | None = None
    unwind_s: Positive
    handover: HandoverEntry

    def make(self) -> Made:
        """Matrices of the law, and what is known of it."""
        self.require_keys()
        gains, found = made(self)
        return Made(gains=gains, found=found)

    def require_keys(self) -> None:
        """Refuse keys that the method does not look at, a method without what it needs, and several points of one."""
        about = set().union(*_TAKES.values())
        takes = _TAKES[self.method]
        given = {key for key in about if getattr(self, key) is not None}
        if given != takes:
            raise DesignError(
                f"recipe.method {self.method} takes {', '.join(sorted(takes))} of the keys {', '.join(sorted(about))}; "
                f"got {', '.join(sorted(given)) or 'none'}"
            )
        if self.method != "scheduled_lqi" and (len(self.altitude_m), len(self.v_tas_m_s)) != (1, 1):
            raise DesignError(
                f"recipe.method {self.method} designs at one point: one altitude_m and one v_tas_m_s, each in a list"
            )
        if self.method != "scheduled_lqi":
            self._require_envelope()
        knots = self.dynamic_pressure_pa or ()
        if any(after <= before for before, after in pairwise(knots)):
            raise DesignError(f"recipe.dynamic_pressure_pa: must rise from knot to knot, got {list(knots)}")

    def _require_envelope(self) -> None:
        """Refuse a point where the aerodynamics are not known."""
        wrong = []
        for key, unit in (("altitude_m", "m"), ("v_tas_m_s", "m/s")):
            (value,), (low, high) = getattr(self, key), DATA["envelope"][key]
            if not low <= value <= high:
                wrong.append(f"recipe.{key}: must lie in {low:g} ... {high:g} [{unit}], the envelope, got {value:g}")
        if wrong:
            raise RecipeError(tuple(wrong))
