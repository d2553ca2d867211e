"""What a clumsy or hostile user has done to it once: plug-ins that misbehave, folders that were tampered with."""

import json
import shutil

import pytest
from tests.cli.test_commands import TINY

from fddbench import gallery, load
from fddbench.cli import main

SOUND = (gallery.folder("detectors") / "cusum_example.py").read_text(encoding="utf-8")
DESIGN = (gallery.folder("detectors") / "cusum_example.yaml").read_text(encoding="utf-8")


@pytest.fixture
def plugin(tmp_path, monkeypatch):
    """Run the tiny campaign with a changed copy of the example; exit code."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    (tmp_path / "detectors").mkdir()

    def run(*changes, others="", backend="auto"):
        text = SOUND
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "detectors" / "mine.py").write_text(text)
        (tmp_path / "detectors" / "mine.yaml").write_text(DESIGN.replace("cusum_example.py", "mine.py"))
        detectors = f"detectors=[mine{others}]"
        return main(
            ["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out", "--backend", backend, "--set", detectors]
        )

    return run


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("import numpy as np", "import sys; sys.exit()"), "does not run: SystemExit"),
        (("return cls(gains, len(bus.sites))", "raise ValueError('no')"), "from_design raised ValueError: no"),
        (("return cls(gains, len(bus.sites))", "raise SystemExit(0)"), "from_design raised SystemExit"),
        (("return cls(gains, len(bus.sites))", "return None"), "needs an attribute `states`"),
        (("    recorded = ", "    shown = "), "needs an attribute `recorded`"),
        (
            ("self.states.zeros(n_cases)", "self.states.zeros(n_cases + 1)"),
            r"start(2) needs to give an array of shape (6, 2)",
        ),
        (("self.states.zeros(n_cases)", "1 / 0"), "start(2) raised ZeroDivisionError"),
        (("    Gains = CusumGains", "    Gains = dict"), "needs a class Gains"),
        (("x = self.states", "self.calls = getattr(self, 'calls', 0) + 1; x = self.states"), "keep it in the state"),
    ],
)
def test_what_is_no_detector_is_a_mistake_and_nothing_is_written(plugin, tmp_path, capsys, change, message):
    assert plugin(change) == 2
    error = capsys.readouterr().err
    assert message in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("backend", ["auto", "numpy"])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("x = self", "raise SystemExit(0); x = self"), "SystemExit"),
        (("x = self", "measured.r_deg_s[...] = 99.0; x = self"), "read-only"),
        (("x = self", "measured.mass_kg *= 2.0; x = self"), "read-only"),
        (
            ("return self.states.pack(sum_deg_s=sums, declared=declared), verdict", "return sums, verdict"),
            "a step gives a state",
        ),
        (('signals={"sum_deg_s": worst, "limit_deg_s": limit}', "signals={}"), "recorded announces"),
        (("verdict = Verdict(declared", "verdict = Verdict(declared[:2]"), "a verdict needs declared of shape"),
        (("x = self", "raise ValueError('five\\nlines' * 500); x = self"), "..."),
    ],
)
def test_a_misbehaving_step_is_a_row_and_spoils_no_other(plugin, tmp_path, backend, change, message):
    assert plugin(change, others=", sliding_mode_published, voting_monitor", backend=backend) == 1
    rows = load(tmp_path / "out")
    mine = rows[rows["detector"] == "mine"]
    assert set(mine["status"]) == {"error"}
    assert all(message in reason and len(reason) <= 200 and "\n" not in reason for reason in mine["reason"])
    shutil.rmtree(tmp_path / "out")
    assert plugin(others=", sliding_mode_published, voting_monitor") == 0
    again = load(tmp_path / "out")
    for detector in ("sliding_mode_published", "voting_monitor"):
        a, b = (frame[frame["detector"] == detector].reset_index(drop=True) for frame in (rows, again))
        assert a.equals(b)


@pytest.mark.parametrize(("value", "status"), [("0.5", "nonfinite"), ("np.nan", "nonfinite"), ("2.0", "nonfinite")])
def test_a_verdict_that_is_none_is_not_repaired(plugin, tmp_path, value, status):
    assert plugin(("x.declared)\n        worst", f"x.declared) * 0.0 + {value}\n        worst")) == 1
    assert set(load(tmp_path / "out")["status"]) == {status}


def test_two_files_of_one_name_are_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for folder, text in (("camp/detectors", SOUND), ("detectors", SOUND + "\n# another\n")):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "det.py").write_text(text)
    (tmp_path / "camp/detectors/a.yaml").write_text(DESIGN.replace("cusum_example.py", "det.py"))
    (tmp_path / "detectors/b.yaml").write_text(DESIGN.replace("cusum_example.py", "det.py"))
    (tmp_path / "camp/tiny.yaml").write_text(TINY)
    assert main(["check", "camp/tiny.yaml", "--set", "detectors=[a, b]"]) == 2
    assert "different files of the same name" in capsys.readouterr().err


@pytest.fixture
def done(tmp_path, monkeypatch):
    """Folder of a finished run."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
    return tmp_path / "out"


def test_a_report_in_the_folder_is_no_obstacle(done):
    assert main(["report", "out"]) == 0
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out", "--fresh"]) == 0
    assert not (done / "report.html").exists()
    assert len(load(done)) == 4


@pytest.mark.parametrize("name", ["campaign.yaml", "detectors/voting_monitor.yaml"])
@pytest.mark.parametrize("how", ["changed", "gone"])
def test_tampered_files_are_found_and_put_back(done, capsys, name, how):
    path = done / name
    text = path.read_text()
    if how == "gone":
        path.unlink()
    else:
        path.write_text(text.replace("seed: 1", "seed: 2").replace("confirm_one_s: 1.0", "confirm_one_s: 2.0"))
    expected = 0 if (how, name) == ("gone", "detectors/voting_monitor.yaml") else 2  # the shipped one is the same
    assert main(["report", "out"]) == expected
    assert expected == 0 or "Run the campaign again on this folder" in capsys.readouterr().err
    next((done / "rows").iterdir()).unlink()
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
    assert path.read_text() == text
    assert main(["report", "out"]) == 0


@pytest.mark.parametrize("damage", ["[]", "{}", "not json"])
def test_broken_provenance(done, capsys, damage):
    (done / "provenance.json").write_text(damage)
    for command in (["scores", "out"], ["report", "out"], ["run", "tiny.yaml", "--out", "out"]):
        assert main(command) == 2
        assert "Traceback" not in capsys.readouterr().err
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out", "--fresh"]) == 0


def test_a_doctored_manifest_counts_nothing_twice_and_reads_nothing_elsewhere(done):
    before = load(done)
    manifest = done / "manifest.jsonl"
    line = manifest.read_text()
    elsewhere = json.loads(line) | {"rows": "../out/" + json.loads(line)["rows"], "cases": [[7, 1]]}
    manifest.write_bytes(line.encode() * 2 + json.dumps(elsewhere).encode() + b"\n\xff\xfe\n")
    assert load(done).equals(before)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
    assert load(done).equals(before)


def test_a_refused_folder_is_not_written_into(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    for out in (".", ""):
        assert main(["run", "tiny.yaml", "--out", out]) == 2
        assert "tiny.yaml" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["tiny.yaml"]


def test_a_campaign_of_healthy_flights_only(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "h.yaml").write_text(TINY[: TINY.index("  - {name: jam_b")])
    assert main(["run", "h.yaml", "--quiet", "--jobs", "1"]) == 0
    assert main(["report", "results/tiny"]) == 0


def test_draws_that_the_benchmark_does_not_have_are_infeasible(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wide = "dispersions: {monte_carlo: {runs: 40, mass_kg: {normal: {mean: 200000, std: 60000}}}}\nscenarios"
    (tmp_path / "n.yaml").write_text(TINY.replace("scenarios", wide, 1))
    assert main(["run", "n.yaml", "--quiet", "--jobs", "1"]) == 0
    rows = load("results/tiny")
    outside = (rows["p_mass_kg"] < 100e3) | (rows["p_mass_kg"] > 260e3)
    assert outside.any()
    assert set(rows[outside]["status"]) == {"infeasible"}
    assert rows[outside]["reason"].str.contains("drawn mass_kg").all()


def test_a_full_disk_is_said_and_nothing_is_lost(done, capsys, monkeypatch):
    from fddbench.results import shards

    def full(path, data):
        raise OSError(28, "No space left on device", str(path))

    next((done / "rows").iterdir()).unlink()
    monkeypatch.setattr(shards, "write_bytes", full)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 2
    assert "No space left on device" in capsys.readouterr().err
    monkeypatch.undo()
    monkeypatch.chdir(done.parent)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
