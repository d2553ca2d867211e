"""From the keys of a `hinf_filter` recipe to its filter: which synthesis is called, and what it found."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fddbench import kinds
from fddbench.design.bias_filter import bias_filter
from fddbench.design.linearised import Freedom
from fddbench.design.nominal_residuals import nominal_reference, observer_bank
from fddbench.design.problem import Filter, augment, close
from fddbench.design.proof import Proven
from fddbench.design.recipes.hinf_entries import plant_of
from fddbench.design.recipes.hinf_model import model_plants
from fddbench.design.recipes.recipe import short
from fddbench.design.reference_search import optimize_fixed_poles, optimize_reference
from fddbench.design.robust_hinf import Design, synthesize
from fddbench.design.uncertainty import NormBounded, Polytope, Uncertainty, blocks_of
from fddbench.design.weights import Weights
from fddbench.design.worst_case import worst_delta
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant

if TYPE_CHECKING:
    from fddbench.design.recipes.hinf_filter import HinfRecipe

__all__ = ["gains_of", "made", "named_plant"]


def made(recipe: "HinfRecipe") -> tuple[Filter, dict[str, Any], dict[str, Any]]:
    """Filter of a recipe, what is known of it, and what its file says of signals (nothing for a plant with y and u)."""
    if recipe.model is None:
        return *_made(recipe, named_plant(recipe.plant or ""), NormBounded()), {}
    plants = model_plants(recipe.model, recipe.beside)
    several = Polytope(plants.vertices) if len(plants.vertices) > 1 else NormBounded()
    filter_, found = _made(recipe, plants.vertices[0], several)
    return filter_, {"vertices": len(plants.vertices)} | found, plants.keys


def _made(recipe: "HinfRecipe", plant: UncertainPlant, set_: Uncertainty) -> tuple[Filter, dict[str, Any]]:
    """Filter for a plant, which is one of a set where the recipe does not say of which."""
    if recipe.method in ("exact_inverse", "unknown_input_observer"):
        filter_ = _exact_inverse(plant) if recipe.method == "exact_inverse" else observer_bank(plant)
        identity = StateSpace.gain(np.eye(plant.inputs[0]))
        worst = worst_delta(close(augment(plant, identity), identity, filter_), blocks_of(NormBounded(), plant))
        return filter_, {"worst_norm_sampled": short(worst.norm)}
    if recipe.method == "kalman":
        filter_ = bias_filter(plant, recipe.weights.weights(plant) if recipe.weights else Weights())
        return filter_, {"slowest_pole_1_s": short(float(np.linalg.eigvals(filter_.Ak).real.max()))}
    task = _Task(
        uncertainty=recipe.uncertainty.uncertainty(plant) if recipe.uncertainty else set_,
        weights=recipe.weights.weights(plant) if recipe.weights else Weights(),
        options={"solver": recipe.solver, "relax": recipe.relax},
    )
    if recipe.method == "fixed_poles":
        design = optimize_fixed_poles(plant, recipe.fixed_poles or (), task.uncertainty, task.weights, **task.options)
        return _flown(design).filter, _findings(design) | _found_reference(design)
    if recipe.method == "two_step":
        design = synthesize(plant, nominal_reference(plant), task.uncertainty, task.weights, **task.options)
        return _flown(design).filter, _findings(design) | _found_reference(design)
    reference = recipe.reference.system() if recipe.reference else StateSpace.gain(np.eye(plant.inputs[0]))
    if recipe.method == "fixed_reference":
        design = synthesize(plant, reference, task.uncertainty, task.weights, **task.options)
        return _flown(design).filter, _findings(design)
    freedom = Freedom.triangular(reference)
    search = optimize_reference(plant, reference, task.uncertainty, task.weights, freedom=freedom, **task.options)
    steps = {"gamma_by_iteration": [short(step.gamma) for step in search.iterations]}
    return _flown(search.design).filter, _findings(search.design) | _found_reference(search.design) | steps


@dataclass(frozen=True)
class _Task:
    """What all methods but the inverse are told."""

    uncertainty: Uncertainty
    weights: Weights
    options: Mapping[str, Any]


def _found_reference(design: Design) -> dict[str, Any]:
    """The reference that was chosen."""
    R = design.reference
    names = "ABCD" if R.order else "D"
    return {"reference": {name: [[short(x) for x in row] for row in getattr(R, name).tolist()] for name in names}}


def _flown(design: Design) -> Proven:
    """The filter of the second step, else the optimum."""
    return design.moderate or design


def _findings(design: Design) -> dict[str, Any]:
    """γ of the filter that flies with its certificate, and how far it is from the best."""
    flown = _flown(design)
    proof = flown.certificate.require()
    return {
        "gamma": short(flown.gamma),
        "gamma_optimum": short(design.gamma),
        "gamma_lower_bound": short(design.lower_bound),
        "certificate": {
            "smallest_Pc": short(proof.smallest_Pc),
            "largest_robust": short(proof.largest_robust),
            "largest_sampled": short(proof.largest_sampled),
        },
    }


def named_plant(given: str | Mapping[str, Any]) -> UncertainPlant:
    """Plant of a recipe: its own matrices, or those of a benchmark; refuses a benchmark that has none."""
    if not isinstance(given, str):
        return plant_of(given, "recipe.plant")
    matrices = getattr(kinds.load("benchmark", given), "matrices", None)
    if matrices is None:
        raise DesignError(f"benchmark {given!r} offers no matrices to design for; give them under recipe.plant")
    return UncertainPlant(**matrices)


def _exact_inverse(plant: UncertainPlant) -> Filter:
    """Observer driven by its own residual ``r = Df⁻¹ (y - C x̂ - D u)``: the faults themselves, if plant and model agree."""
    if plant.Df.shape[0] != plant.Df.shape[1] or np.linalg.matrix_rank(plant.Df) < len(plant.Df):
        raise DesignError(f"an exact inverse needs a regular square Df, this one is {plant.Df.shape}")
    back = np.asarray(np.linalg.inv(plant.Df), dtype=np.float64)
    return Filter(
        Ak=plant.A - plant.Bf @ back @ plant.C, Bky=plant.Bf @ back, Bku=plant.B - plant.Bf @ back @ plant.D,
        Ck=-back @ plant.C, Dky=back, Dku=-back @ plant.D,
    )  # fmt: skip


def gains_of(filter_: Filter, recipe: "HinfRecipe") -> dict[str, Any]:
    """Gains of a `hinf_filter` with thresholds that nobody has tuned yet."""
    if not len(filter_.Ak):
        filter_ = _with_a_state(filter_)
    names = {"A": "Ak", "B_y": "Bky", "B_u": "Bku", "C": "Ck", "D_y": "Dky", "D_u": "Dku"}
    gains: dict[str, Any] = {name: getattr(filter_, own).tolist() for name, own in names.items()}
    gains |= {"window_s": recipe.window_s, "confirm_s": recipe.confirm_s, "thresholds": [1.0] * len(filter_.Ck)}
    gains |= {"about_first": True} if recipe.about_first else {}
    gains |= {} if recipe.sensors is None else {"sensors": recipe.sensors.model_dump(mode="json")}
    return gains | ({"estimates_faults": True} if _speaks_plainly(recipe) else {})


def _with_a_state(filter_: Filter) -> Filter:
    """A static filter with a state that nothing moves and nobody sees: a file cannot say matrices without rows."""
    n_r, n_y, n_u = len(filter_.Dky), filter_.Dky.shape[1], filter_.Dku.shape[1]
    idle = {"Ak": -np.eye(1), "Bky": np.zeros((1, n_y)), "Bku": np.zeros((1, n_u)), "Ck": np.zeros((n_r, 1))}
    return replace(filter_, **idle)


def _speaks_plainly(recipe: "HinfRecipe") -> bool:
    """Whether residual i is made to be fault i itself: an inverse, a nominal observer, a filter of biases, or T_ref = I."""
    if recipe.method in ("exact_inverse", "unknown_input_observer", "kalman"):
        return True
    reference = recipe.reference.system() if recipe.reference else None
    identity = reference is None or (
        not reference.order and bool(np.array_equal(reference.D, np.eye(len(reference.D))))
    )
    return identity and recipe.method == "fixed_reference"
