"""What a new user asks first: what is there, what is it called, give me something to start from."""

import os
import shutil
import subprocess
import sys

import pytest

from fddbench import gallery, kinds, testing
from fddbench.cli.completing import SHELLS
from fddbench.cli.main import main, parser
from fddbench.interfaces.benchmark import default_choices


@pytest.mark.parametrize("name", ["jet_engine", "yaw_rate"])
def test_a_benchmark_shows_all_its_names(name, capsys):
    assert main(["list", name]) == 0
    text = capsys.readouterr().out
    bench = kinds.load("benchmark", name)()
    chosen = default_choices(bench)
    plants = bench.choices["plant"].options.values()
    for member in plants:
        plant = bench.plant({**chosen, "plant": member})
        for named in (*plant.sites, *plant.parameters):
            assert f"  {named.name} " in text
        for manoeuvre, length_s in plant.manoeuvres.items():
            assert any(line.split()[:2] == [manoeuvre, f"{length_s:g}"] for line in text.splitlines()), manoeuvre
    for key, choice in bench.choices.items():
        assert f"{key}: {choice.about}" in text
        assert all(f"  {option} " in text for option in choice.options)
    shipped = {"jet_engine": "hinf_final", "yaw_rate": "sliding_mode_published"}
    assert {one: shipped[one] in text for one in shipped} == {one: one == name for one in shipped}
    # with each of its plants
    besides = "  with sensors: iru besides phi1, phi2, phi3, p1, p2, p3\n"
    assert text.count(besides) == {"jet_engine": 0, "yaw_rate": 2}[name]


def test_each_manoeuvre_has_its_sketch(capsys):
    main(["list", "jet_engine"])
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line.startswith("  ")}
    assert lines["idle"].endswith("u_1 0 throughout")
    assert "▁▁██" in lines["steps"]
    assert lines["steps"].endswith("u_1 0 … 1")
    assert lines["half_steps"].endswith("u_1 0 … 0.5")


@pytest.mark.parametrize(
    "subject", ["benchmarks", "faults", "voters", "detectors", "schedulings", "campaigns", "designs"]
)
def test_a_family_shows_its_members(subject, capsys):
    assert main(["list", subject]) == 0
    text = capsys.readouterr().out
    folder = {"campaigns": "campaigns", "designs": "detectors"}.get(subject)
    names = (
        [p.stem for p in gallery.folder(folder).glob("*.yaml")] if folder else kinds.known(subject.removesuffix("s"))
    )
    assert all(f"  {name} " in text for name in names)
    assert "yaml-language-server" not in text


def test_an_unknown_subject_is_a_message(capsys):
    assert main(["list", "yaw_rat"]) == 2
    assert "nothing is called 'yaw_rat'. Did you mean 'yaw_rate'?" in capsys.readouterr().err


@pytest.mark.parametrize("what", ["detector", "benchmark", "fault", "campaign"])
def test_what_init_writes_flies_at_once_and_is_never_overwritten(what, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["init", f"--{what}", f"my_{what}"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[-1] == f"next: fddbench run campaigns/my_{what}.yaml"
    written = {path: path.read_text(encoding="utf-8") for path in map(tmp_path.joinpath, told[:-1])}
    own = [text for path, text in written.items() if path.suffix != ".json"]
    assert all("NAME" not in text and "CLASS" not in text for text in own)
    assert (
        main(["run", f"campaigns/my_{what}.yaml", "--quiet", "--jobs", "1", "--set", "dispersions.monte_carlo.runs=2"])
        == 0
    )
    assert main(["init", f"--{what}", f"my_{what}"]) == 2
    assert "is there already and is left alone" in capsys.readouterr().err
    assert written == {path: path.read_text(encoding="utf-8") for path in written}


def test_what_init_writes_keeps_the_contracts(tmp_path):
    for what in ("detector", "benchmark", "fault"):
        assert main(["init", str(tmp_path), f"--{what}", f"my_{what}"]) == 0
    beside = tmp_path / "campaigns"
    testing.check_benchmark("my_benchmark.py:MyBenchmark", beside=beside)
    testing.check_fault("my_fault.py:MyFault", {"amplitude_percent": 1.0, "period_s": 0.1}, beside=beside)


@pytest.mark.parametrize("name", ["", "My", "9a", "a/b", "a-b", "a" * 41, "../x"])
def test_what_is_no_name_writes_nothing(name, tmp_path, capsys):
    assert main(["init", str(tmp_path), "--fault", name]) == 2
    assert "is no name for a fault" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_detector_of_a_shipped_name_is_refused(tmp_path, capsys):
    assert main(["init", str(tmp_path), "--detector", "voting_monitor"]) == 2
    assert "a shipped design is called 'voting_monitor'" in capsys.readouterr().err


def test_without_a_command_there_is_help_and_help_fits_80_columns(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    assert main([]) == 0
    assert "fddbench [-h]" in capsys.readouterr().out
    (subs,) = (
        action for action in parser()._actions if hasattr(action, "choices") and isinstance(action.choices, dict)
    )
    for name, sub in {"": parser(), **subs.choices}.items():
        assert [line for line in sub.format_help().splitlines() if len(line) > 80] == [], name


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("fddbench ru", "run"),
        ("fddbench run yaw_rate_tab", "yaw_rate_table8"),
        ("fddbench cost voting_m", "voting_monitor"),
        ("fddbench list jet", "jet_engine"),
        ("fddbench report results/on", "results/one"),
        ("fddbench run smoke --bac", "--backend"),
        ("fddbench tune mi", "mine"),
        ("fddbench run own/ca", "own/campaign.yaml"),
    ],
)
def test_a_shell_completes(line, expected, tmp_path):
    for name in ("results/one/provenance.json", "detectors/mine.yaml", "own/campaign.yaml", "own/campaign.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    answer = tmp_path / "answer"
    asked = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "COMP_LINE": line, "COMP_POINT": str(len(line))}
    subprocess.run(
        [sys.executable, "-m", "fddbench"], cwd=tmp_path, check=False,
        env={**os.environ, **asked, "_ARGCOMPLETE_STDOUT_FILENAME": str(answer)},
    )  # fmt: skip
    assert expected in [found.strip() for found in answer.read_text(encoding="utf-8").replace("\013", "\n").split("\n")]


@pytest.mark.parametrize("shell", SHELLS)
def test_the_script_of_a_shell_is_one(shell, capsys, tmp_path):
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert "fddbench" in script
    if shutil.which(shell):
        (tmp_path / "script").write_text(script, encoding="utf-8")
        assert subprocess.run([shell, "-n", str(tmp_path / "script")], check=False).returncode == 0
