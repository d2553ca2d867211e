"""A data set holds the signals of the flights, no aircraft in two splits, and no truth where detectors look."""

import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
import yaml

import fddbench
from fddbench.cli import main
from fddbench.errors import FddbenchError
from fddbench.results.shards import file_sha256

CAMPAIGN = """
name: labelled
benchmark: yaw_rate
seed: 3
duration_s: 2.0
detectors: [voting_monitor]
dispersions:
  monte_carlo: {runs: 6, mass_kg: {uniform: [180000, 220000]}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - name: two
    manoeuvre: cruise
    faults:
      - {kind: jam, sites: [r1, r2], onset_s: {uniform: [0.3, 0.6]}, delay_s: 0.2, amplitude_deg_s: 2.0}
      - {kind: oscillatory, sites: [r3], onset_s: 1.0, end_s: 1.5, amplitude_deg_s: 1.0, frequency_hz: 2.0}
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("labelled") / "labelled.yaml"
    path.write_text(CAMPAIGN)
    return path


@pytest.fixture(scope="module")
def written(path):
    return fddbench.dataset(path, path.parent / "data", rate_hz=50, dtype="float64")


def _rows(folder, split, below=""):
    return pd.concat(pd.read_parquet(file) for file in sorted((folder / below / split).glob("*.parquet")))


def test_no_aircraft_is_in_two_splits(written):
    cases = pd.read_parquet(written / "cases.parquet")
    assert cases.groupby("split")["run"].agg(lambda runs: sorted(set(runs))).to_dict() == {
        "test": [0, 1, 2, 3, 4, 5],
        "train": [0, 1, 2, 3, 5],
        "validation": [4],
    }
    assert set(cases.loc[cases["split"] == "test", "purpose"]) == {"evaluation"}
    assert set(cases.loc[cases["split"] != "test", "purpose"]) == {"tuning"}
    masses = cases.groupby("split")["p_mass_kg"].agg(set)
    assert not (masses["train"] & masses["test"] | masses["train"] & masses["validation"])


def test_signals_are_those_of_the_flights(path, written):
    """The test split against the flights as `signals` flies them again: every second sample, to the last bit."""
    rows, truth = _rows(written, "test"), _rows(written, "test", "truth")
    again = fddbench.signals(path, "two")
    for i, case in enumerate(again.cases):
        mine, own = rows[rows["case"] == case], truth[truth["case"] == case]
        assert np.array_equal(mine["time_s"], again.time_s[::2])
        for name, values in again.signals.items():
            assert np.array_equal((mine if name in mine else own)[name], values[::2, i])
    assert not set(truth.columns) & set(rows.columns) - {"case", "time_s"}
    assert "r_deg_s" not in rows  # the true yaw rate


def test_labels_say_what_is_faulty(written):
    rows, cases = _rows(written, "test"), pd.read_parquet(written / "cases.parquet")
    cases = cases[cases["split"] == "test"].set_index("case")
    for case, flight in rows.groupby("case", observed=True):
        time_s, healthy = flight["time_s"].to_numpy(), case.startswith("healthy")
        onset_s = np.inf if healthy else cases.loc[case, "f1_onset_s"]
        late = np.zeros(len(time_s)) if healthy else (time_s > 0.999) & (time_s < 1.499)
        assert np.array_equal(flight["faulty_r1"], time_s > onset_s - 1e-9)
        assert np.array_equal(flight["faulty_r2"], time_s > onset_s + 0.2 - 1e-9)
        assert np.array_equal(flight["faulty_r3"], late)
        assert np.array_equal(flight["faulty"], flight[["faulty_r1", "faulty_r2", "faulty_r3"]].max(axis=1))
    assert set(rows["fault"].astype(str)) == {"none", "jam", "jam+oscillatory"}
    assert cases["onset_s"].isna().sum() == 6


def test_the_card_is_true_and_the_same_command_gives_the_same_bytes(path, written, tmp_path):
    card = yaml.safe_load((written / "card.yaml").read_text())
    assert {each["file"]: each["sha256"] for each in card["files"]} == {
        p.relative_to(written).as_posix(): file_sha256(p) for p in written.rglob("*.parquet")
    }
    rows = _rows(written, "train")
    assert card["splits"]["train"]["samples"] == len(rows)
    assert card["faulty_share"] == pytest.approx(rows["faulty"].mean())
    again = fddbench.dataset(path, tmp_path / "again", rate_hz=50, dtype="float64")
    for file in sorted(p.relative_to(written) for p in written.rglob("*") if p.is_file()):
        assert (again / file).read_bytes() == (written / file).read_bytes()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"rate_hz": 30.0}, "the nearest that are: 33.3333333333, 25"),
        ({"rate_hz": 0.0}, "0 < rate <= 100"),
        ({"rate_hz": float("nan")}, "0 < rate <= 100"),
        ({"rate_hz": 200.0}, "0 < rate <= 100"),
        ({"rate_hz": 10.0, "dtype": "int8"}, "allowed: float32, float64"),
    ],
)
def test_what_does_not_fit_is_refused_and_writes_nothing(path, tmp_path, options, said):
    with pytest.raises(FddbenchError, match=said):
        fddbench.dataset(path, tmp_path / "out", **options)
    assert list(tmp_path.iterdir()) == []


def test_wrong_use_is_a_message(path, written, tmp_path, capsys):
    def said(*arguments):
        assert main(["dataset", *map(str, arguments)]) == 2
        return capsys.readouterr().err

    assert "not empty" in said(path, "--output", written, "--rate", 50)
    few = ("--set", "dispersions.monte_carlo.runs=2")
    assert "has 2 Monte-Carlo runs" in said(path, "--output", tmp_path / "o", "--rate", 50, *few)
    assert "no such file" in said("nowhere.yaml", "--output", tmp_path / "o", "--rate", 50)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("options", [[], ["--onnx"]], ids=["scikit-learn", "onnx"])
def test_a_trained_model_comes_back_as_a_detector(tmp_path, options):
    assert main(["init", str(tmp_path), "--trained", "forest"]) == 0
    trained = subprocess.run(
        [sys.executable, str(tmp_path / "detectors" / "train_forest.py"), *options],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    assert "of the samples of validation are classed right" in trained.stdout
    out = tmp_path / "out"
    fddbench.run(tmp_path / "campaigns" / "forest.yaml", out)
    model = "forest.onnx" if options else "forest.joblib"
    assert (out / "detectors" / model).is_file()  # it travels
    rows = fddbench.load(out)
    mine = rows[(rows["detector"] == "forest") & (rows["scenario"] != "healthy")]
    assert (mine["outcome"] == "right").mean() > 0.9
    assert fddbench.verify(out, refly=5, seed=1).sound
