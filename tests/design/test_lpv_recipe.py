"""Recipes of lpv_filter and kalman_monitor: the shipped designs are what they give, and so is one for a model of one's own."""

import pickle

import numpy as np
import pytest
import yaml
from scipy.integrate import solve_ivp

from fddbench import gallery
from fddbench.design.recipe import cook
from fddbench.design.recipes.linearisation import linearised
from fddbench.design.recipes.recipe import RecipeError
from fddbench.designs.design import read_design
from fddbench.errors import CampaignError, DesignError
from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import aircraft
from fddbench.flight.b747.dynamics import derivative
from fddbench.flight.b747.trim import condition, trim
from fddbench.scheduling.b747 import B747

SHIPPED = (
    "lpv_filter_fold",
    "lpv_filter_approx",
    "lpv_filter_unclipped",
    "lpv_filter_trim_removed",
    "lti_filter_b747",
    "kalman_monitor_b747",
)


def shipped(name):
    return gallery.folder("detectors") / f"{name}.yaml"


def same(found, filed):
    """Equal but for what tuning chose, and for the last digits of another LAPACK."""
    if isinstance(filed, dict):
        return found.keys() == filed.keys() and all(
            same(found[key], filed[key]) for key in filed if key != "thresholds"
        )
    if isinstance(filed, list):
        return len(found) == len(filed) and all(same(a, b) for a, b in zip(found, filed, strict=True))
    return found == (pytest.approx(filed, rel=1e-6, abs=1e-12) if isinstance(filed, float) else filed)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_recipe_gives_the_design_of_the_file(name, tmp_path):
    cooked, filed = cook(shipped(name)), yaml.safe_load(shipped(name).read_text())
    assert same(yaml.safe_load(cooked.text)["gains"], filed["gains"])
    assert same(dict(cooked.found), dict(cooked.before))
    path = tmp_path / f"{name}.yaml"
    path.write_text(cooked.text)
    assert set(read_design(path).gains.thresholds) == {1.0}


def test_what_is_found_of_the_aircraft():
    found = cook(shipped("lpv_filter_fold")).found
    assert found["parameters_in_A"] == [2, 4]
    assert found["corners"] == 4
    assert not found["elevator"]["sum_condition"]  # equation (30) against (B3)
    assert found["elevator"]["condition_number"] < 1.01
    assert all(found[site]["identity_kept"] and found[site]["order"] == 1 for site in ("elevator", "thrust"))


OWN = """\
kind: lpv_filter
source: mine
tuned_on: null
recipe:
  model: {A: [[-1.0, 1.0], [-2.0, -1.0]], B: [[1.0, 0.0], [0.5, 1.0]], C: [[1.0, 0.0], [0.0, 1.0]]}
  outputs: [{signal: y, row: 0}, {signal: y, row: 1}]
  inputs: [{signal: pump_a, scale: 2.0}, {signal: valve_m}]
  faults: {pump: pump_a, valve: {direction: [[0.0], [1.0]], unit_per_fault: 3.0}}
  decay: 4.0
  smooth_s: {valve: 0.5}
  confirm_s: 0.2
gains: {}
"""


def cooked_from(tmp_path, text):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    return yaml.safe_load(cook(path).text)


def test_a_model_of_ones_own_without_parameters(tmp_path):
    gains = cooked_from(tmp_path, OWN)["gains"]
    pump, valve = gains["filters"]
    assert (pump["site"], pump["unit_per_fault"], valve["unit_per_fault"], valve["smooth_s"]) == ("pump", 0.5, 3.0, 0.5)
    assert pump["N"] == [[[-4.0]]]
    np.testing.assert_allclose(np.array(pump["H"]) @ [[0.0], [1.0]], 0.0, atol=1e-12)  # blind to the valve
    assert gains["bend"] == [[[-1.0, 1.0], [-2.0, -1.0]]]
    assert gains["scheduling"] is None


SCHEDULED = """\
import numpy as np

class Tilt:
    about, signals, parameters, box = "a ratio", ("tilt_ratio",), ("tilt_ratio",), ((-1.0, 1.0),)

    def rho(self, measured):
        return np.stack([measured.tilt_ratio])
"""


def test_a_scheduling_of_ones_own_beside_the_design(tmp_path):
    (tmp_path / "mine.py").write_text(SCHEDULED)
    text = OWN.replace(
        "  model: {A: [[-1.0, 1.0], [-2.0, -1.0]]",
        "  scheduling: mine.py:Tilt\n  model: {A: [[[-1.0, 1.0], [-2.0, -1.0]], [[0.2, 0.0], [0.0, 0.1]]]",
    )
    path = tmp_path / "own.yaml"
    path.write_text(text)
    path.write_text(cook(path).text)
    design = read_design(path)
    assert list(design.files) == ["mine.py"]  # travels with the results
    assert design.members["scheduling"].name == "mine.py:Tilt"
    assert len(design.gains.filters[0].G) == 2
    path.write_text(path.read_text().replace("scheduling: mine.py:Tilt\n  outputs", "scheduling: b748\n  outputs"))
    with pytest.raises(CampaignError, match=r"own.yaml:\d+:\d+: no scheduling is called 'b748'"):
        read_design(path)


@pytest.mark.parametrize(
    ("old", "new", "kind", "message"),
    [
        ("faults: {pump: pump_a", "faults: {pump: pump", DesignError, "'pump' enters as input 'pump', which the model has 0"),
        ("smooth_s: {valve", "smooth_s: {vale", DesignError, "recipe.smooth_s: no filter for 'vale'; there are pump, valve"),
        ("decay: 4.0", "decay: -4.0", CampaignError, r"own.yaml:9:10: must be > 0"),
        ("C: [[1.0, 0.0], [0.0, 1.0]]", "D: [[1.0]]", DesignError, "a model of one's own is model: {A, B, C}"),
        ("  decay", "  blind_to: {pump: valve_m}\n  decay", DesignError, "recipe.blind_to: 'pump' has a filter"),
        ("  decay", "  blind_to: {gust: {direction: [[1.0], [0.5]]}}\n  decay", DesignError, "'pump' cannot be isolated from"),
        ("model: {A", "at: {pump_a: 1.0}\n  model: {A", DesignError, "linearises a model that has scheduling parameters"),
        ("valve: {direction: [[0.0], [1.0]], unit", "valve: {unit", DesignError, "'valve' has an input or a direction"),
        ("signal: pump_a, scale: 2.0", "signal: pump_a, scale: 0.0", CampaignError, r"own.yaml:7:36: must not be 0"),
        ("unit_per_fault: 3.0", "unit_per_fault: 0.0", CampaignError, r"own.yaml:8:77: must not be 0"),
        ("A: [[-1.0, 1.0], [-2.0, -1.0]]", "A: foo", CampaignError, r"own.yaml:5:14: expected a list, got the text 'foo'$"),
        ("[-2.0, -1.0]", "[-2.0]", DesignError, r"own.yaml:5:14: recipe.model.A is no matrix of real numbers"),
        ("[[0.0], [1.0]]", "[[0.0], [0.0]]", DesignError, r"own.yaml:8:33: fault 'valve' has no direction"),
    ],
)  # fmt: skip
def test_recipes_that_give_nothing_say_why(tmp_path, old, new, kind, message):
    with pytest.raises(kind, match=message):
        cooked_from(tmp_path, OWN.replace(old, new))


def test_all_that_does_not_go_together_is_said_at_once(tmp_path):
    text = OWN.replace("faults: {pump: pump_a", "faults: {pump: pump_b").replace("smooth_s: {valve", "smooth_s: {vale")
    with pytest.raises(DesignError) as caught:
        cooked_from(tmp_path, text)
    first, second = str(caught.value).splitlines()
    assert "own.yaml:10:13: recipe.smooth_s: no filter for 'vale'" in first
    assert "own.yaml:8:18: recipe: fault 'pump' enters as input 'pump_b'" in second
    with pytest.raises(DesignError) as again:
        raise pickle.loads(pickle.dumps(RecipeError(("a", "b"))))
    assert again.value.messages == ("a", "b")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("model: approx", "model: folded", "scheduling 'b747' has no model 'folded'. Did you mean 'fold'"),
        ("altitude_m: 7000.0, ", "", r"own.yaml:\d+:7: recipe.at: altitude_m missing"),
        ("altitude_m: 7000.0, ", "altitude_m: 7000.0, beta_deg: 0.0, ", "recipe.at: nothing looks at beta_deg"),
        (
            "v_tas_m_s: 241.0",
            "v_tas_m_s: 2410.0",
            "recipe.at: the condition lies outside the box of the model: rho 1 = ",
        ),
        ("v_tas_m_s: 241.0", "v_tas_m_s: 0.0", "recipe.at: the condition lies outside the box of the model"),
        ("scheduling: b747", "scheduling: b748", r"own.yaml:\d+:15: recipe.scheduling: no scheduling is called 'b748'"),
    ],
)
def test_the_aircraft_s_recipes_that_give_nothing_say_why(tmp_path, old, new, message):
    text = shipped("lti_filter_b747").read_text().split("  found:")[0] + "gains: {}\n"
    with pytest.raises(DesignError, match=message):
        cooked_from(tmp_path, text.replace(old, new))


def test_linearised_it_answers_as_the_nonlinear_aircraft_does():
    """A frozen rho would forget that lift grows with alpha; the Jacobian does not."""
    recipe = yaml.safe_load(shipped("lti_filter_b747").read_text())["recipe"]
    model = linearised(B747.models["approx"](), B747(), recipe["at"])
    at, own = condition(7000.0, 241.0), aircraft()
    found = trim(own, at)
    x0 = np.array([found.alpha_rad[0], 0.0, 241.0, found.alpha_rad[0], 7000.0])
    u0 = np.array([found.elevator_deg[0], at.stabiliser_deg[0], found.thrust_n[0]])
    du = np.array([0.2, 0.0, 500.0])
    u = (u0 + du)[:, np.newaxis]

    def nonlinear(t, x):
        return derivative(x[:, np.newaxis], u, np.zeros((3, 1)), own, air(x[4:]))[:, 0]

    def linear(t, z):
        return model.A[0] @ z + model.B[0] @ np.array([*du, 1.0])

    t = np.linspace(0.0, 5.0, 51)
    truth = solve_ivp(nonlinear, (0.0, 5.0), x0, t_eval=t, rtol=1e-9, atol=1e-10).y - x0[:, np.newaxis]
    answer = solve_ivp(linear, (0.0, 5.0), np.zeros(5), t_eval=t, rtol=1e-9, atol=1e-10).y
    for own_row, row in zip(truth, answer, strict=True):
        np.testing.assert_allclose(row, own_row, atol=0.03 * np.abs(own_row).max())


KALMAN = (
    OWN.replace("lpv_filter", "kalman_monitor")
    .replace("  smooth_s: {valve: 0.5}\n", "")
    .replace(
        "  faults: {pump: pump_a, valve: {direction: [[0.0], [1.0]], unit_per_fault: 3.0}}\n  decay: 4.0\n",
        "  sample_s: 0.01\n  output_noise: [0.1, 0.2]\n  process_noise: [0.3, 0.5]\n  mean_s: 1.0\n",
    )
)


def test_the_kalman_filter_of_a_recipe_has_the_innovations_it_says(tmp_path):
    """Covariance of e from a run of 40 000 samples of the same discrete model, and white."""
    gains = cooked_from(tmp_path, KALMAN)["gains"]
    A, C, K, W = (np.array(gains[name]) for name in ("A", "C", "K", "W"))
    random = np.random.default_rng(5)
    x, estimate, seen = np.zeros(2), np.zeros(2), []
    for _ in range(40_000):
        y = C @ x + random.normal(size=2) * [0.1, 0.2]
        e = y - C @ estimate
        seen.append(W @ e)
        estimate = A @ estimate + K @ e
        x = A @ x + random.normal(size=2) * np.array([0.3, 0.5]) * 0.1
    white = np.array(seen)
    np.testing.assert_allclose(white.T @ white / len(white), np.eye(2), atol=0.03)
    np.testing.assert_allclose(white[1:].T @ white[:-1] / len(white), 0.0, atol=0.03)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "output_noise: [0.1, 0.2]",
            "output_noise: [0.1]",
            "needs 2 numbers output_noise and 2 process_noise, got 1 and 2",
        ),
        ("A: [[-1.0, 1.0], [-2.0, -1.0]]", "A: [[0.0, 1.0], [0.0, 0.0]]", "there is no steady Kalman filter"),
    ],
)
def test_kalman_recipes_that_give_nothing_say_why(tmp_path, old, new, message):
    text = KALMAN.replace("process_noise: [0.3, 0.5]", "process_noise: [0.0, 0.0]") if old.startswith("A:") else KALMAN
    with pytest.raises(DesignError, match=message):
        cooked_from(tmp_path, text.replace(old, new))
