"""The keys of a recipe that makes a `sliding_mode` design, and the observer that they give."""

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, Literal

import numpy as np
import yaml
from pydantic import Field, ValidationError

from fddbench.campaign.rules.model import Strict
from fddbench.design.geometric.affine import Box
from fddbench.design.recipes.recipe import Made, Recipe, RecipeError, short
from fddbench.design.sliding_mode import (
    FaultyPlant,
    Pair,
    SlidingDesign,
    Weights,
    analyse,
    frozen_gain,
    largest_fault,
    observer_gains,
    synthesise,
    with_sensor_faults,
)
from fddbench.detection.sliding_mode.gains import Number, Positive, SlidingModeGains
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["PairEntry", "SlidingModeRecipe", "WeightsEntry", "found_of"]

Row = Annotated[tuple[Number, ...], Field(min_length=1)]
Sizes = Annotated[tuple[Annotated[float, Field(ge=0.0, allow_inf_nan=False)], ...], Field(min_length=1)]
_YAW_RATE = 3
"""Row of the suspect output in [phi, V_y, p, r]."""


class PairEntry(Strict):
    """A pair that is given instead of designed.

    Attributes
    ----------
    L, W : rows of numbers
        L of eq (20) and W of eq (21), in the order of the outputs, filtered ones last.
    """

    L: Annotated[tuple[Row, ...], Field(min_length=1)]
    W: Annotated[tuple[Row, ...], Field(min_length=1)]

    def pair(self) -> Pair:
        """As arrays."""
        return Pair(L=np.array(self.L, dtype=float), W=np.array(self.W, dtype=float))


class WeightsEntry(Strict):
    """Sizes that the reconstruction is designed for, eq (23).

    Attributes
    ----------
    uncertainty : numbers, one per column of `uncertainty`
        δ1.
    corruption : numbers, one per output
        δ2, in the unit of the output; filtered outputs have 0.
    """

    uncertainty: Sizes
    corruption: Sizes


class SlidingModeRecipe(Recipe):
    """How the gains of a `sliding_mode` design come about: steps 1 to 12 of section 4.1 for the published lateral model.

    Attributes
    ----------
    pair : PairEntry or None
        L and W; designed when left out.
    filter_pole_1_s : float
        A_f [1/s].
    corruption_pole_1_s : float
        a_f [1/s].
    uncertainty : rows of numbers, one row per state [phi, V_y, p, r]
        M_p of eq (1).
    weights : WeightsEntry
    box : rows [low, high], one per parameter
        Normalised mass, X_cg, altitude, airspeed; -1 to 1 when left out.
    linear_gain : {"computed", "printed"}
        From the pair, or as the appendix of the paper prints it, to four decimals.
    switched_off : bool
        W = 0 in the gains: what the scheme does without its observer.
    gn_convention, error_pole_1_s, k, delta
        As in the gains.
    eta_0 : float
        What condition (15) leaves for everything but the fault.
    solver : {"CLARABEL", "SCS", "MOSEK"}
    relax : float
        How much larger than the optimum γ may be [-].
    scheme : mapping
        All other gains, copied.
    """

    pair: PairEntry | None = None
    filter_pole_1_s: Positive
    corruption_pole_1_s: Positive
    uncertainty: Annotated[tuple[Row, ...], Field(min_length=4, max_length=4)]
    weights: WeightsEntry
    box: Annotated[tuple[tuple[Number, Number], ...], Field(min_length=4, max_length=4)] | None = None
    linear_gain: Literal["computed", "printed"] = "computed"
    switched_off: bool = False
    gn_convention: Literal["published", "equation_19"] = "equation_19"
    error_pole_1_s: Annotated[tuple[Number, ...], Field(min_length=4, max_length=4)]
    k: Annotated[tuple[Positive, ...], Field(min_length=4, max_length=4)]
    delta: Positive
    eta_0: Positive = 1.0
    solver: Literal["CLARABEL", "SCS", "MOSEK"] = "CLARABEL"
    relax: Annotated[float, Field(gt=0.0, le=1.0)] = 0.02
    scheme: dict[str, Any]

    def make(self) -> Made:
        """Observer of the recipe, and what is known of it."""
        nothing = Pair(L=np.zeros((1, 4)), W=np.zeros((1, 4)))
        self._gains(np.zeros((5, 5, 4)), nothing)  # what the kind refuses is said before anything is designed
        plant, weights = self._plant(self.filter_pole_1_s), self._weights()
        if self.pair is None:
            design = synthesise(plant, weights, solver=self.solver, relax=self.relax)
        else:
            design = analyse(plant, weights, self.pair.pair(), solver=self.solver)
        flown = observer_gains(design.form, design.pair.L, np.diag(self.error_pole_1_s))
        printed = self.linear_gain == "printed"
        gains = self._gains(np.array(_printed()["Gl"], dtype=float) if printed else flown.G_l, design.pair)
        found = found_of(design) | self._largest(design)
        if printed:
            found["misses_printed"] = self._misses(flown.G_l, flown.P_o, design.pair.L)
        return Made(gains=gains, found=found)

    def gamma_of(self, gains: Mapping[str, Any]) -> float | None:
        """Largest frozen γ over the vertices that the pair of other gains has with the weights of this recipe."""
        pair = Pair(L=np.array([gains["l_row"]], dtype=float), W=np.array([gains["w"]], dtype=float))
        return frozen_gain(self._plant(gains["filter_pole_1_s"]), self._weights(), pair)

    def _plant(self, filter_pole_1_s: float) -> FaultyPlant:
        A = lateral_lpv().tables["A"][..., 0]
        return with_sensor_faults(
            A, np.eye(4), suspects=[_YAW_RATE], filter_poles=[filter_pole_1_s],
            M=np.array(self.uncertainty, dtype=float), box=Box.of(self.box or [(-1.0, 1.0)] * 4, 4),
        )  # fmt: skip

    def _weights(self) -> Weights:
        corruption = np.array(self.weights.corruption, dtype=float)
        if len(corruption) != 4 or corruption[_YAW_RATE] != 0.0:
            raise RecipeError(
                (
                    "recipe.weights.corruption needs four numbers, for phi, V_y, p and z_f; the last is 0, because what "
                    f"corrupts the yaw rate cannot be told from its fault. Got {corruption.tolist()}",
                )
            )
        return Weights(
            uncertainty=np.array(self.weights.uncertainty, dtype=float),
            corruption=corruption,
            corruption_pole_1_s=self.corruption_pole_1_s,
            fault=np.ones(1),
        )

    def _gains(self, linear: Floats, pair: Pair) -> dict[str, Any]:
        """Gains of the kind; refuses what the kind would refuse, by its key."""
        own: dict[str, Any] = {
            "filter_pole_1_s": self.filter_pole_1_s,
            "linear_gain": linear.tolist(),
            "l_row": pair.L[0].tolist(),
            "gn_convention": self.gn_convention,
            "error_pole_1_s": list(self.error_pole_1_s),
            "k": list(self.k),
            "delta": self.delta,
            "w": [0.0] * 4 if self.switched_off else pair.W[0].tolist(),
        }
        twice = sorted(own.keys() & self.scheme.keys())
        if twice:
            raise RecipeError((f"recipe.scheme: {', '.join(twice)} comes of the recipe itself; take it away there",))
        try:
            SlidingModeGains.model_validate(own | dict(self.scheme))
        except ValidationError as error:
            raise RecipeError(
                tuple(
                    f"recipe{'' if e['loc'] and e['loc'][0] in own else '.scheme'}: {'.'.join(map(str, e['loc']))}: {e['msg']}"
                    for e in error.errors()
                )
            ) from error
        return own | dict(self.scheme)

    def _largest(self, design: SlidingDesign) -> dict[str, float]:
        """Largest fault by condition (15); of the super-twisting algorithm its fastest, ``A_f |f'| < k2`` of z_f."""
        twisting = self.scheme.get("twisting")
        if twisting is not None:
            return {"fastest_fault_deg_s2": short(DEG_PER_RAD * twisting["k2"][-1] / self.filter_pole_1_s)}
        fault = largest_fault(design.form.F2, np.array(self.k), self.eta_0)
        return {"largest_fault_deg_s": short(DEG_PER_RAD * fault)}

    def _misses(self, G_l: Floats, P_o: Floats, L: Floats) -> dict[str, float]:
        """Largest distances of the printed gains from what the formulas give with this pair."""
        printed = {name: np.array(table, dtype=float) for name, table in _printed().items()}
        return {
            "G_l": short(float(np.abs(G_l - printed["Gl"]).max())),
            "G_n": short(
                float(np.abs(printed["Gn"][_YAW_RATE] + (2.0 if self.gn_convention == "published" else 1.0) * L).max())
            ),
            "P_o": short(float(np.abs(np.diag(P_o) - printed["Po"]).max())),
        }


def found_of(design: SlidingDesign) -> dict[str, Any]:
    """What is known of a pair, as a design file writes it."""
    proof = design.certificate
    return {
        "gamma": short(proof.gamma),
        "gamma_optimum": short(design.optimum),
        "gamma_frozen": short(proof.frozen),
        "gamma_lower_bound": short(design.bound),
        "certificate": {
            "relative_margin": short(proof.margin),
            "largest_inside": short(proof.frozen_inside),
            "slowest_pole_1_s": short(proof.slowest_pole_1_s),
        },
    }


@cache
def _printed() -> Mapping[str, Any]:
    """Gl(rho), Gn and the diagonal of P_o as the paper prints them."""
    text = files("fddbench.design.sliding_mode").joinpath("data/addsafe_gains.yaml").read_text(encoding="utf-8")
    printed: Mapping[str, Any] = yaml.safe_load(text)
    return printed
