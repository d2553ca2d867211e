"""The commands as a user types them: exit codes, messages, and nothing written by a mistake."""

import json
import subprocess
import sys

import pytest
import yaml

from fddbench import gallery
from fddbench.cli import main
from fddbench.cli.main import parser

TINY = """\
name: tiny
benchmark: yaw_rate
seed: 1
duration_s: 3.0
detectors: [sliding_mode_published, voting_monitor]
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam_b, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 2.0, amplitude_percent: 5}]}
"""


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    return tmp_path


def test_run_report_scores_check(tiny, capsys):
    assert main(["check", "tiny.yaml"]) == 0
    assert "2 cases x 2 detectors" in capsys.readouterr().out
    assert {path.name for path in tiny.iterdir()} == {"tiny.yaml"}
    assert main(["run", "tiny.yaml", "--jobs", "1"]) == 0
    out = capsys.readouterr()
    assert "jam_b" in out.out
    assert "next: fddbench report results/tiny" in out.out
    assert "tiny: 2/2 flights" in out.err
    assert main(["report", "results/tiny"]) == 0
    page = (tiny / "results" / "tiny" / "report.html").read_text()
    assert "sliding_mode_published" in page
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert main(["scores", "results/tiny"]) == 0
    capsys.readouterr()
    assert main(["run", "tiny.yaml", "--jobs", "1", "--quiet"]) == 0
    assert "0 flights flown, 2 found done" in capsys.readouterr().out


def test_set_changes_the_campaign_and_its_folder_is_another(tiny, capsys):
    assert main(["run", "tiny.yaml", "--jobs", "1", "--quiet"]) == 0
    assert (
        main(["run", "tiny.yaml", "--jobs", "1", "--quiet", "--set", "scenarios.jam_b.faults.0.amplitude_percent=6"])
        == 2
    )
    assert "amplitude_percent" in capsys.readouterr().err
    assert main(["run", "tiny.yaml", "--quiet", "--set", "seed=2", "--out", "elsewhere"]) == 0


@pytest.mark.parametrize(
    "argv",
    [
        ["run", "missing.yaml"],
        ["run", "tiny.yaml", "--set", "sed=3"],
        ["run", "tiny.yaml", "--set", "detectors=[nothing]"],
        ["check", "."],
        ["report", "missing"],
        ["report", "."],
        ["scores", "."],
        ["run", "tiny.yaml", "--out", "tiny.yaml"],
        ["run", "tiny.yaml", "--out", "tiny.yaml/below"],
    ],
)
def test_a_mistake_exits_with_two_and_writes_nothing(tiny, capsys, argv):
    assert main(argv) == 2
    assert {path.name for path in tiny.iterdir()} == {"tiny.yaml"}
    assert (tiny / "tiny.yaml").read_text() == TINY
    message = capsys.readouterr().err
    assert message.startswith("fddbench: ")
    assert "Traceback" not in message


@pytest.mark.parametrize("argv", [["run"], ["fly"], ["run", "x.yaml", "--jobs", "0"], ["run", "x.yaml", "--jobs", "²"]])
def test_wrong_usage_exits_with_two(argv, capsys):
    with pytest.raises(SystemExit) as exit_:
        main(argv)
    assert exit_.value.code == 2
    assert "usage: fddbench" in capsys.readouterr().err


def test_a_failing_detector_of_ones_own_exits_with_one(tiny, capsys):
    (tiny / "detectors").mkdir()
    (tiny / "detectors" / "mine.py").write_text(
        (gallery.folder("detectors") / "cusum_example.py")
        .read_text()
        .replace("distance = ", "0 / int((measured.mass_kg < 1e3).any())\n        distance = ")
        .replace("    Gains = ", "    batched = True\n    Gains = ")
    )
    design = yaml.safe_load((gallery.folder("detectors") / "cusum_example.yaml").read_text())
    (tiny / "detectors" / "mine.yaml").write_text(yaml.safe_dump({**design, "kind": "mine.py:Cusum"}))
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--set", "detectors=[mine, voting_monitor]"]) == 1
    assert (
        "error: mine, 2 flights (case healthy/0/0/0, jam_b/0/0/0): ZeroDivisionError: division by zero"
        in capsys.readouterr().out
    )
    assert main(["report", "results/tiny"]) == 0


def test_the_plug_in_example_flies(tiny, capsys):
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--set", "detectors=[cusum_example]"]) == 0
    assert (tiny / "results/tiny/detectors/cusum_example.py").is_file()


def test_list_names_everything(capsys):
    assert main(["list"]) == 0
    out = capsys.readouterr().out
    for name in ("yaw_rate", "oscillatory", "closest_two", "sliding_mode", "yaw_rate_table8", "cusum_example"):
        assert name in out


def test_init_copies_and_never_overwrites(tmp_path, capsys):
    (tmp_path / "campaigns").mkdir()
    (tmp_path / "campaigns" / "smoke.yaml").write_text("mine")
    assert main(["init", str(tmp_path)]) == 0
    assert (tmp_path / "campaigns" / "smoke.yaml").read_text() == "mine"
    assert (tmp_path / "detectors" / "voting_monitor.yaml").is_file()


def test_schema_is_json(capsys):
    assert main(["schema"]) == 0
    assert "scenarios" in json.loads(capsys.readouterr().out)["properties"]


@pytest.mark.parametrize("path", sorted(gallery.folder("campaigns").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_shipped_campaign_checks(path, capsys):
    assert main(["check", path.stem]) == 0


def test_help_imports_nothing_heavy():
    code = "import sys; from fddbench.cli.main import parser; parser().format_help(); print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numpy", "scipy", "pandas", "pyarrow", "joblib", "cvxpy", "matplotlib", "rich", "pydantic"} & set(
        loaded
    )


def test_every_command_has_help():
    for action in parser()._subparsers._group_actions:
        for sub in action.choices.values():
            assert len(sub.description) > 20


def test_a_closed_pipe_is_no_traceback(tiny):
    command = f"{sys.executable} -m fddbench list | head -1"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "benchmarks"
    assert done.stderr == ""


def test_several_campaigns_fly_in_turn_and_the_worst_exit_code_counts(tiny, capsys):
    (tiny / "other.yaml").write_text(TINY.replace("name: tiny", "name: other"))
    (tiny / "wrong.yaml").write_text(TINY.replace("seed:", "sed:"))
    assert main(["run", "tiny.yaml", "other.yaml", "--quiet"]) == 0
    capsys.readouterr()
    assert main(["run", "wrong.yaml", "tiny.yaml", "--quiet"]) == 2
    told = capsys.readouterr()
    assert "sed" in told.err
    assert [line.split(maxsplit=1) for line in told.out.splitlines()[-2:]] == [
        ["wrong.yaml", "not flown, see above"],
        ["tiny.yaml", "done"],
    ]
    assert {path.name for path in (tiny / "results").iterdir()} == {"tiny", "other"}
    assert main(["run", "tiny.yaml", "other.yaml", "--out", "x"]) == 2
    assert "--out names the folder of one campaign" in capsys.readouterr().err
