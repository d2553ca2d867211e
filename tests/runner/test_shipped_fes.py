"""What the campaigns of the whole envelope must fly and show, on a few of their runs."""

import numpy as np
import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.results.table import load
from fddbench.runner.assembling import assemble
from fddbench.runner.run import run_campaign


def read(name, *overrides):
    return read_campaign(gallery.folder("campaigns") / f"{name}.yaml", list(overrides))


def flown(folder, name, *overrides):
    run_campaign(read(name, *overrides), folder, jobs=1)
    return load(folder)


@pytest.mark.parametrize(
    ("name", "flights", "purpose"), [("fes_parametric", 5184, "tuning"), ("fes_monte_carlo", 2200, "evaluation")]
)
def test_as_many_flights_as_the_paper_flew(name, flights, purpose):
    campaign = read(name)
    assert (assemble(campaign).plan.n_cases, campaign.purpose) == (flights, purpose)


def test_of_the_grid_of_table_5_81_points_can_be_trimmed_and_12_fewer_hold_the_turn():
    assembly = assemble(read("fes_parametric"))
    plan = assembly.plan
    able = {}
    for planned in plan.scenarios[:6]:
        reasons = assembly.batch(planned.first_case + np.arange(planned.n_cases)).infeasible_reason
        able[planned.manoeuvre] = sum(reason == "" for reason in reasons)
    assert able["cruise"] == 3 * 81
    assert able["turn_coordination_2"] == 3 * 69


def test_light_turbulence_makes_two_faulty_sensors_of_one(tmp_path):
    """The same aircraft in the same air, calm and at a quarter of the severe one."""
    one = "{kind: jam, sites: [r1], onset_s: 5.0, amplitude_percent: 1.25}"
    rows = flown(
        tmp_path, "fes_turbulence", "dispersions.monte_carlo.runs=3", "dispersions.grid.gust_scale_ratio=[0.0, 0.25]",
        "detectors=[sliding_mode_published]",
        f"scenarios=[{{name: jam_a, manoeuvre: cruise, duration_s: 15.0, faults: [{one}]}}]",
    )  # fmt: skip
    rows = rows[rows["status"] == "ok"]
    calm = rows["p_gust_scale_ratio"] == 0.0
    assert (rows[calm]["outcome"] == "right").all()
    assert (rows[~calm]["outcome"] == "wrong_site").all()
    assert calm.sum() == (~calm).sum() > 0


def test_eq_38_keeps_a_turn_from_being_a_fault_and_hides_faults_while_rolling(tmp_path):
    one = "{kind: jam, sites: [r1], onset_s: 15.0, amplitude_percent: 1.25}"
    two = "{kind: oscillatory, sites: [r1, r2], onset_s: 8.0, amplitude_percent: 3.75, frequency_rad_s: 0.5385"
    two += ", phase_rad: -1.026}"
    rows = flown(
        tmp_path, "fes_maturation", "dispersions.monte_carlo.runs=12", "report={}",
        "detectors=[sliding_mode_published, sliding_mode_without_eq38]",
        f"scenarios=[{{name: turn, manoeuvre: turn_coordination_2, duration_s: 20.0, faults: [{one}]}}, "
        f"{{name: rolling, manoeuvre: yaw_angle_mode, duration_s: 13.36, faults: [{two}]}}]",
    )  # fmt: skip
    rows = rows[rows["status"] == "ok"]
    wrong = (rows["outcome"] == "wrong_site").groupby([rows["scenario"], rows["detector"]]).sum()
    assert wrong["turn", "sliding_mode_without_eq38"] > 3 * max(wrong["turn", "sliding_mode_published"], 1)
    assert wrong["rolling", "sliding_mode_without_eq38"] == 0 < wrong["rolling", "sliding_mode_published"]


def test_smoke_6dof_flies_and_finds_what_it_can(tmp_path):
    rows = flown(tmp_path, "smoke_6dof")
    assert (rows["status"] == "ok").all()
    assert rows["departed_s"].isna().all()
    assert (rows[rows["n_faulty"] == 0]["outcome"] == "quiet").all()
