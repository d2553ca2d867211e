"""The shipped designs are what their recipes give: the same γ, certificates included; never compare matrices."""

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.design.linearised import Freedom
from fddbench.design.norms import hminus_index
from fddbench.design.recipe import cook
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import Polytope, RepeatedReal, Structured
from fddbench.design.weights import Weights
from fddbench.designs.design import read_design
from fddbench.errors import CampaignError, DesignError
from fddbench.systems import StateSpace, UncertainPlant

GAMMAS = {
    "hinf_identity": 0.33400, "hinf_start": 0.6345, "hinf_final": 0.4636, "hinf_optimum": 0.33400,
    "hinf_structured": 0.31810, "hinf_polytope": 0.32746, "hinf_triangular": 0.33400, "hinf_fixed_poles": 0.33400,
    "hinf_weighted": 0.48628,
}  # fmt: skip


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
        (
            "{A: [[-1.0]], ",
            "{AA: [[-1.0]], ",
            DesignError,
            "recipe.plant: no matrix of a plant is called AA; known: A, Bf",
        ),
        ("Df: [[1.0]]", "Df: [[0.0]]", DesignError, "Df of the plant has rank 0"),
        ("  confirm_s: 0.0", "  confirm_s: 0.0\n  reference: {a: [-1.0], d: [1.0]}", DesignError, "d alone"),
    ],
)
def test_recipes_that_give_nothing_say_why(tmp_path, old, new, kind, message):
    path = tmp_path / "own.yaml"
    path.write_text(PLANT.replace(old, new))
    with pytest.raises(kind, match=message):
        cook(path)


UNCERTAIN = PLANT.replace("D: [[0.0]]}", "D: [[0.0]], FA: [[0.2]], FC: [[0.1]], EA: [[0.5]], Ef: [[0.1]]}")


def cooked_with(tmp_path, keys: str, text: str = UNCERTAIN):
    path = tmp_path / "own.yaml"
    path.write_text(text.replace("  window_s", keys + "  window_s"))
    return cook(path)


def test_recipes_reach_what_python_reaches(tmp_path):
    recipe = yaml.safe_load(UNCERTAIN)["recipe"]
    plant = UncertainPlant(**{name: np.array(rows) for name, rows in recipe["plant"].items()})
    one = StateSpace.gain(np.eye(1))
    lag = StateSpace(np.array([[-2.0]]), np.eye(1), np.array([[0.5]]), np.eye(1))
    slow = StateSpace.diagonal([-0.5], [0.5], [2.0], [0.1])
    pairs = [
        ("  uncertainty: norm_bounded\n", synthesize(plant, one)),
        ("  uncertainty: {structured: [{repeated_real: 1}]}\n", synthesize(plant, one, Structured((RepeatedReal(1),)))),
        ("  uncertainty: {structured: [{full: [1, 1]}]}\n  solver: SCS\n", synthesize(plant, one)),
        (
            "  uncertainty: {polytope: [{delta: [[1.0]]}, {delta: [[-1.0]]}]}\n",
            synthesize(plant, one, Polytope((plant.at(np.eye(1)), plant.at(-np.eye(1))))),
        ),
        ("  weights: {W_f: 3.0, W_d: [2.0]}\n", synthesize(plant, one, weights=Weights(W_f=[[3.0]], W_d=[[2.0]]))),
        (
            "  weights: {W_u: {a: [-0.5], b: [0.5], c: [2.0], d: [0.1]}}\n",
            synthesize(plant, one, weights=Weights(W_u=slow)),
        ),
        ("  reference: {A: [[-2.0]], B: [[1.0]], C: [[0.5]], D: [[1.0]]}\n", synthesize(plant, lag)),
        ("  reference: {D: [[2.0]]}\n  relax: 0.1\n", synthesize(plant, StateSpace.gain(2.0), relax=0.1)),
    ]
    for keys, expected in pairs:
        found = cooked_with(tmp_path, keys).found
        assert found["gamma_optimum"] == pytest.approx(expected.gamma, rel=1e-4), keys
        assert found["gamma"] == pytest.approx(expected.moderate.gamma, rel=1e-4), keys


def test_a_polytope_of_plants_of_ones_own(tmp_path):
    vertices = ", ".join(
        f"{{A: [[{a}]], Bf: [[0.5]], Bd: [[0.1]], B: [[1.0]], C: [[1.0]], Df: [[1.0]], Dd: [[0.1]], D: [[0.0]]}}"
        for a in (-1.0, -1.5)
    )
    found = cooked_with(tmp_path, f"  uncertainty: {{polytope: [{vertices}]}}\n", PLANT).found
    assert found["gamma_lower_bound"] <= found["gamma_optimum"] < 1.0


def test_what_is_free_in_a_triangle():
    lower = StateSpace.gain([[1.0, 0.0], [0.2, 1.0]])
    assert Freedom.triangular(lower).D.tolist() == [[True, False], [True, True]]
    assert Freedom.triangular(StateSpace.gain(np.eye(2))).D.tolist() == [[True, False], [False, True]]
    full = StateSpace(-np.eye(2), np.eye(2), np.array([[1.0, 0.3], [0.0, 1.0]]), np.array([[1.0, 0.0], [0.2, 1.0]]))
    assert Freedom.triangular(full).C.all()
    assert not Freedom.triangular(full).B.any()


def test_a_triangular_reference_stays_one():
    found = cook(shipped("hinf_triangular")).found
    D = np.array(found["reference"]["D"])
    assert np.all(np.triu(D, 1) == 0.0)
    assert np.all(np.tril(D, -1)[np.tril_indices(3, -1)] > 0.0)
    assert hminus_index(StateSpace.gain(D)).value == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize(
    ("keys", "kind", "message"),
    [
        ("  uncertainty: ball\n", CampaignError, "own.yaml:7:16: must be 'norm_bounded', got the text 'ball'"),
        ("  uncertainty: {structures: []}\n", CampaignError, "unknown key 'structures'. Did you mean 'structured'"),
        ("  uncertainty: {structured: [{full: [2]}]}\n", CampaignError, "own.yaml:7:37: needs at least 2"),
        ("  uncertainty: {structured: [{}]}\n", DesignError, "repeated_real: n} or {full"),
        ("  uncertainty: {structured: [{repeated_real: 2}]}\n", DesignError, r"make Δ of shape \(2, 2\)"),
        ("  uncertainty: {}\n", DesignError, "recipe.uncertainty is norm_bounded"),
        ("  uncertainty: {polytope: [{delta: [[1.0, 2.0]]}]}\n", DesignError, r"polytope\[0\]: delta is \(1, 2\)"),
        ("  uncertainty: {polytope: [{delta: [[1.0]], A: [[1.0]]}]}\n", DesignError, "not both: delta, A"),
        ("  uncertainty: {polytope: [{A: [[1.0]]}]}\n", DesignError, r"polytope\[0\] makes no plant"),
        ("  weights: {W_d: two}\n", CampaignError, "own.yaml:7:18: expected a mapping of keys"),
        ("  weights: {W_x: 2.0}\n", CampaignError, "unknown key 'W_x'.*Allowed: W_f, W_d, W_u"),
        ("  weights: {W_d: [1.0, 2.0]}\n", DesignError, "W_d has D of shape .2, 2., need 1 rows"),
        ("  weights: {W_d: {a: [-1.0], d: [1.0]}}\n", DesignError, "W_d has d alone, or a, b, c and d"),
        ("  weights: {W_d: {a: [1.0], b: [1.0], c: [1.0], d: [1.0]}}\n", DesignError, "W_d is unstable"),
        ("  reference: {d: [1.0], D: [[1.0]]}\n", DesignError, "diagonal by a, b, c, d or has matrices"),
        ("  reference: {A: [[-1.0]], D: [[1.0]]}\n", DesignError, "D alone, or A, B, C and D; got A, D"),
        ("  fixed_poles: [-1.0]\n", DesignError, "fixed_reference does not look at fixed_poles; it takes reference"),
        ("  solver: GUROBI\n", CampaignError, "own.yaml:7:11: must be 'CLARABEL', 'SCS' or 'MOSEK'"),
    ],
)
def test_keys_that_give_nothing_say_why(tmp_path, keys, kind, message):
    with pytest.raises(kind, match=message):
        cooked_with(tmp_path, keys)


@pytest.mark.parametrize(
    ("method", "message"),
    [
        ("fixed_poles", "needs fixed_poles: .a_1"),
        ("exact_inverse", "does not look at solver; it takes none of these keys"),
        ("kalman", "does not look at solver; it takes weights"),
    ],
)
def test_methods_say_what_they_take(tmp_path, method, message):
    keys = "" if method == "fixed_poles" else "  solver: SCS\n"
    with pytest.raises(DesignError, match=message):
        cooked_with(tmp_path, keys, UNCERTAIN.replace("method: fixed_reference", f"method: {method}"))


def test_a_filter_that_follows_exactly_needs_no_state(tmp_path):
    text = (
        PLANT.replace("Bd: [[0.1]]", "Bd: [[0.0]]")
        .replace("Bf: [[0.5]]", "Bf: [[0.0]]")
        .replace("Dd: [[0.1]]", "Dd: [[0.0]]")
    )
    text = text.replace("B: [[1.0]], ", "B: [[0.0]], ").replace("C: [[1.0]]", "C: [[0.0]]")
    cooked = cooked_with(tmp_path, "", text)
    assert cooked.found["gamma"] < 1e-9
    path = tmp_path / "exact.yaml"
    path.write_text(cooked.text)
    assert len(read_design(path).gains.A) == 1


def test_a_design_without_a_recipe_is_no_recipe():
    with pytest.raises(DesignError, match="has no recipe"):
        cook(shipped("voting_monitor"))
