"""The H∞ filter of the Boeing 747: a polytope of flight conditions, about the trim that a flight begins in."""

import numpy as np
import pytest
import yaml

import fddbench
from fddbench import gallery
from fddbench.design.norms import hinf_norm
from fddbench.design.problem import Filter, augment, close
from fddbench.design.recipe import cook
from fddbench.design.recipes.hinf_entries import ReferenceEntry, WeightsEntry
from fddbench.design.recipes.hinf_model import ModelEntry, model_plants
from fddbench.errors import DesignError
from fddbench.systems import StateSpace

NAME = "hinf_filter_b747"
PATH = gallery.folder("detectors") / f"{NAME}.yaml"


def written():
    return yaml.safe_load(PATH.read_text(encoding="utf-8"))


def cooked(tmp_path, *without, **model):
    data = written()
    for key in without:
        del data["recipe"][key]
    data["recipe"]["model"] |= model
    data["recipe"]["model"] = {key: value for key, value in data["recipe"]["model"].items() if value is not None}
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return cook(path)


def test_gamma_holds_at_the_five_conditions():
    data = written()
    recipe, gains = data["recipe"], data["gains"]
    plants = model_plants(ModelEntry.model_validate(recipe["model"]), PATH.parent)
    assert plants.keys == {name: gains[name] for name in ("outputs", "inputs", "sites")}
    own = {"Ak": "A", "Bky": "B_y", "Bku": "B_u", "Ck": "C", "Dky": "D_y", "Dku": "D_u"}
    filter_ = Filter(**{name: np.array(gains[key]) for name, key in own.items()})
    reference = ReferenceEntry(**recipe["reference"]).system()
    weights = {"W_f": {"gain": 1.0}} | {name: {"d": recipe["weights"][name]} for name in ("W_d", "W_u")}
    found = []
    for plant in plants.vertices:
        loop = close(augment(plant, reference, WeightsEntry(**weights).weights(plant)), reference, filter_)
        found.append(hinf_norm(StateSpace(loop.A, loop.B, loop.C, loop.D)).value)
    assert 0.8 * recipe["found"]["gamma_lower_bound"] <= max(found) <= recipe["found"]["gamma"]


def test_the_plant_with_its_altitude_is_refused(tmp_path):
    """At 7000 m it climbs away by itself, slowly: Problem 1 assumes a stable plant."""
    with pytest.raises(DesignError, match="is unstable"):
        cooked(tmp_path, "weights", taken_as_inputs=None)


@pytest.mark.parametrize(("model", "message"), [
    ({"taken_as_inputs": ["gamma_deg"]}, "gamma_deg must be an output that is a state"),
    ({"units": {"gamma_deg": 2.0}}, "gamma_deg must belong to signals"),
])  # fmt: skip
def test_keys_that_do_not_fit(tmp_path, model, message):
    with pytest.raises(DesignError, match=message):
        cooked(tmp_path, **model)


def test_it_begins_about_the_trim_of_its_flight_and_finds_a_loss():
    """Far from its conditions the first residual is zero all the same; half of the thrust is found."""
    campaign = fddbench.read(
        "b747_monte_carlo", [f"detectors=[{NAME}]", "dispersions.monte_carlo.runs=3", "duration_s=28.0"]
    )
    shown = fddbench.signals(campaign, "thrust_bias").detectors[NAME]
    np.testing.assert_allclose([shown[f"mean_{i}"][0] for i in (1, 2)], 0.0, atol=1e-12)
    assert np.abs([shown[f"mean_{i}"][:1900] for i in (1, 2)]).max() < 0.3
    assert shown["mean_2"][2500].max() < -0.1  # 1 to 10 kN are missing, in 10 kN
