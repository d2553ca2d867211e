"""Trade-offs of a recipe: a table of designs that differ by one number, flown, and its picture."""

import numpy as np
import pandas as pd
import pytest

from fddbench import gallery
from fddbench.api.pictures import reconstruction_picture, tradeoff_picture
from fddbench.api.tradeoffs import tradeoff
from fddbench.design.changed import changed_design
from fddbench.errors import DesignError, FddbenchError

PNG = b"\x89PNG\r\n\x1a\n"
SMALL = """\
name: small
benchmark: yaw_rate
wind: light
purpose: tuning
seed: 3
detectors: [voting_monitor]
dispersions:
  grid: {gust_scale_ratio: [0.0, 0.3]}
  monte_carlo: {runs: 2}
scenarios:
  - {name: healthy, manoeuvre: cruise, duration_s: 6.0}
  - name: jam_b
    manoeuvre: cruise
    duration_s: 4.0
    faults: [{kind: jam, sites: [r1, r2], onset_s: 2.0, amplitude_percent: 5.0}]
"""


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    path = tmp_path_factory.mktemp("campaign") / "small.yaml"
    path.write_text(SMALL)
    return tradeoff("sliding_mode_unit_vector", path, {"scheme.output_lag_s": [0.2]}, jobs=1)


def test_a_longer_lag_buys_less_noise(table):
    base, lagged = table.to_dict("records")
    assert (lagged["key"], lagged["value"]) == ("scheme.output_lag_s", "0.2")
    assert lagged["rms_0"] < base["rms_0"]
    assert lagged["chatter_1_s"] < 0.6 * base["chatter_1_s"]
    assert lagged["gamma"] == base["gamma"]
    assert base["gamma_here"] == pytest.approx(0.5738, abs=1e-3)
    assert base["operations"] == lagged["operations"] > 500
    assert {"right_jam_b_percent", "median_jam_b_s", "largest_margin_0"} <= set(table.columns)


def test_its_picture(table):
    picture = tradeoff_picture(table, title="small")
    assert picture.startswith(PNG)
    worse = pd.concat([table, table]).assign(rms_0=np.nan)
    assert tradeoff_picture(worse, title="no numbers").startswith(PNG)


def test_a_picture_of_a_flight_needs_a_design_that_shows_its_inside():
    campaign = gallery.folder("campaigns") / "yaw_rate_single_runs.yaml"
    assert reconstruction_picture(campaign, "figure_5/1/0/0", "sliding_mode_published_inside").startswith(PNG)
    with pytest.raises(FddbenchError, match="shows no inside of an observer"):
        reconstruction_picture(campaign, "figure_5/1/0/0", "sliding_mode_published")


def test_a_campaign_that_is_scored_is_refused():
    with pytest.raises(FddbenchError, match="purpose"):
        tradeoff("sliding_mode_lmi", "yaw_rate_table8", {})


@pytest.mark.parametrize(
    ("key", "message"), [("scheme.input_lag", "no key 'scheme.input_lag'"), ("delta.x", "no key 'delta.x'")]
)
def test_a_key_that_the_recipe_does_not_have_is_refused(tmp_path, key, message):
    with pytest.raises(DesignError, match=message):
        changed_design(gallery.folder("detectors") / "sliding_mode_lmi.yaml", key, 1.0, tmp_path / "x.yaml")
