"""The shipped designs are what their recipes give: the same γ, certificates included; never compare matrices."""

import pytest
import yaml

from fddbench import gallery
from fddbench.design.recipe import cook
from fddbench.designs.design import read_design
from fddbench.errors import CampaignError, DesignError

GAMMAS = {"hinf_identity": 0.33400, "hinf_start": 0.6345, "hinf_final": 0.4636, "hinf_optimum": 0.33400}


def shipped(name):
    return gallery.folder("detectors") / f"{name}.yaml"


@pytest.mark.parametrize(("name", "gamma"), GAMMAS.items())
def test_the_recipe_gives_the_gamma_of_the_file(name, gamma):
    cooked = cook(shipped(name))
    assert cooked.found["gamma_optimum"] == pytest.approx(gamma, abs=1e-4)
    assert cooked.found["gamma"] == pytest.approx(1.02 * cooked.found["gamma_optimum"], rel=1e-5)
    assert cooked.found["gamma"] == pytest.approx(cooked.before["gamma"], rel=1e-4)
    assert cooked.found["gamma_lower_bound"] <= cooked.found["gamma_optimum"]
    assert cooked.found["certificate"]["smallest_Pc"] > 0.0
    assert cooked.found["certificate"]["largest_robust"] < 0.0
    assert read_design(shipped(name)).gamma == cooked.before["gamma"]


def test_the_exact_inverse_promises_nothing(tmp_path):
    cooked = cook(shipped("jet_exact_inverse"))
    assert cooked.found["worst_norm_sampled"] > 0.334001
    assert read_design(shipped("jet_exact_inverse")).gamma is None
    path = tmp_path / "again.yaml"
    path.write_text(cooked.text)
    again = read_design(path)
    assert again.tuned_on == ()
    assert again.gains.thresholds == (1.0, 1.0, 1.0)
    assert yaml.safe_load(cooked.text)["recipe"]["method"] == "exact_inverse"


PLANT = """\
kind: hinf_filter
source: mine
tuned_on: null
recipe:
  plant: {A: [[-1.0]], Bf: [[0.5]], Bd: [[0.1]], B: [[1.0]], C: [[1.0]], Df: [[1.0]], Dd: [[0.1]], D: [[0.0]]}
  method: fixed_reference
  window_s: 1.0
  confirm_s: 0.0
gains: {}
"""


def test_a_plant_of_ones_own(tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(PLANT)
    assert 0.0 < cook(path).found["gamma"] < 1.0


@pytest.mark.parametrize(
    ("old", "new", "kind", "message"),
    [
        ("method: fixed_reference", "method: guess", CampaignError, "own.yaml:6:11: must be 'fixed_reference'"),
        ("window_s: 1.0", "windows: 1.0", CampaignError, "own.yaml:7:3: unknown key 'windows'"),
        ("{A: [[-1.0]], ", "{AA: [[-1.0]], ", DesignError, "no matrix of a plant is called"),
        ("Df: [[1.0]]", "Df: [[0.0]]", DesignError, "Df of the plant has rank 0"),
        ("  confirm_s: 0.0", "  confirm_s: 0.0\n  reference: {a: [-1.0], d: [1.0]}", DesignError, "d alone"),
    ],
)
def test_recipes_that_give_nothing_say_why(tmp_path, old, new, kind, message):
    path = tmp_path / "own.yaml"
    path.write_text(PLANT.replace(old, new))
    with pytest.raises(kind, match=message):
        cook(path)


def test_a_design_without_a_recipe_is_no_recipe():
    with pytest.raises(DesignError, match="has no recipe"):
        cook(shipped("voting_monitor"))
