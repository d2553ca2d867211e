"""The H∞ filter of three yaw-rate sensors: its proof holds where it was not sampled, and what it cannot serve is refused."""

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
from fddbench.detection.hinf_filter import HinfFilter
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site
from fddbench.systems import StateSpace, UncertainPlant

NAME = "hinf_filter_yaw_rate"
PATH = gallery.folder("detectors") / f"{NAME}.yaml"
SITES = tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(3))


def written():
    return yaml.safe_load(PATH.read_text(encoding="utf-8"))


def test_gamma_holds_at_the_corners_and_inside():
    """‖[(T_rf - T_ref) W_f, T_rd W_d, T_ru W_u]‖∞ of the filter as it stands in the file, at fixed parameters."""
    data = written()
    recipe, gains = data["recipe"], data["gains"]
    plants = model_plants(ModelEntry.model_validate(recipe["model"]), PATH.parent)
    assert len(plants.vertices) == recipe["found"]["vertices"] == 16
    assert plants.keys == {name: gains[name] for name in ("outputs", "inputs", "sites")}
    own = {"Ak": "A", "Bky": "B_y", "Bku": "B_u", "Ck": "C", "Dky": "D_y", "Dku": "D_u"}
    filter_ = Filter(**{name: np.array(gains[key]) for name, key in own.items()})
    reference = ReferenceEntry(**recipe["reference"]).system()
    weights = {"W_f": {"gain": 1.0}} | {name: {"d": recipe["weights"][name]} for name in ("W_d", "W_u")}
    rng = np.random.default_rng(1)
    weighs = rng.dirichlet(np.full(16, 0.3), 10)
    found = []
    for share in (*np.eye(16), *weighs):
        names = ("A", "Bf", "Bd", "B", "C", "Df", "Dd", "D")
        mixed = {n: sum(w * getattr(v, n) for w, v in zip(share, plants.vertices, strict=True)) for n in names}
        plant = UncertainPlant(**mixed)
        loop = close(augment(plant, reference, WeightsEntry(**weights).weights(plant)), reference, filter_)
        found.append(hinf_norm(StateSpace(loop.A, loop.B, loop.C, loop.D)).value)
    assert max(found) <= recipe["found"]["gamma"]
    assert max(found) >= 0.8 * recipe["found"]["gamma_lower_bound"]  # the proof is not far from what happens


def test_the_whole_lateral_model_is_refused_with_proof(tmp_path):
    """Its Dutch roll is damped too little for one Lyapunov function over the box: Lemma 6 has nothing to stand on."""
    data = written()
    model = {"scheduling": "lateral_lpv", "name": "published", "faults": {"r1": {"output": 3}}}
    data["recipe"] |= {"model": model, "reference": {"a": [-1.0], "b": [1.0], "c": [-1.0], "d": [1.0]}}
    del data["recipe"]["weights"], data["recipe"]["sensors"]
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(DesignError, match="16 vertices is not quadratically stable"):
        cook(path)


@pytest.mark.parametrize(("change", "message"), [
    ({"plant": "jet_engine"}, "a plant or a model, one of both"),
    ({"uncertainty": "norm_bounded"}, "corners or conditions of recipe.model are the set"),
    ({"model": {"scheduling": "lateral_lpv", "name": "yaw", "faults": {"r1": {"output": 0}}}}, "no model 'yaw'"),
    ({"model": {"scheduling": "lateral_lpv", "name": "yaw_moment", "faults": {"r1": {"output": 3}}}}, "there are 0 to 2"),
    ({"model": {"scheduling": "lateral_lpv", "name": "yaw_moment", "faults": {"r1": {"input": "x"}}}}, "enters as input 'x'"),
    ({"model": {"scheduling": "lateral_lpv", "name": "yaw_moment", "faults": {"r1": {}}}}, "an input or an output"),
])  # fmt: skip
def test_keys_that_do_not_go_together(tmp_path, change, message):
    data = written()
    data["recipe"] |= change
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(DesignError, match=message):
        cook(path)


def test_a_pair_is_told_from_the_third_sensor():
    """A fresh fault of 2 deg/s shows as no less than 1 - gamma of it, which is all that gamma promises."""
    overrides = [f"detectors=[{NAME}]", "dispersions.monte_carlo.runs=2", "duration_s=3.0"]
    shown = fddbench.signals(fddbench.read("smoke", overrides), "jam_b").detectors[NAME]
    assert shown["n_declared"][220].tolist() == [2.0, 2.0]
    fresh = [shown[f"mean_{i}"][205, 0] for i in (1, 2, 3)]
    assert min(fresh[:2]) > 2.0 * (1.0 - 0.35)
    assert abs(fresh[2]) < 0.1


@pytest.mark.parametrize(("change", "message"), [
    ({"inputs": None}, "given both, or neither"),
    ({"sites": ["r1", "r2", "r9"]}, "r9 is not on this benchmark"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(change, message):
    single = ("beta_deg", "p_deg_s", "v_tas_m_s")
    bus = Bus(sample_s=0.01, sites=SITES, signals={**dict.fromkeys(single, 0), "r_deg_s": 3, "surface_deg": 13})
    with pytest.raises(DesignError, match=message):
        HinfFilter.from_design(HinfFilter.Gains.model_validate(written()["gains"] | change), bus)
