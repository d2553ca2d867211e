"""Cases are (scenario, point, level, run): what is drawn belongs to the run alone, and company changes no row."""

import re

import numpy as np
import pandas as pd
import pytest
import yaml

import fddbench
from fddbench.blocks import llvm
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError, FddbenchError
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events

SWEPT = {
    "kind": "oscillatory", "sites": ["r1"], "onset_s": {"uniform": [0.2, 0.6]}, "amplitude_percent": {"grid": [1, 30]},
    "frequency_hz": {"log_uniform": [0.5, 20]},
}  # fmt: skip
TWO = [
    {"kind": "jam", "mode": "replace", "freeze": True, "sites": ["r1"], "onset_s": {"uniform": [0.3, 0.7]}},
    {
        "kind": "bias",
        "sites": ["r2", "r1"],
        "onset_s": 0.5,
        "end_s": 1.2,
        "amplitude_deg_s": {"normal": {"mean": 3, "std": 1}},
    },
]


def campaign(tmp_path, name="cases.yaml", **changes):
    """A small campaign with a grid, sweeps and draws; flights of 1.5 s, shown by NumPy in a moment."""
    content = {
        "name": "cases", "benchmark": "yaw_rate", "wind": "light", "seed": 9, "duration_s": 1.5,
        "detectors": ["voting_monitor"],
        "dispersions": {
            "grid": {"gust_scale_ratio": [0.0, 0.5]},
            "monte_carlo": {"runs": 3, "mass_kg": {"uniform": [180000, 220000]}},
        },
        "scenarios": [
            {"name": "healthy", "manoeuvre": "cruise"},
            {"name": "swept", "manoeuvre": "cruise", "detection_time_limit_s": 1, "faults": [SWEPT]},
            {"name": "two", "manoeuvre": "cruise", "detection_time_limit_s": 1, "faults": TWO},
        ],
    }  # fmt: skip
    path = tmp_path / name
    path.write_text(yaml.safe_dump(content | changes))
    return path


def flown(path, *overrides, backend="numpy"):
    """Rows of all cases, by their names and detectors."""
    assembly = assemble(read_campaign(path, overrides))
    rows, _ = rows_and_events(Flyer(assembly, backend), np.arange(assembly.plan.n_cases))
    frame = rows.to_pandas()
    frame["case"] = assembly.plan.names(np.repeat(np.arange(assembly.plan.n_cases), len(assembly.detectors)))
    return frame.set_index(["case", "detector"])


def same(before, after, renamed=None):
    """The rows of one table, whose flights may have other names in the other, are equal there."""
    renamed = renamed or (lambda case: case)
    for (case, detector), row in before.iterrows():
        other = after.loc[renamed(case), detector]
        for column in before.columns.difference(["point", "level"]):
            a, b = row[column], other[column]
            assert (pd.isna(a) and pd.isna(b)) or a == b, (case, detector, column, a, b)


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    return flown(campaign(tmp_path_factory.mktemp("cases")))


def test_names_are_addresses_in_plan_order(rows):
    names = list(rows.index.get_level_values("case"))
    assert names[:7] == [f"healthy/{point}/0/{run}" for point in (0, 1) for run in range(3)] + ["swept/0/0/0"]
    assert names[-1] == "two/1/0/2"
    assert len(names) == 6 + 12 + 6
    assert (rows["p_gust_scale_ratio"] == np.where(rows["point"] == 1, 0.5, 0.0)).all()


def test_a_run_is_the_same_draw_at_every_point_and_level_and_in_every_scenario(rows):
    for run, group in rows.groupby("run"):
        assert group["p_mass_kg"].nunique() == 1, run
        for column in ("f1_onset_s", "f1_frequency_hz", "f2_amplitude_deg_s"):
            assert group.groupby("scenario")[column].nunique().max() == 1
    assert rows["p_mass_kg"].nunique() == 3
    assert rows.loc[rows["scenario"] == "swept", "f1_onset_s"].nunique() == 3
    onsets = rows.groupby(["scenario", "run"])["f1_onset_s"].first().unstack("scenario")
    assert (onsets["swept"] != onsets["two"]).all(), "every scenario draws its own faults"


def test_columns_say_what_was_flown(rows):
    swept, two = (rows[rows["scenario"] == name] for name in ("swept", "two"))
    assert (swept["f1_amplitude_percent"] == np.where(swept["level"] == 1, 30.0, 1.0)).all()
    assert (swept["f1_onset_s"] == swept["onset_s"]).all()
    assert swept["f1_onset_s"].between(0.2, 0.6).all()
    assert swept["f1_frequency_hz"].between(0.5, 20.0).all()
    assert swept["f2_amplitude_deg_s"].isna().all()
    assert two["f2_amplitude_deg_s"].notna().all()
    assert (two["onset_s"] == np.minimum(two["f1_onset_s"], 0.5)).all()
    assert rows.loc[rows["scenario"] == "healthy", [c for c in rows if re.match(r"f\d_", c)]].isna().all(axis=None)


def test_times_are_rounded_to_the_sample(rows):
    onset = rows["f1_onset_s"].dropna().to_numpy()
    assert (onset == np.round(np.rint(onset * 100) / 100, 9)).all()


def test_another_grid_value_only_numbers_the_points_anew(tmp_path, rows):
    more = flown(campaign(tmp_path), "dispersions.grid.gust_scale_ratio=[0, 0.25, 0.5]")
    same(rows, more, lambda case: re.sub(r"^(\w+)/1/", r"\1/2/", case))


def test_another_value_of_a_sweep_only_numbers_the_levels_anew(tmp_path, rows):
    more = flown(campaign(tmp_path), "scenarios.swept.faults.0.amplitude_percent.grid=[1, 5, 30]")
    same(rows, more, lambda case: re.sub(r"^(swept/\d+)/1/", r"\1/2/", case))


def test_more_runs_another_scenario_and_another_detector_change_no_row(tmp_path, rows):
    same(rows, flown(campaign(tmp_path), "dispersions.monte_carlo.runs=5"))
    same(rows, flown(campaign(tmp_path), "detectors=[sliding_mode_published, voting_monitor]"))
    assembly = read_campaign(campaign(tmp_path))
    first = {"name": "first", "manoeuvre": "cruise", "runs": 2, "faults": [TWO[1], {**SWEPT, "onset_s": 0.4}]}
    content = yaml.safe_load(assembly.text)
    same(rows, flown(campaign(tmp_path, scenarios=[{**first, "detection_time_limit_s": 1}, *content["scenarios"]])))


def test_a_drawn_flight_is_the_flight_with_its_numbers_written_down(tmp_path, rows):
    for run in range(3):
        case = rows.loc[f"two/1/0/{run}", "voting_monitor"]
        written = flown(
            campaign(tmp_path),
            f"scenarios.two.faults.0.onset_s={case.f1_onset_s}",
            f"scenarios.two.faults.1.amplitude_deg_s={float(case.f2_amplitude_deg_s)!r}",
        ).loc[f"two/1/0/{run}", "voting_monitor"]
        for column in (
            "outcome",
            "onset_s",
            "detection_time_limit_s",
            "margin_healthy",
            "margin_faulty",
            "alarm_time_s",
        ):
            assert case[column] == written[column] or pd.isna(case[column]), column


def test_the_flights_last_by_the_latest_onset_of_their_level(tmp_path):
    path = campaign(tmp_path)
    document = yaml.safe_load(path.read_text())
    del document["duration_s"]
    document["scenarios"][1]["faults"][0]["delay_s"] = {"grid": [0, 2]}
    document["scenarios"][1]["faults"][0]["sites"] = ["r1", "r2"]
    path.write_text(yaml.safe_dump(document))
    swept = fddbench.plan(path).scenarios[1]
    # levels: amplitude, then delay, by the alphabet of the keys
    assert swept.durations_s == (6.6, 8.6, 6.6, 8.6)
    assert swept.samples == (661, 861, 661, 861)


@pytest.mark.skipif(not llvm.available(), reason="needs llvmlite")
def test_compiled_flights_chunks_and_jobs_give_the_same_rows(tmp_path, rows):
    same(rows, flown(campaign(tmp_path), backend="llvm"))
    folder = tmp_path / "results"
    fddbench.run(campaign(tmp_path), folder, jobs=2)
    loaded = fddbench.load(folder)
    assert list(loaded["case"]) == list(rows.index.get_level_values("case"))
    same(rows, loaded.astype({"case": str, "detector": str}).set_index(["case", "detector"]))


def test_signals_and_scores_take_addresses(tmp_path, rows):
    path = campaign(tmp_path)
    recording = fddbench.signals(path, "two", ["two/1/0/2", (0, 0, 1), "0/0/0"])
    assert recording.cases == ("two/1/0/2", "two/0/0/1", "two/0/0/0")
    onsets = [rows.loc[case, "voting_monitor"].onset_s for case in recording.cases]
    np.testing.assert_array_equal(recording.onset_s, onsets)
    scored = fddbench.score(path, ["healthy/1/0/2"], np.zeros((151, 3, 1)))
    assert scored["case"].tolist() == ["healthy/1/0/2"]
    assert scored["outcome"].tolist() == ["quiet"]


@pytest.mark.parametrize(
    ("case", "message"),
    [
        ("two/2/0/0", "there is no case 'two/2/0/0': scenario 'two' has the points 0 to 1"),
        ("two/0/1/0", "has the levels 0 to 0"),
        ((0, 0, 3), "has the runs 0 to 2"),
        (7, "a case is named 'scenario/point/level/run', for instance 'two/0/0/17'; got 7"),
        ("two/0/0", "a case is named"),
        ("healthy/0/0/0", "is a case of another scenario than 'two'"),
    ],
)
def test_what_is_no_address_is_refused_with_what_there_is(tmp_path, case, message):
    with pytest.raises(FddbenchError, match=re.escape(message)):
        fddbench.signals(campaign(tmp_path), "two", [case])


def test_the_air_and_the_noise_of_a_run_are_the_same_at_every_point(tmp_path):
    path = campaign(tmp_path)
    signals = {
        scenario: fddbench.signals(path, scenario, ["0/0/1", "1/0/1"]).signals for scenario in ("healthy", "two")
    }
    before = 30
    for name, values in signals["healthy"].items():
        np.testing.assert_array_equal(values[:before], signals["two"][name][:before])
    noise = signals["healthy"]["r_deg_s_1"] - signals["healthy"]["r_true_deg_s"]
    np.testing.assert_allclose(noise[:, 0], noise[:, 1], atol=1e-12)
    assert np.std(noise[:, 0]) > 0.0


def test_two_names_with_the_same_random_numbers_are_refused(tmp_path):
    """Two of some hundred thousand names share their 31 bits; who names them so is told."""
    from fddbench.campaign.streams import scenario_stream

    known: dict[int, str] = {}
    for number in range(400_000):
        name = f"s{number}"
        other = known.setdefault(scenario_stream("evaluation", name), name)
        if other != name:
            break
    assert other != name
    scenarios = [{"name": each, "manoeuvre": "cruise"} for each in (other, name)]
    with pytest.raises(CampaignError, match=f"{other!r} and {name!r} give the same random numbers"):
        read_campaign(campaign(tmp_path, scenarios=scenarios))
