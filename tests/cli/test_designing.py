"""`fddbench design` and `fddbench tune` as a user types them."""

import pytest
import yaml

from fddbench.cli import main

TUNING = """\
name: small_tuning
benchmark: jet_engine
purpose: tuning
seed: 9
sample_s: 0.05
duration_s: 20.0
detectors: [hinf_identity]
dispersions: {monte_carlo: {runs: 300}}
scenarios:
  - {name: healthy, manoeuvre: steps}
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tuning.yaml").write_text(TUNING)
    return tmp_path


def test_tuned_thresholds_keep_the_rate_when_the_tuning_flights_are_flown(folder, capsys):
    assert main(["tune", "hinf_identity", "tuning.yaml", "--false-alarm-rate", "0.05"]) == 0
    assert "of these 300 flights" in capsys.readouterr().out
    design = yaml.safe_load((folder / "detectors" / "hinf_identity_tuned.yaml").read_text())
    assert {"campaign": "small_tuning", "seed": 9} in design["tuned_on"]
    assert main(["run", "tuning.yaml", "--quiet", "--jobs", "1", "--set", "detectors=[hinf_identity_tuned]"]) == 0
    import fddbench

    rows = fddbench.load(folder / "results" / "small_tuning")
    assert 13 <= int((rows["outcome"] == "false_alarm").sum()) <= 15
    # its rates flatter it, and every table says so
    assert fddbench.summary(folder / "results" / "small_tuning")["in_sample"].all()
    assert fddbench.alarms(folder / "results" / "small_tuning")["in_sample"].all()
    assert "* in sample" in capsys.readouterr().out


def test_flights_that_tuned_a_design_do_not_score_it(folder, capsys):
    assert main(["tune", "hinf_identity", "tuning.yaml"]) == 0
    evaluation = TUNING.replace("purpose: tuning", "purpose: evaluation").replace(
        "hinf_identity]", "hinf_identity_tuned]"
    )
    (folder / "evaluation.yaml").write_text(evaluation)
    capsys.readouterr()
    assert main(["run", "evaluation.yaml"]) == 2
    assert "was tuned on campaign 'small_tuning' with seed 9" in capsys.readouterr().err
    assert main(["check", "evaluation.yaml", "--set", "seed=10"]) == 0


def test_tuning_on_an_evaluation_is_refused(folder, capsys):
    (folder / "evaluation.yaml").write_text(TUNING.replace("purpose: tuning", "purpose: evaluation"))
    assert main(["tune", "hinf_identity", "evaluation.yaml"]) == 2
    assert "has purpose: evaluation" in capsys.readouterr().err
    assert not (folder / "detectors").exists()


def test_a_file_is_not_replaced_by_mistake(folder, capsys):
    assert main(["tune", "hinf_identity", "tuning.yaml", "--output", "mine.yaml"]) == 0
    before = (folder / "mine.yaml").read_text()
    assert main(["tune", "mine.yaml", "tuning.yaml", "--output", "mine.yaml", "--false-alarm-rate", "0.3"]) == 2
    assert "mine.yaml exists" in capsys.readouterr().err
    assert (folder / "mine.yaml").read_text() == before
    assert (
        main(["tune", "mine.yaml", "tuning.yaml", "--output", "mine.yaml", "--false-alarm-rate", "0.3", "--force"]) == 0
    )
    assert (folder / "mine.yaml").read_text() != before


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["tune", "no_such", "tuning.yaml"], "no design is called 'no_such'"),
        (["tune", "voting_monitor", "tuning.yaml"], "voting_monitor needs the signals"),
        (["design", "tuning.yaml"], "has no recipe"),
        (["design", "missing.yaml"], "missing.yaml"),
    ],
)
def test_mistakes(folder, capsys, argv, message):
    assert main(argv) == 2
    assert message in capsys.readouterr().err


def test_kinds_without_thresholds_per_signal_cannot_be_tuned(folder, capsys):
    text = (
        TUNING.replace("jet_engine", "yaw_rate").replace("steps", "cruise").replace("hinf_identity", "voting_monitor")
    )
    (folder / "yaw.yaml").write_text(text.replace("runs: 300", "runs: 1"))
    assert main(["tune", "voting_monitor", "yaw.yaml"]) == 2
    assert "cannot be tuned" in capsys.readouterr().err


def test_design_prints_a_design_with_its_gamma(folder, capsys):
    from fddbench import gallery

    path = gallery.folder("detectors") / "hinf_identity.yaml"
    assert main(["design", str(path)]) == 0
    out = capsys.readouterr()
    assert yaml.safe_load(out.out)["recipe"]["found"]["gamma_optimum"] == pytest.approx(0.334, abs=5e-4)
    assert "gamma: 0.3406" in out.err
    assert main(["design", str(path), "--output", "new/mine.yaml"]) == 0
    assert "next: fddbench tune" in capsys.readouterr().err
    assert yaml.safe_load((folder / "new" / "mine.yaml").read_text())["tuned_on"] is None
