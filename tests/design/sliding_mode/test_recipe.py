"""Recipes of sliding_mode designs: the shipped ones are what they give, and mistakes are said where they stand."""

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.design.recipe import cook
from fddbench.design.recipes.sliding_mode import SlidingModeRecipe
from fddbench.design.sliding_mode import Pair
from fddbench.errors import CampaignError, DesignError

PRINTED = ("sliding_mode_published", "sliding_mode_off", "sliding_mode_equation_19", "sliding_mode_without_eq38")


def shipped(name):
    return gallery.folder("detectors") / f"{name}.yaml"


def filed(name):
    return yaml.safe_load(shipped(name).read_text())


def test_the_recipe_gives_the_published_gains_and_says_how_far_they_are_from_the_formulas():
    cooked, file = cook(shipped("sliding_mode_published")), filed("sliding_mode_published")
    assert dict(cooked.gains) == file["gains"]
    misses = cooked.found["misses_printed"]
    assert misses["G_l"] < 8e-5
    assert misses["G_n"] < 5e-5
    assert misses["P_o"] < 6e-5
    assert cooked.found["gamma"] == pytest.approx(cooked.before["gamma"], rel=1e-4)
    assert cooked.found["largest_fault_deg_s"] == pytest.approx(np.rad2deg(9.0 / 0.01), rel=1e-5)


@pytest.mark.parametrize("name", PRINTED[1:])
def test_its_variants_have_the_same_pair_and_the_gains_of_their_recipe(name):
    """The pair is analysed once, above; here only what each does with it."""
    published, file = filed("sliding_mode_published"), filed(name)
    recipe = SlidingModeRecipe.model_validate(file["recipe"])
    assert recipe.pair is not None
    gains = recipe._gains(np.array(published["gains"]["linear_gain"]), recipe.pair.pair())
    assert gains == file["gains"]
    for key in ("pair", "weights", "uncertainty", "corruption_pole_1_s", "linear_gain"):
        assert file["recipe"][key] == published["recipe"][key]
    assert file["recipe"]["found"]["gamma"] == published["recipe"]["found"]["gamma"]


@pytest.mark.parametrize("name", ["sliding_mode_lmi", "sliding_mode_unit_vector", "sliding_mode_super_twisting"])
def test_the_designed_pair_is_in_its_files(best, name):
    """Those of the paper's problem, as `fddbench design` writes it; flat at the optimum, so no digits of another solver."""
    file = filed(name)
    recipe, gains = SlidingModeRecipe.model_validate(file["recipe"]), file["gains"]
    assert recipe.pair is None
    assert file["recipe"]["weights"] == filed("sliding_mode_published")["recipe"]["weights"]
    np.testing.assert_allclose(gains["l_row"], best.pair.L[0], atol=1e-3)
    np.testing.assert_allclose(gains["w"], best.pair.W[0], atol=1e-2)
    assert recipe.found["gamma"] == pytest.approx(best.certificate.gamma, rel=1e-4)
    assert recipe.gamma_of(gains) == pytest.approx(recipe.found["gamma_frozen"], rel=1e-4)
    made = recipe._gains(np.array(gains["linear_gain"]), Pair(L=np.array([gains["l_row"]]), W=np.array([gains["w"]])))
    assert made == gains


@pytest.mark.parametrize(
    ("old", "new", "kind", "message"),
    [
        ("corruption: [1.0, 60.0, 1.0, 0.0]", "corruption: [1.0, 60.0, 1.0, 2.0]", DesignError, "the last is 0, because"),
        ("uncertainty: [0.01, 0.0001]", "uncertainty: [0.01]", DesignError, "weights.uncertainty needs 2 numbers"),
        ("input_lag_s: 0.05, ", "", DesignError, "recipe.scheme: input_lag_s: Field required"),
        ("input_lag_s: 0.05, ", "input_lag_s: 0.05, delta: 1.0, ", DesignError, "recipe.scheme: delta comes of the recipe"),
        ("error_pole_1_s: [-3.1", "error_pole_1_s: [3.1", DesignError, "recipe: error_pole_1_s.0: Input should be less than 0"),
        ("  delta: 0.01\n", "  delta: 0.01\n  alfa: 1\n", CampaignError, "unknown key 'alfa'"),
        ("W: [[-0.0413, 0.0005, 0.0, 100.0]]", "W: [[-0.0413, 0.0005, 0.0, 90.0]]", DesignError, "pair: W F2 = I fails by 0.1"),
    ],
)  # fmt: skip
def test_recipes_that_give_nothing_say_why(tmp_path, old, new, kind, message):
    text = shipped("sliding_mode_published").read_text()
    recipe, gains = text.split("gains:\n")[0], "gains: {}\n"
    assert old in recipe
    path = tmp_path / "own.yaml"
    path.write_text(recipe.replace(old, new) + gains)
    with pytest.raises(kind, match=message):
        cook(path)
