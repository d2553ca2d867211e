"""What the campaigns over the whole envelope must show, on a few of their runs."""

import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.campaign.plan import plan
from fddbench.results.table import load
from fddbench.runner.run import run_campaign


def flown(name, folder, *overrides):
    campaign = read_campaign(
        gallery.folder("campaigns") / f"{name}.yaml", ["detectors=[sliding_mode_published]", *overrides]
    )
    run_campaign(campaign, folder, jobs=1)
    return load(folder)


@pytest.fixture(scope="module")
def monte_carlo(tmp_path_factory):
    scenarios = [f"scenarios.{row}.runs=6" for row in range(6)]
    return flown("fes_monte_carlo", tmp_path_factory.mktemp("fes"), "dispersions.monte_carlo.runs=6", *scenarios)


def test_ten_faults_are_found_in_time_in_cruise_over_the_whole_envelope(monte_carlo):
    rows = monte_carlo[(monte_carlo["n_faulty"] > 0) & (monte_carlo["status"] == "ok")]
    assert rows["scenario"].nunique() == 10
    assert (rows["outcome"] == "right").all()


def test_six_healthy_manoeuvres_are_quiet_and_none_departs(monte_carlo):
    rows = monte_carlo[(monte_carlo["n_faulty"] == 0) & (monte_carlo["status"] == "ok")]
    assert rows["scenario"].nunique() == 6
    assert (rows["outcome"] == "quiet").all()
    assert monte_carlo["departed_s"].isna().all()


def test_parametric_campaign_is_that_of_the_paper():
    campaign = read_campaign(gallery.folder("campaigns") / "fes_parametric.yaml")
    assert plan(campaign).n_cases == 5184
    assert campaign.purpose == "tuning"
