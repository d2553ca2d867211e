"""`fddbench design` and `fddbench tune` as a user types them."""

import pytest
import yaml

from fddbench import gallery
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


def test_of_an_unknown_design_those_of_ones_own_are_named_and_the_shipped_ones_counted(folder, capsys):
    (folder / "detectors").mkdir()
    (folder / "detectors" / "mine.yaml").write_text("kind: watcher\n")
    shipped = len(list(gallery.folder("detectors").glob("*.yaml")))
    assert main(["export", "voting_montor"]) == 2
    assert (
        f"no design is called 'voting_montor'. Did you mean 'voting_monitor'? Known: mine, {shipped} shipped designs "
        "(`fddbench list designs`). Designs are files: put yours at detectors/voting_montor.yaml\n"
    ) in capsys.readouterr().err


YAW = """\
name: yaw
benchmark: yaw_rate
purpose: tuning
seed: 9
sensors: white
duration_s: 4.0
detectors: [voting_monitor]
dispersions: {monte_carlo: {runs: 60, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: roll_doublet}
"""


def test_tunes_a_kind_that_only_names_its_thresholds_by_one_factor(folder, capsys):
    (folder / "yaw.yaml").write_text(YAW)
    assert main(["tune", "voting_monitor", "yaw.yaml", "--per-flight", "0.1"]) == 0
    said = capsys.readouterr().out
    assert "of these 60 flights of 60 runs" in said
    assert "on other flights:" in said
    design = yaml.safe_load((folder / "detectors" / "voting_monitor_tuned.yaml").read_text())
    assert design["tuned_on"] == [{"campaign": "yaw", "seed": 9}]
    level = design["gains"]["flag_threshold_deg_s"]
    # flown again, these alarms are those of the tuning; a little less, and the target is not kept
    sweep = f"detectors=[{{design: voting_monitor, sweep: {{flag_threshold_deg_s: [{level}, {0.994 * level}]}}}}]"
    assert main(["run", "yaw.yaml", "--quiet", "--jobs", "1", "--set", sweep]) == 0
    import fddbench

    alarms = fddbench.alarms(folder / "results" / "yaw")["alarms"].tolist()
    assert f"false alarms: {alarms[0]} of these" in said
    assert alarms[0] == 5 < alarms[1]  # 6 of 61 promise less than 10 %


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["--per-flight", "0.001"], "That needs about 999 runs without one"),
        (
            ["--per-hour", "0.1", "--confidence", "0.95"],
            "cannot promise at most 0.1 per hour on other flights, with 95 %",
        ),
        (["--confidence", "0.9"], "a confidence is about other flights"),
        (["--per-flight", "0"], "a share above 0 and below 1"),
        (["--by", "residual"], "voting_monitor designs are tuned by factor"),
        (["--only", "flag_threshold"], "Did you mean 'flag_threshold_deg_s'"),
        (["--set", "dispersions.monte_carlo.runs=1"], "tell nothing of other flights"),
        (
            ["--set", "scenarios.healthy.faults=[{kind: jam, sites: [r1], onset_s: 1, amplitude_deg_s: 1}]"],
            "no healthy scenario",
        ),
    ],
)
def test_targets_that_cannot_be_met(folder, capsys, argv, message):
    (folder / "yaw.yaml").write_text(YAW)
    assert main(["tune", "voting_monitor", "yaw.yaml", *argv]) == 2
    assert message in capsys.readouterr().err


OWN = """\
from typing import ClassVar
from pydantic import BaseModel
from fddbench.interfaces import Verdict

class Gains(BaseModel):
    SAID
    level_deg_s: float
    patience: int = 3

class Mine:
    Gains = Gains
    isolates, watches = False, ()
    def __init__(self, gains):
        self.gains = gains
    @classmethod
    def from_design(cls, gains, bus):
        return cls(gains)
    def start(self):
        return 0
    def step(self, count, measured):
        apart = max(abs(r - measured.r_voted_deg_s) for r in measured.r_deg_s)
        count = count + 1 if apart * self.gains.level_deg_s > 1.0 else 0
        return count, Verdict(None, apart * self.gains.level_deg_s, alarm=count >= self.gains.patience)
"""


def test_tunes_a_detector_of_ordinary_python_that_says_what_quiets_it(folder, capsys):
    (folder / "yaw.yaml").write_text(YAW.replace("4.0", "0.2").replace("runs: 60", "runs: 20"))
    (folder / "mine.yaml").write_text("kind: mine.py:Mine\nsource: me\ntuned_on: null\ngains: {level_deg_s: 10.0}\n")
    for said, message in (
        ("", "does not say which gains are thresholds"),
        ("THRESHOLDS: ClassVar = {'level': 'up'}", "names 'level'"),
        ("THRESHOLDS: ClassVar = {'level_deg_s': 'left'}", "up or down"),
    ):
        (folder / "mine.py").write_text(OWN.replace("SAID", said))
        assert main(["tune", "mine.yaml", "yaw.yaml"]) == 2
        assert message in capsys.readouterr().err
    (folder / "mine.py").write_text(OWN.replace("SAID", "THRESHOLDS: ClassVar = {'level_deg_s': 'down'}"))
    assert main(["tune", "mine.yaml", "yaw.yaml", "--false-alarm-rate", "0.1", "--output", "new/mine.yaml"]) == 0
    assert "false alarms: 2 of these 20" in capsys.readouterr().out
    assert 10.0 < yaml.safe_load((folder / "new" / "mine.yaml").read_text())["gains"]["level_deg_s"] < 100.0


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
