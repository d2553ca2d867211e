"""A recorded series: what a file holds is what the sensor gets; what it cannot hold is told with its place."""

import numpy as np
import pandas as pd
import pytest

import fddbench
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError, FddbenchError
from fddbench.faults.injection import SignalFaults
from fddbench.faults.recorded import read_recorded
from fddbench.faults.series import Series
from fddbench.interfaces import FlightFaults, Site

T, N, ONSET = 0.01, 30, 5
SITES = tuple(Site(name=name, signal="s", row=row, unit_name="deg/s", admissible=40.0) for row, name in enumerate("ab"))
CSV = b"time_s, value_deg_s, note\n7.00,1.0,x\n7.04,3.0,y\n7.10,-3.0,z\n"
HEALTHY = np.random.default_rng(3).normal(size=N)


def series(content=CSV, **keys):
    common = {"kind": "series", "sites": keys.pop("sites", ["a"]), "onset_s": ONSET * T, "file": "rec.csv"}
    return Series.model_validate({**common, **keys}).with_files({"file": content})


def fly(*scenarios, uniform=0.5):
    """Readings of the first site, (n_time, n_scenarios): one flight of each."""
    lists, n = [[fault] for fault in scenarios], len(scenarios)
    block = SignalFaults(SITES, "s", lists, T)
    c = block.prepare(FlightFaults(lists=lists, which=np.arange(n), uniform=np.full((1, 2, n), uniform)))
    x, found = block.states.spread(block.start(c), n), []
    for k in range(N):
        drawn = block.draws.unpack(np.zeros((0, n)))
        x, shown = block.step(x, c, drawn, np.full((2, n), HEALTHY[k]), np.float64(k))
        found.append(shown[0])
    return np.array(found)


def added(*scenarios, **more):
    return fly(*scenarios, **more) - HEALTHY[:, None]


LINEAR = [1, 1.5, 2, 2.5, 3, 2, 1, 0, -1, -2, -3]
PLAYED = {
    "hold": ({}, [*LINEAR, -3, -3]),
    "zero": ({"after": "zero"}, [*LINEAR, 0, 0]),
    "repeat": ({"after": "repeat"}, [*LINEAR, 1, 1.5]),
    "previous": ({"between": "previous"}, [1, 1, 1, 1, 3, 3, 3, 3, 3, 3, -3, -3, -3]),
    "from within": ({"start_s": 0.04}, [3, 2, 1, 0, -1, -2, -3, -3, -3]),
    "twice": ({"gain": -2.0}, [-2, -3, -4]),
    "drawn start": ({"start": "uniform"}, [2, 1, 0, -1]),
}


@pytest.mark.parametrize("name", PLAYED)
def test_what_is_recorded_is_played(name):
    keys, expected = PLAYED[name]
    found = added(series(**keys), uniform=0.5)[:, 0]
    np.testing.assert_allclose(found[ONSET : ONSET + len(expected)], expected, atol=1e-12)
    assert not found[:ONSET].any()


def test_several_recordings_fly_side_by_side_each_its_own():
    other = series(CSV.replace(b"7.04,3.0", b"7.04,5.0"))
    scenarios = [series(), other, series(gain=2.0), series(after="repeat")]
    found = fly(*scenarios)
    for number, fault in enumerate(scenarios):
        assert found[:, number].tobytes() == fly(fault)[:, 0].tobytes()


def test_in_place_of_the_signal_and_with_the_other_sign_on_the_second_site():
    shown = fly(series(mode="replace", sites=["b", "a"], correlation="opposite"))[:, 0]
    np.testing.assert_allclose(shown[ONSET : ONSET + 11], -np.array(LINEAR), atol=1e-12)


def test_a_gain_of_zero_is_the_healthy_signal_bit_for_bit():
    assert fly(series(gain=0.0))[:, 0].tobytes() == HEALTHY.tobytes()


def test_parquet_holds_the_same(tmp_path):
    pd.DataFrame({"time_s": [0.0, 0.04, 0.1], "value_deg_s": [1.0, 3.0, -3.0]}).to_parquet(tmp_path / "rec.parquet")
    content = (tmp_path / "rec.parquet").read_bytes()
    assert fly(series(content, file="rec.parquet")).tobytes() == fly(series(CSV.replace(b"7.", b"0."))).tobytes()


WRONG = {
    "no column": (
        b"time_s,value_deg\n0,1\n1,2\n",
        "rec.csv has no column value_deg_s; it has time_s, value_deg. A recorded",
    ),
    "a word": (b"time_s,value_deg_s\n0,1\n1,two\n", "rec.csv:3: value_deg_s is 'two', it must be a finite number"),
    "a gap": (b"time_s,value_deg_s\n0,1\n1,\n2,1\n", r"rec.csv:3: value_deg_s is ''.*\(1 of 3 rows are so\)"),
    "infinite": (b"time_s,value_deg_s\n0,inf\n1,2\n", "rec.csv:2: value_deg_s is 'inf'"),
    "falls": (
        b"time_s,value_deg_s\n0,1\n1,2\n0.5,2\n",
        "rec.csv:4: time_s = 0.5 does not lie after the row before it, 1",
    ),
    "one row": (b"time_s,value_deg_s\n0,1\n", "rec.csv has 1 rows; a series needs two or more"),
    "empty": (b"", "rec.csv cannot be read: .*It must be a CSV file with one line of names"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_bad_file_is_told_with_place_and_cure(name):
    content, message = WRONG[name]
    with pytest.raises(FddbenchError, match=message):
        read_recorded("rec.csv", content, "value_deg_s")


def campaign(folder, **keys):
    fault = {"kind": "series", "sites": "[r1]", "onset_s": 1.0, "file": "rec.csv", **keys}
    entry = ", ".join(f"{key}: {value}" for key, value in fault.items())
    path = folder / "mine.yaml"
    path.write_text(
        "name: mine\nbenchmark: yaw_rate\nseed: 7\nduration_s: 2\ndetectors: [voting_monitor]\nscenarios:\n"
        f"  - {{name: played, manoeuvre: cruise, faults: [{{{entry}}}]}}\n"
    )
    return path


def test_the_file_travels_with_the_results_and_is_part_of_their_fingerprint(tmp_path):
    (tmp_path / "rec.csv").write_bytes(CSV)
    path = campaign(tmp_path, gain="{grid: [1, 2]}")
    fddbench.run(path, tmp_path / "results", jobs=1)
    assert (tmp_path / "results" / "rec.csv").read_bytes() == CSV
    frozen = read_campaign(tmp_path / "results" / "campaign.yaml")
    assert frozen.sha256 == read_campaign(path).sha256
    (tmp_path / "rec.csv").write_bytes(CSV.replace(b"3.0", b"4.0"))
    with pytest.raises(FddbenchError, match="the file rec.csv is not the same"):
        fddbench.run(path, tmp_path / "results", jobs=1)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"file": "other.csv"}, r"mine.yaml:7:\d+: no file other.csv in .*; put it beside the campaign"),
        ({"file": "../rec.csv"}, "file beside the campaign, without a folder, got '../rec.csv'; put it there"),
        ({"file": "rec.csv", "start_s": 0.2}, "start_s must lie within the 0.1 s that rec.csv lasts, got 0.2"),
    ],
)
def test_what_a_campaign_cannot_play(tmp_path, keys, message):
    (tmp_path / "rec.csv").write_bytes(CSV)
    with pytest.raises(CampaignError, match=message):
        read_campaign(campaign(tmp_path, **keys))
