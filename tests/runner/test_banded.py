"""Bands are quantiles of the very flights that were scored, at the samples that are kept."""

import numpy as np
import pytest
from tests.runner.conftest import write

from fddbench.api.flights import signals
from fddbench.api.report_data import report_data
from fddbench.campaign.load import read_campaign
from fddbench.results.table import load
from fddbench.runner import banded
from fddbench.runner.run import run_campaign


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    folder = tmp_path_factory.mktemp("banded")
    campaign = read_campaign(write(folder))
    run_campaign(campaign, folder / "results", jobs=1)
    return campaign, load(folder / "results")


def test_bands_hold_the_least_the_middle_and_the_largest_of_the_flights(flown, monkeypatch):
    monkeypatch.setattr(banded, "_PART", 2)  # parts of two flights: no part of any result
    campaign, rows = flown
    for bands in banded.bands_of(campaign, rows, signals={"r_deg_s", "phi_deg"}, seconds={}):
        again = signals(campaign, bands.scenario)
        assert bands.flights == bands.of == len(again.cases)
        at = np.searchsorted(again.time_s, bands.time_s)
        for name, seven in bands.signals.items():
            values = again.signals[name][at]
            np.testing.assert_array_equal(seven[0], values.min(axis=1))
            np.testing.assert_array_equal(seven[-1], values.max(axis=1))
            np.testing.assert_array_equal(seven[3], np.sort(values, axis=1)[:, (values.shape[1] + 1) // 2 - 1])
            np.testing.assert_array_equal(bands.one[name], values[:, again.cases.index(bands.case)])
        for name, shares in bands.declared.items():
            np.testing.assert_allclose(shares.sum(axis=0), 1.0)
            two = np.mean(again.detectors[name]["n_declared"][at] == 2, axis=1)
            np.testing.assert_allclose(shares[2], two)


def test_bands_of_faults_begin_a_second_before_the_first_onset_and_end_when_asked(flown):
    campaign, rows = flown
    for bands in banded.bands_of(campaign, rows, signals=(), seconds=dict.fromkeys(rows["scenario"].unique(), 0.5)):
        if bands.onset_s is not None:
            assert bands.time_s[0] == pytest.approx(max(bands.onset_s - 1.0, 0.0))
            assert bands.time_s[-1] <= bands.onset_s + 0.5


def test_very_many_flights_are_sampled(flown, monkeypatch):
    monkeypatch.setattr(banded, "MOST_FLIGHTS", 1)
    campaign, rows = flown
    found = list(banded.bands_of(campaign, rows, signals=(), seconds={}))
    assert all(bands.flights == 1 for bands in found)
    assert any(bands.of > 1 for bands in found)


def test_quantiles_are_of_the_flights_that_still_fly():
    seven = banded.quantiles(np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan]]))
    assert seven[[0, -1], 0].tolist() == [1.0, 3.0]
    assert np.isnan(seven[:, 1]).all()


def test_a_campaign_says_which_scenarios_are_pictured(tmp_path):
    campaign = read_campaign(
        write(tmp_path), ["report={bands: true, scenarios: [noise]}", "dispersions.monte_carlo.runs=1"]
    )
    run_campaign(campaign, tmp_path / "results", jobs=1)
    data = report_data(tmp_path / "results")
    assert [bands.scenario for bands in data.bands] == [of.scenario for of in data.recordings] == ["noise"]
    assert data.rows["scenario"].nunique() == 5
