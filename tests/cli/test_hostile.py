"""What a clumsy or hostile user has done to it once: plug-ins that misbehave, folders that were tampered with."""

import json
import shutil
import tempfile
from pathlib import Path

import pytest
from tests.cli.test_commands import TINY

from fddbench import gallery, load
from fddbench.cli import main
from fddbench.errors import ResultsError

SOUND = (gallery.folder("detectors") / "cusum_example.py").read_text(encoding="utf-8")
DESIGN = (gallery.folder("detectors") / "cusum_example.yaml").read_text(encoding="utf-8")


@pytest.fixture
def plugin(tmp_path, monkeypatch):
    """Run the tiny campaign with a changed copy of the example; exit code."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    (tmp_path / "detectors").mkdir()

    def run(*changes, others="", backend="auto", command="run"):
        text = SOUND.replace("import Layout, ", "import Layout, Nothing, ")
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        text = text.replace("    Gains = ", "    batched = True\n    Gains = ")  # written for many flights side by side
        (tmp_path / "detectors" / "mine.py").write_text(text)
        (tmp_path / "detectors" / "mine.yaml").write_text(DESIGN.replace("cusum_example.py", "mine.py"))
        options = ["--quiet", "--jobs", "1", "--out", "out", "--backend", backend] if command == "run" else []
        return main([command, "tiny.yaml", *options, "--set", f"detectors=[mine{others}]"])

    return run


FROM_DESIGN = 'return cls(gains, bus.redundant("r_deg_s"))'
START = "return CusumState(sum_deg_s=0.0, declared=0.0)"
FIRST = "        distance = "
LAST = "return CusumState(sum_deg_s=sums, declared=declared), verdict"


def line_of(path, words):
    """Number of the first line of a file that holds these words."""
    return 1 + next(n for n, line in enumerate(path.read_text().splitlines()) if words in line)


@pytest.mark.parametrize(
    ("change", "message", "place"),
    [
        (("import numpy as np", "import sys; sys.exit()"), "does not run: SystemExit", ""),
        ((FROM_DESIGN, "raise ValueError('no')"), "from_design raised ValueError: no", "raise ValueError"),
        ((FROM_DESIGN, "raise SystemExit(0)"), "from_design raised SystemExit", "raise SystemExit"),
        ((FROM_DESIGN, "return None"), "from_design gave no detector: it has no start and no step", ""),
        (("    recorded = ", "    shown = "), "recorded announces []", ""),
        (("        self.states = ", "        self.kept = "), "with batched = True it needs an attribute `states`", ""),
        (
            (START, "return CusumState(sum_deg_s=np.zeros(4), declared=0.0)"),
            "its start is no record of its states",
            START,
        ),
        ((START, "return 0.0"), "need a record of the fields ['sum_deg_s', 'declared'], got float", "def start"),
        (
            (START, "return Nothing()"),
            "need exactly the fields ['sum_deg_s', 'declared'], missing=['sum_deg_s', 'declared'], unknown=[]",
            "def start",
        ),
        ((START, "return 1 / 0"), "its start is no record of its states: ZeroDivisionError", "return 1 / 0"),
        (("    Gains = CusumGains", "    Gains = dict"), "needs a class Gains", ""),
        ((FIRST, "        self.calls = getattr(self, 'calls', 0) + 1\n" + FIRST), "keep it in the state", ""),
        (("self.watches = gains, sites", "self.watches = gains, ('r1', 'r2', 'r9')"), "it watches ['r9']", ""),
        (("self.watches = gains, sites", "self.watches = gains, 3"), "it is no detector: TypeError", ""),
    ],
)
def test_what_is_no_detector_is_a_mistake_and_nothing_is_written(plugin, tmp_path, capsys, change, message, place):
    assert plugin(change) == 2
    error = capsys.readouterr().err
    assert message in error
    if place not in ("", START):
        assert f"mine.py:{line_of(tmp_path / 'detectors' / 'mine.py', place)})" in error
    assert not (tmp_path / "out").exists()


MISBEHAVIOURS = [
    ("raise SystemExit(0)", "SystemExit"),
    ("measured.r_deg_s[...] = 99.0", "read-only"),
    ("measured.mass_kg *= 2.0", "read-only"),
    ("return measured.r_deg_s, Verdict(x.declared, measured.r_deg_s[0])", "recorded announces"),
    ("return x", "a step gives (state, Verdict), got CusumState"),
    ("return x, x", "a step gives (state, Verdict), got CusumState as verdict"),
    ("return x, Verdict(x.declared[:2], measured.mass_kg)", "a verdict needs declared of shape"),
    ("return x, Verdict(x.declared, x.declared)", "a verdict needs residual of shape (2,), got (3, 2)"),
    ("raise ValueError('five\\nlines' * 500)", "..."),
]
SHOWN = "signals={'sum_deg_s': measured.mass_kg, 'limit_deg_s': measured.mass_kg}"
WRONG_STATES = [
    (f"return measured.r_deg_s, Verdict(x.declared, measured.mass_kg, {SHOWN})", "need a record of the fields"),
    (f"return CusumState(sum_deg_s=x.declared[:2], declared=x.declared), Verdict(x.declared, measured.mass_kg, {SHOWN})",
     "sum_deg_s needs the shape (3, n_cases), got (2, "),
]  # fmt: skip


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize(("wrong", "message"), MISBEHAVIOURS + WRONG_STATES)
def test_a_step_that_is_always_wrong_is_told_before_anything_is_flown(
    plugin, tmp_path, capsys, wrong, message, command
):
    assert plugin((FIRST, f"        {wrong}\n{FIRST}"), command=command) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.startswith("fddbench: --set detectors=[mine]: design 'mine' (")
    path = tmp_path / "detectors" / "mine.py"
    assert f"mine.py:{line_of(path, wrong if 'raise' in wrong or '=' in wrong.split('(')[0] else 'def step')})" in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("backend", ["auto", "numpy"])
@pytest.mark.parametrize(("wrong", "message"), MISBEHAVIOURS + WRONG_STATES)
def test_a_step_that_misbehaves_in_flight_is_a_row_and_spoils_no_other(plugin, tmp_path, backend, wrong, message):
    """It is sound on the plain numbers of the check: no aircraft weighs less than a ton."""
    change = (FIRST, f"        if (measured.mass_kg > 1e3).any():\n            {wrong}\n{FIRST}")
    assert plugin(change, others=", sliding_mode_published, voting_monitor", backend=backend) == 1
    rows = load(tmp_path / "out")
    mine = rows[rows["detector"] == "mine"]
    assert set(mine["status"]) == {"error"}
    message = message.replace("(2,), got (3, 2)", "(1,), got (3, 1)")  # told of a flight alone
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
    assert main(["report", "out"]) == 2
    assert "Run the campaign again on this folder" in capsys.readouterr().err
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


def test_a_doctored_manifest_is_no_shorter_table_and_is_mended_to_the_same_rows(done, capsys):
    before = load(done)
    manifest = done / "manifest.jsonl"
    line = manifest.read_text()
    elsewhere = json.loads(line) | {"rows": "../out/" + json.loads(line)["rows"], "cases": [[7, 1]]}
    manifest.write_bytes(line.encode() * 2 + json.dumps(elsewhere).encode() + b"\n\xff\xfe\n")
    with pytest.raises(
        ResultsError, match=r"manifest.jsonl, line 2: it lists flights .* 2 more .* run the campaign again"
    ):
        load(done)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
    assert "line 4: it is not the line that was written; its flights are flown again" in capsys.readouterr().err
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
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 74
    assert "No space left on device" in capsys.readouterr().err
    monkeypatch.undo()
    monkeypatch.chdir(done.parent)
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0


@pytest.mark.parametrize("name", ["x.csv", "x.parquet", "x.mat", "x.h5"])
def test_a_table_of_a_flight_in_a_folder_that_is_not_there(done, capsys, name):
    assert main(["replay", "out", "jam_b/0/0/0", "--to", f"absent/{name}"]) == 2
    assert f"cannot write absent/{name}: there is no folder absent; make it, or name another file with --to" in (
        capsys.readouterr().err
    )


def test_a_detector_that_does_not_fit_an_extension_is_told_in_places_that_its_reader_knows(done, capsys):
    assert main(["extend", "out", "--detector", "hinf_final", "--quiet"]) == 2
    error = capsys.readouterr().err
    assert "hinf_filter needs the signals ['y', 'u']" in error
    assert error.startswith("fddbench: the larger campaign: ")
    assert "campaign.yaml" not in error
    assert str(Path(tempfile.gettempdir()) / "tmp") not in error
