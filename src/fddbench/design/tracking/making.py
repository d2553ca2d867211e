"""From the keys of a `tracking_law` recipe to its matrices: which synthesis is called, and what it found."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from fddbench.benchmarks.b747_longitudinal.laws.law_file import INPUTS, OUTPUTS, TrackingLaw
from fddbench.design.recipes.recipe import short
from fddbench.design.tracking.aircraft import FlightPoint, linear_aircraft, linear_aircrafts
from fddbench.design.tracking.findings import findings
from fddbench.design.tracking.hinf import as_law, closed_norm, reduce_order, slow_part, synthesize
from fddbench.design.tracking.interconnection import generalised_plant
from fddbench.design.tracking.lqi import lqi_law
from fddbench.design.tracking.scheduled import envelope_points, fitted
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

if TYPE_CHECKING:
    from fddbench.design.tracking.tracking_recipe import TrackingRecipe

__all__ = ["made"]

_KN_N = np.array([[1.0], [1e3]])
"""Orders of the design, deg and kN, in those of a file, deg and N."""


def made(recipe: "TrackingRecipe") -> tuple[dict[str, Any], dict[str, Any]]:
    """Gains of a recipe and what is known of them."""
    if recipe.method == "scheduled_lqi":
        return _scheduled(recipe)
    at = FlightPoint(altitude_m=recipe.altitude_m[0], v_tas_m_s=recipe.v_tas_m_s[0])
    if recipe.method == "hinf":
        system, found = _hinf(recipe, at)
    else:
        assert recipe.tolerances is not None
        system, found = lqi_law(linear_aircraft(at), recipe.tolerances.tolerances()), {}
    law = _law(recipe, system, system.C[np.newaxis], system.D[np.newaxis])
    return _written(law), found | findings(law, at)


def _hinf(recipe: "TrackingRecipe", at: FlightPoint) -> tuple[StateSpace, dict[str, Any]]:
    """Optimum, without what is too fast to fly, then of as few states as the loss allows."""
    assert recipe.weights is not None
    assert recipe.fastest_rad_s is not None
    assert recipe.largest_loss is not None
    weights = recipe.weights.weights()
    plant = generalised_plant(linear_aircraft(at), weights)
    optimal, gamma = synthesize(plant)
    flyable = slow_part(optimal, recipe.fastest_rad_s)
    reduced = reduce_order(plant, flyable, weights.sizes, recipe.largest_loss)
    found = {
        "gamma_optimum": short(gamma),
        "gamma": short(closed_norm(plant, reduced)),
        "states": reduced.order + 2,
        "fastest_pole_rad_s": short(float(np.abs(reduced.poles()).max())),
    }
    return as_law(reduced), found


def _scheduled(recipe: "TrackingRecipe") -> tuple[dict[str, Any], dict[str, Any]]:
    """Linear-quadratic laws of the whole envelope, their gains fitted over dynamic pressure."""
    assert recipe.tolerances is not None
    knots = np.array(recipe.dynamic_pressure_pa)
    points = envelope_points(recipe.v_tas_m_s, recipe.altitude_m)
    tolerances = recipe.tolerances.tolerances()
    if not points:
        raise DesignError(
            "recipe.altitude_m: no point of its grid with v_tas_m_s can be flown; choose points of the envelope"
        )
    laws = [lqi_law(flying, tolerances) for flying in linear_aircrafts(points) if flying is not None]
    C, D = fitted(points, laws, knots)
    law = _law(recipe, laws[0], C, D, knots)
    return _written(law), {"points": len(points)} | findings(law, *points)


def _law(
    recipe: "TrackingRecipe", system: StateSpace, C: Floats, D: Floats, knots: Floats | None = None
) -> TrackingLaw:
    """A law in the units of a file; its last two states are the integrals."""
    n = system.order
    inner = np.linalg.solve(system.A[: n - 2, : n - 2], system.A[: n - 2, n - 2 :])
    steady = C.mean(axis=0)[:, n - 2 :] - C.mean(axis=0)[:, : n - 2] @ inner  # orders at rest per integral
    E = np.zeros((n, 2))
    E[n - 2 :] = np.linalg.inv(steady) / recipe.unwind_s
    return TrackingLaw(
        A=system.A,
        B=system.B,
        C=C * _KN_N,
        D=D * _KN_N,
        E=E / _KN_N.T,
        dynamic_pressure_pa=np.zeros(0) if knots is None else knots,
        handover=recipe.handover.handover(),
    )


def _written(law: TrackingLaw) -> dict[str, Any]:
    """Gains as a file holds them."""
    scheduled = bool(len(law.dynamic_pressure_pa))
    gains: dict[str, Any] = {"inputs": list(INPUTS), "outputs": list(OUTPUTS)}
    if scheduled:
        gains["dynamic_pressure_pa"] = law.dynamic_pressure_pa.tolist()
    matrices: Mapping[str, Floats] = {name: getattr(law, name) for name in "ABCDE"}
    gains |= {name: (M if scheduled or name not in "CD" else M[0]).tolist() for name, M in matrices.items()}
    way = law.handover
    return gains | {"handover": {"lead_s": way.lead_s, "lag_s": way.lag_s, "command_lag_s": way.command_lag_s}}
