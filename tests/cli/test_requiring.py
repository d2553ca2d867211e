"""Verdicts on what a campaign requires: in the terminal, by exit code, as JUnit XML, in the summary of a job, as a table."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

import fddbench
from fddbench.api.requiring import judgements
from fddbench.cli.main import main
from fddbench.reporting.requirements import to_junit, to_summary, to_text
from fddbench.results import folder as folder_of_results

CAMPAIGN = """
name: required
about: Is it right?
benchmark: yaw_rate
seed: 4
duration_s: 3.0
detectors: [sliding_mode_published, voting_monitor]
dispersions:
  monte_carlo: {runs: 30, mass_kg: {uniform: [180000, 220000]}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam_b, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_percent: 5.0}]}
requirements:
  - {name: right, of: right_share, at_least: 0.8}
  - {of: false_alarms_per_hour, at_most: 30}
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A campaign, and its folder of results beside it."""
    own = tmp_path_factory.mktemp("required")
    (own / "c.yaml").write_text(CAMPAIGN, encoding="utf-8")
    assert main(["run", str(own / "c.yaml"), "--out", str(own / "out"), "--quiet", "--jobs", "1"]) == 0
    return own / "c.yaml"


def again(path, *more):
    return main(["run", str(path), "--out", str(path.parent / "out"), "--quiet", "--jobs", "1", *more])


def test_the_table_has_a_line_for_each_and_says_what_it_means(path):
    table = fddbench.requirements(path.parent / "out")
    assert table[["name", "detector", "verdict"]].to_numpy().tolist() == [
        ["right", "sliding_mode_published", "pass"],
        ["right", "voting_monitor", "fail"],
        ["false_alarms_per_hour at most 30", "sliding_mode_published", "undecided"],
        ["false_alarms_per_hour at most 30", "voting_monitor", "undecided"],
    ]
    assert list(table) == list(fddbench.columns("requirements"))
    assert table["runs_used"].tolist() == [30] * 4
    assert table["value"].tolist() == [1.0, 0.0, 0.0, 0.0]


def test_the_exit_code_is_that_of_all_and_everything_is_written(path, monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    assert again(path) == 0
    assert not (tmp_path / "summary.md").exists()
    capsys.readouterr()
    assert again(path, "--require", "--junit", str(tmp_path / "deep" / "j.xml")) == 1
    told = capsys.readouterr().out
    assert "  FAIL       voting_monitor: 0 % [0, " in told
    assert max(map(len, told[told.index("Requirements") :].splitlines()[:9])) <= 80
    cases = ElementTree.parse(tmp_path / "deep" / "j.xml").findall("testsuite/testcase")
    assert [
        (case.get("classname"), case.get("name"), [f.get("type") for f in case.findall("failure")]) for case in cases
    ] == [
        ("required.sliding_mode_published", "right", []),
        ("required.voting_monitor", "right", ["fail"]),
        ("required.sliding_mode_published", "false_alarms_per_hour at most 30", ["undecided"]),
        ("required.voting_monitor", "false_alarms_per_hour at most 30", ["undecided"]),
    ]
    assert (path.parent / "out" / "requirements.junit.xml").is_file()
    summary = (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert summary.startswith("### required: 1 pass, 1 fail, 2 undecided\n")
    assert "| **fail** | right | voting_monitor | 0 % |" in summary


def test_check_says_what_is_required(path, capsys):
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr().out
    assert (
        "Required of them, judged after the run\n  right, at 95 % confidence\n  false_alarms_per_hour at most 30, at"
        in told
    )


def test_what_is_required_may_change_and_is_no_part_of_the_rows(path, capsys):
    """Another requirement on the same folder flies nothing and judges anew; those that all pass end with 0."""
    rows = sorted((path.parent / "out" / "rows").iterdir())
    own = "requirements=[{of: right_share, at_least: 0.8, detectors: [slid*]}]"
    assert again(path, "--require", "--set", own) == 0
    assert "0 flights flown" in capsys.readouterr().out
    assert sorted((path.parent / "out" / "rows").iterdir()) == rows
    assert len(judgements(path.parent / "out")) == 1
    assert again(path) == 0


@pytest.mark.parametrize("option", [["--require"], ["--junit", "j.xml"]])
def test_a_campaign_that_requires_nothing_is_not_flown(path, option, tmp_path, capsys):
    assert main(["run", str(path), "--out", str(tmp_path / "none"), "--set", "requirements=[]", *option]) == 2
    assert "requires nothing; write requirements: into it" in capsys.readouterr().err
    assert not (tmp_path / "none").exists()


def test_no_valid_flight_is_no_pass(path, tmp_path, capsys):
    infeasible = [
        "--set",
        "dispersions.monte_carlo={runs: 3, altitude_ft: {uniform: [40000, 41000]}, v_cas_kt: {uniform: [349, 350]}}",
    ]
    code = main(["run", str(path), "--out", str(tmp_path / "none"), "--quiet", "--jobs", "1", "--require", *infeasible])
    assert code == 1
    assert "no flight that counts" in capsys.readouterr().out


def test_where_verdicts_cannot_be_written_is_a_message(path, monkeypatch, tmp_path, capsys):
    assert again(path, "--junit", str(tmp_path)) == 2
    assert "name another file with --junit" in capsys.readouterr().err
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path))
    assert again(path, "--require") == 1
    assert "no summary of the job" in capsys.readouterr().err
    assert main(["run", str(path), str(path), "--junit", "x"]) == 2


def test_hostile_names_stay_text(path):
    from dataclasses import replace

    named = [replace(one, name='<b>|"&]]>') for one in judgements(path.parent / "out")]
    assert ElementTree.fromstring(to_junit(named, "c<&>")).find("testsuite/testcase").get("name") == '<b>|"&]]>'
    assert '| <b>\\|"&]]> |' in to_summary(named, "c")
    assert '<b>|"&]]>' in to_text(named)


def test_flown_until_decided_are_the_rows_of_more_runs_and_going_on_adds_none(path, tmp_path, capsys):
    own = tmp_path / "c.yaml"
    own.write_text(CAMPAIGN.replace("at_most: 30", "at_most: 60"), encoding="utf-8")
    command = ["run", str(own), "--out", str(tmp_path / "out"), "--quiet", "--jobs", "1", "--until", "decided"]
    assert main(command) == 0
    assert "UNDECIDED" not in capsys.readouterr().out
    found = judgements(tmp_path / "out")
    runs = found[0].runs_planned
    assert 30 < runs <= 600
    assert main([*command, "--require"]) == 1  # voting_monitor fails
    assert "0 flights flown" in capsys.readouterr().out
    straight = ["run", str(own), "--out", str(tmp_path / "straight"), "--quiet", "--jobs", "1"]
    assert main([*straight, "--set", f"dispersions.monte_carlo.runs={runs}"]) == 0
    assert judgements(tmp_path / "straight") == found
    one, other = fddbench.load(tmp_path / "out"), fddbench.load(tmp_path / "straight")
    assert one.equals(other)


def test_a_stage_that_was_cut_off_between_its_two_files_goes_on(path, tmp_path, monkeypatch, capsys):
    """Without `_runs_begun` the same command is refused for ever, as of another campaign."""
    command = ["run", str(path), "--out", str(tmp_path / "out"), "--quiet", "--jobs", "1", "--until", "decided"]
    command += ["--at-most", "40"]
    known = folder_of_results.write_bytes

    def killed(file, data):
        if file.name == "campaign.yaml" and file.exists():
            raise KeyboardInterrupt
        known(file, data)

    monkeypatch.setattr(folder_of_results, "write_bytes", killed)
    assert main(command) == 130
    monkeypatch.undo()
    assert folder_of_results.changed_files(tmp_path / "out") == ["campaign.yaml"]
    assert main(command) == 0
    straight = ["run", str(path), "--out", str(tmp_path / "straight"), "--quiet", "--jobs", "1"]
    assert main([*straight, "--set", "dispersions.monte_carlo.runs=40"]) == 0
    assert fddbench.load(tmp_path / "out").equals(fddbench.load(tmp_path / "straight"))


def test_it_ends_undecided_after_so_many_runs(path, tmp_path, capsys):
    command = [
        "run",
        str(path),
        "--out",
        str(tmp_path / "out"),
        "--quiet",
        "--jobs",
        "1",
        "--until",
        "decided",
        "--at-most",
    ]
    assert main([*command, "32", "--require"]) == 1
    told = capsys.readouterr()
    assert "flying 32 runs in all" in told.err
    assert "UNDECIDED" in told.out
    assert main([*command, "20"]) == 2
    assert "the campaign itself has 30" in capsys.readouterr().err
    assert main(["run", str(path), "--at-most", "50"]) == 2


@pytest.mark.parametrize(
    ("left", "most", "runs"),
    [
        ([("pass", 0, 100)], 1000, None),
        ([("undecided", 10, 100)], 1000, 125),
        ([("undecided", 50, 100), ("pass", 0, 100)], 1000, 155),
        ([("undecided", 5000, 100)], 1000, 200),
        ([("undecided", None, 100)], 150, 150),
        ([("undecided", 50, 100)], 100, None),
        ([("undecided", 50, 20), ("undecided", 5, 200)], 1000, None),  # a scenario with runs of its own
    ],
)
def test_how_many_are_flown_next(path, left, most, runs):
    from dataclasses import replace

    from fddbench.api.deciding import next_runs

    base = judgements(path.parent / "out")[0]
    found = [replace(base, verdict=verdict, runs_needed=need, runs_planned=planned) for verdict, need, planned in left]
    assert next_runs(found, 100, most) == runs


def test_a_comparison_ends_with_1_where_what_is_stated_got_worse(path, capsys):
    out = str(path.parent / "out")
    worse = ["compare", out, "--detector", "sliding_mode_published", "--detector", "voting_monitor"]
    assert main([*worse, "--require", "stated"]) == 1
    assert "got worse: right of voting_monitor in jam_b" in capsys.readouterr().err
    assert main([*worse[:2], *worse[4:], *worse[2:4], "--require", "stated"]) == 0


def test_init_writes_a_workflow_for_what_is_required(path, tmp_path, capsys):
    assert main(["init", "--ci", str(tmp_path)]) == 2
    assert "has requirements: to judge" in capsys.readouterr().err
    (tmp_path / "campaigns").mkdir()
    (tmp_path / "campaigns" / "own: one.yaml").write_text(CAMPAIGN, encoding="utf-8")
    (tmp_path / "broken.yaml").write_text("requirements: [", encoding="utf-8")
    (tmp_path / "none.yaml").write_text(CAMPAIGN.split("requirements:")[0], encoding="utf-8")
    assert main(["init", "--ci", str(tmp_path)]) == 0
    workflow = yaml.safe_load((tmp_path / ".github/workflows/fddbench.yml").read_text(encoding="utf-8"))
    runs = [step.get("run") for step in workflow["jobs"]["requirements"]["steps"]]
    assert f"pip install fddbench=={fddbench.__version__}" in runs
    assert "fddbench run 'campaigns/own: one.yaml' --require\n" in runs
    assert main(["init", "--ci", str(tmp_path)]) == 2
    assert "is there already and is left alone" in capsys.readouterr().err


def test_our_own_workflow_runs_what_must_pass():
    workflow = Path(__file__).parents[2] / ".github/workflows/ci.yml"
    jobs = yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"]
    assert {"run": ".ci/run"} in jobs["all"]["steps"]
    for name in ("yaw_rate_table8", "jet_engine_monte_carlo"):
        assert fddbench.read(name).requirements
    assert any("yaw_rate_table8 --require" in step.get("run", "") for step in jobs["requirements"]["steps"])
