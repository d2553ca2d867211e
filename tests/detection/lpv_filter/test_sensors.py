"""Filters of redundant sensors: blind to gusts, each sees its own reading; and what the geometry refuses."""

import numpy as np
import pytest
import yaml

import fddbench
from fddbench import gallery
from fddbench.design.recipe import cook
from fddbench.detection.lpv_filter import LpvFilter
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site
from fddbench.scheduling.lateral_lpv import LateralLpvParameters

NAME = "lpv_filter_yaw_rate"
PATH = gallery.folder("detectors") / f"{NAME}.yaml"


def written():
    return yaml.safe_load(PATH.read_text(encoding="utf-8"))


def cooked(tmp_path, change):
    data = written()
    change(data["recipe"])
    path = tmp_path / "own.yaml"
    path.write_text(yaml.safe_dump(data, sort_keys=False), encoding="utf-8")
    return cook(path)


def signals(scenario, **choices):
    overrides = [f"detectors=[{NAME}]", "dispersions.monte_carlo.runs=2", "duration_s=12.0"]
    overrides += [f"{key}={value}" for key, value in choices.items()]
    return fddbench.signals(fddbench.read("smoke", overrides), scenario).detectors[NAME]


def test_no_gust_reaches_an_estimate():
    """3 m/s rms turn the paper's observer upside down; here noise of rate and sideslip is all there is."""
    calm, rough = (signals("healthy", wind=wind)["estimate_r1_deg_s"] for wind in ("none", "moderate"))
    assert np.abs(rough).max() < 1.2 * np.abs(calm).max() < 0.1


def test_a_pair_is_told_from_the_third_and_its_size_estimated():
    shown = signals("jam_b")
    assert shown["n_declared"][215].tolist() == [2.0, 2.0]
    at = 202  # a fresh fault of 2 deg/s
    np.testing.assert_allclose([shown[f"estimate_r{i}_deg_s"][at, 0] for i in (1, 2, 3)], [2.0, 2.0, 0.0], atol=0.12)


def test_the_recipe_remakes_the_design(tmp_path):
    made, kept = cooked(tmp_path, lambda recipe: None).gains, written()["gains"]
    for name in ("scheduling", "outputs", "inputs", "bend", "sensors"):
        assert made[name] == kept[name]
    for ours, theirs in zip(made["filters"], kept["filters"], strict=True):
        assert ours["output"] == theirs["output"]
        for key in ("N", "G", "F", "M", "H"):
            np.testing.assert_allclose(ours[key], theirs[key], rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("sensor", ["beta_deg", "p_deg_s"])
def test_errors_of_sideslip_and_roll_rate_cannot_be_decoupled(tmp_path, sensor):
    """They act through A(rho), whose columns turn into the yaw acceleration as rho moves."""
    with pytest.raises(DesignError, match="fault 'r1' cannot be isolated from 'other'"):
        cooked(tmp_path, lambda recipe: recipe["blind_to"].update(other={"sensor": sensor}))


def test_a_rudder_fault_can_be_decoupled_at_one_flight_condition_only(tmp_path):
    """Roll and yaw row together are blind to one direction; over the envelope it turns, and takes both rows."""
    moving = LateralLpvParameters.models["published"]().B[:, :, [0]]
    frozen = {"direction": [[0.0], [0.0863], [0.0045], [-0.0148]]}
    assert cooked(tmp_path, lambda recipe: recipe["blind_to"].update(rudder=frozen)).found["r1"]["identity_kept"]
    with pytest.raises(DesignError, match="fault 'r1' cannot be isolated from 'rudder'"):
        cooked(tmp_path, lambda recipe: recipe["blind_to"].update(rudder={"direction": moving.tolist()}))


def test_an_error_of_the_bank_angle_is_decoupled(tmp_path):
    found = cooked(tmp_path, lambda recipe: recipe["blind_to"].update(bank={"sensor": "phi_deg"})).found
    assert found["r1"]["identity_kept"]


@pytest.mark.parametrize(("change", "message"), [
    ({"sensors": {"differ": 0.1, "mean_s": 0.05}, "filters": 1}, "needs two filters or more"),
    ({"output": 9}, "there are outputs 0 to 5"),
    ({"output": 0}, "H does not see output 0"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(change, message):
    gains = written()["gains"]
    kept = change.pop("filters", 3)
    gains["filters"], gains["thresholds"] = gains["filters"][:kept], gains["thresholds"][:kept]
    if "output" in change:
        gains["filters"][0]["output"] = change.pop("output")
    sites = tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(3))
    single = ("phi_deg", "beta_deg", "p_deg_s", "v_tas_m_s", "mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
    bus = Bus(sample_s=0.01, sites=sites, signals={**dict.fromkeys(single, 0), "r_deg_s": 3, "surface_deg": 13})
    with pytest.raises(DesignError, match=message):
        LpvFilter.from_design(LpvFilter.Gains.model_validate(gains | change), bus, LateralLpvParameters)
