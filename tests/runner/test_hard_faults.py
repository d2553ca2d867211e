"""Faults that once went wrong in flight: on one sensor, one after the other, and of sizes that no sensor can show."""

import json

import pandas as pd
import pytest

import fddbench

JAM = {"kind": "jam", "sites": ["r1"]}
FROZEN = {**JAM, "mode": "replace", "freeze": True}


def campaign(tmp_path, *scenarios, **changes):
    content = {"name": "hard", "benchmark": "yaw_rate", "seed": 21, "detectors": ["voting_monitor"], "duration_s": 6.0}
    content |= {"scenarios": [{"manoeuvre": "cruise", "detection_time_limit_s": 1, **each} for each in scenarios]}
    path = tmp_path / "hard.yaml"
    path.write_text(json.dumps(content | changes))
    return path


def r1(path, scenario):
    return fddbench.signals(path, scenario).signals["r_deg_s_1"][:, 0]


@pytest.mark.parametrize("order", [1, -1])
def test_a_biased_sensor_freezes_where_it_reads(tmp_path, order):
    bias = {"kind": "bias", "sites": ["r1"], "onset_s": 1.0, "amplitude_deg_s": 2.0}
    path = campaign(tmp_path, {"name": "both", "faults": [bias, {**FROZEN, "onset_s": 4.0}][::order]})
    shown = r1(path, "both")
    assert (shown[400:] == shown[399]).all()
    assert shown[399] == pytest.approx(2.0, abs=0.2)
    assert abs(shown[99]) < 0.2


def test_a_bias_on_a_frozen_sensor_is_added_to_where_it_stands(tmp_path):
    bias = {"kind": "bias", "sites": ["r1"], "onset_s": 4.0, "amplitude_deg_s": 2.0}
    shown = r1(campaign(tmp_path, {"name": "both", "faults": [{**FROZEN, "onset_s": 1.0}, bias]}), "both")
    assert (shown[100:400] == shown[99]).all()
    assert (shown[400:] == shown[99] + 2.0).all()


def test_a_sensor_frozen_from_the_first_sample_shows_that_sample(tmp_path):
    healthy = {"name": "healthy", "detection_time_limit_s": None}
    path = campaign(tmp_path, {"name": "frozen", "faults": [{**FROZEN, "onset_s": 0.0}]}, healthy)
    shown = r1(path, "frozen")
    assert (shown == shown[0]).all()
    assert shown[0] == r1(path, "healthy")[0]


def test_no_sensor_reads_beyond_its_stop(tmp_path):
    """Bias and runaway together once read 148 deg/s on a sensor whose stop is 128."""
    bias = {"kind": "bias", "sites": ["r1"], "onset_s": 1.0, "amplitude_deg_s": 20.0}
    runaway = {"kind": "runaway", "sites": ["r1"], "onset_s": 2.0, "rate_deg_s2": 100.0}
    shown = r1(campaign(tmp_path, {"name": "both", "faults": [bias, runaway]}), "both")
    assert shown.max() == 128.0
    assert shown[-1] == 128.0


def test_an_intermittent_fault_that_is_latched_is_found_once(tmp_path):
    """A latching monitor has the sensor declared when it breaks again: that is no detection after 0 s."""
    faults = [{**JAM, "amplitude_deg_s": 2.0, "onset_s": at, "end_s": at + 2.0} for at in (1.0, 4.0)]
    path = campaign(tmp_path, {"name": "twice", "faults": faults}, duration_s=8.0)
    fddbench.run(path, tmp_path / "results", jobs=1, backend="numpy")
    events = fddbench.load_events(tmp_path / "results")
    assert events["case"].tolist() == ["twice/0/0/0"] * 2
    assert events["outcome"].tolist() == ["right", "declared_before"]
    assert events["detection_time_s"].isna().tolist() == [False, True]
    row = fddbench.load(tmp_path / "results").iloc[0]
    assert row["outcome"] == "right"
    assert row["false_alarm_time_s"] is pd.NA


HUGE = [
    [{**JAM, "onset_s": 1.0, "amplitude_deg_s": 1.7e308}],
    [{**JAM, "onset_s": at, "amplitude_deg_s": 1.7e308} for at in (1.0, 2.0)],
    [{**JAM, "onset_s": 1.0, "amplitude_percent": 1.7e308}],
    [{"kind": "runaway", "sites": ["r1"], "onset_s": 1.0, "rate_deg_s2": 1.7e308}],
]


def test_a_size_beyond_all_numbers_puts_a_sensor_at_its_stop(tmp_path):
    path = campaign(
        tmp_path, *({"name": f"huge_{n}", "faults": faults} for n, faults in enumerate(HUGE)), duration_s=3.0
    )
    for n in range(len(HUGE)):
        shown = r1(path, f"huge_{n}")
        assert (shown[101:] == 128.0).all(), n
    for backend in ("numpy", "auto"):
        fddbench.run(path, tmp_path / backend, jobs=1, backend=backend)
    assert fddbench.load(tmp_path / "numpy").equals(fddbench.load(tmp_path / "auto"))


def test_what_cannot_be_computed_has_no_score_and_the_page_one_picture_less(tmp_path):
    """A component has no stops: a size that overflows ends in numbers that are none."""
    jam = {"kind": "jam", "sites": ["f1"], "onset_s": 5.0}
    path = campaign(
        tmp_path,
        {"name": "huge", "manoeuvre": "idle", "faults": [{**jam, "amplitude": 1.7e308}]},
        {"name": "sound", "manoeuvre": "idle", "faults": [{**jam, "amplitude": 1.0}]},
        benchmark="jet_engine", sample_s=0.05, detectors=["hinf_identity"],
    )  # fmt: skip
    fddbench.run(path, tmp_path / "results", jobs=1, backend="numpy")
    rows = fddbench.load(tmp_path / "results").set_index("scenario")
    assert rows["status"].to_dict() == {"huge": "nonfinite", "sound": "ok"}
    assert rows.loc["huge", ["outcome", "detection_time_s", "margin_faulty"]].isna().all()
    page = fddbench.report(tmp_path / "results").read_text()
    assert page.count("Onset 5 s; bands of") == 1
