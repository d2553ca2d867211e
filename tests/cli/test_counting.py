"""Tables for papers and comparisons: the numbers are those of the rows, and wrong use is a message."""

import re
import shutil

import numpy as np
import pandas as pd
import pytest

import fddbench
from fddbench.api.summaries import written
from fddbench.cli.main import main

CAMPAIGN = """
name: counted
about: What is there to count?
benchmark: yaw_rate
wind: light
seed: 4
duration_s: 4.0
detectors: [sliding_mode_published, voting_monitor]
dispersions:
  grid: {gust_scale_ratio: [0.0, 1.0]}
  monte_carlo: {runs: 8, mass_kg: {uniform: [180000, 220000]}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam_a, manoeuvre: cruise, faults: [{kind: jam, sites: [r1], onset_s: 1.0, amplitude_percent: 1.25}]}
  - {name: jam_b, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_percent: 5.0}]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder of results of a small campaign in gusts."""
    own = tmp_path_factory.mktemp("counted")
    (own / "counted.yaml").write_text(CAMPAIGN, encoding="utf-8")
    assert main(["run", str(own / "counted.yaml"), "--out", str(own / "out"), "--quiet", "--jobs", "1"]) == 0
    return own / "out"


def test_a_run_leaves_its_summary(folder):
    left = pd.read_parquet(folder / "summary.parquet", dtype_backend="pyarrow")
    pd.testing.assert_frame_equal(left, fddbench.summary(folder), check_dtype=False)
    # it is ours: the folder can be flown anew
    copy = folder.parent / "copy"
    shutil.copytree(folder, copy)
    again = ["run", str(folder.parent / "counted.yaml"), "--out", str(copy), "--quiet", "--fresh", "--jobs", "1"]
    assert main(again) == 0
    assert (copy / "summary.parquet").read_bytes() == (folder / "summary.parquet").read_bytes()


def test_by_any_column_the_parts_add_up(folder):
    rows = fddbench.load(folder)
    for by in ("p_gust_scale_ratio", "p_mass_kg", "run", "outcome", ["p_gust_scale_ratio", "outcome"]):
        parts = fddbench.summary(folder, by=by)
        assert parts.columns[: 1 if isinstance(by, str) else 2].tolist() == ([by] if isinstance(by, str) else by)
        assert parts["flights"].sum() == len(rows)
    gust = fddbench.summary(folder, by="p_gust_scale_ratio").set_index(["scenario", "detector", "p_gust_scale_ratio"])
    for (scenario, detector, ratio), line in gust.iterrows():
        own = rows[
            (rows["scenario"] == scenario) & (rows["detector"] == detector) & (rows["p_gust_scale_ratio"] == ratio)
        ]
        if not line["healthy"]:
            assert line["right"] == (own["outcome"] == "right").sum()
    masses = fddbench.summary(folder, by="p_mass_kg", bins=4)
    assert masses["p_mass_kg"].nunique() <= 8
    assert "<table" in masses._repr_html_()


def test_every_format_says_the_same(folder, tmp_path):
    lines = fddbench.summary(folder)
    assert len(written(folder, "csv").decode().splitlines()) == len(lines) + 1
    assert main(["table", str(folder), "--format", "parquet", "--output", str(tmp_path / "t.parquet")]) == 0
    pd.testing.assert_frame_equal(
        pd.read_parquet(tmp_path / "t.parquet", dtype_backend="pyarrow"), lines, check_dtype=False
    )
    texts = {how: written(folder, how, by="p_gust_scale_ratio").decode() for how in ("latex", "markdown", "html")}
    for text in texts.values():
        found = re.sub(r"[\\$]", "", text)
        assert found.count("jam_b") == 4
        assert "sliding_mode_published" in found
    assert texts["latex"].startswith("\\begin{tabular}")
    assert not re.search(r"(?<!\\)[_%]", texts["latex"])
    assert len({line.count("|") for line in texts["markdown"].splitlines()}) == 1


def test_two_detectors_on_the_same_flights(folder, capsys):
    table = fddbench.compare(folder, detectors=["sliding_mode_published", "voting_monitor"]).set_index(
        ["scenario", "measure"]
    )
    right = table.loc["jam_b", "right"]
    rows = fddbench.load(folder)
    of = {
        name: np.asarray(
            rows[(rows["scenario"] == "jam_b") & (rows["detector"] == name)]["outcome"] == "right", dtype=bool
        )
        for name in ("sliding_mode_published", "voting_monitor")
    }
    assert right["only_a"] == int((of["sliding_mode_published"] & ~of["voting_monitor"]).sum())
    assert (right["pairs"], right["runs"], right["a"], right["b"]) == (16, 8, 100.0, 0.0)
    assert right["p_value"] == pytest.approx(2 * 0.5**8)
    command = ["compare", str(folder), "--detector", "sliding_mode_published", "--detector", "voting_monitor"]
    assert main(command) == 0
    assert "jam_b" in capsys.readouterr().out
    better = [
        *command[:2],
        "--detector",
        "voting_monitor",
        "--detector",
        "sliding_mode_published",
        "--require",
        "right",
    ]
    assert main([*command, "--require", "detection_time"]) == 0
    assert main([*command, "--require", "right"]) == (1 if right["p_holm"] < 0.05 else 0)
    assert main(better) == 0


def test_a_folder_with_itself_shows_nothing_and_passes(folder, capsys):
    require = [
        part for name in ("right", "wrong_site", "false_alarm", "detection_time") for part in ("--require", name)
    ]
    assert main(["compare", str(folder), str(folder), *require]) == 0
    assert re.match(r"(\d+) of \1 comparisons show no difference; 16 flights", capsys.readouterr().out)


def test_another_grid_is_paired_by_its_values(folder, tmp_path, capsys):
    (tmp_path / "other.yaml").write_text(CAMPAIGN.replace("[0.0, 1.0]", "[0.5, 1.0]"), encoding="utf-8")
    assert main(["run", str(tmp_path / "other.yaml"), "--out", str(tmp_path / "out"), "--quiet", "--jobs", "1"]) == 0
    table = fddbench.compare(folder, tmp_path / "out")
    assert set(table[table["measure"] != "detection_time"]["pairs"]) == {8}
    assert not table["difference"].any()


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["table", "OUT", "--by", "p_mas_kg"], "the rows have no column 'p_mas_kg'. Did you mean 'p_mass_kg'?"),
        (["table", "OUT", "--format", "parquet"], "parquet is no text: name a file with --output"),
        (["table", "OUT", "--output", "/nowhere/t.md"], "cannot write /nowhere/t.md"),
        (["table", "nowhere"], "nowhere"),
        (["compare", "OUT"], "name two detectors of one folder: sliding_mode_published, voting_monitor"),
        (["compare", "OUT", "--detector", "voting_monitor"], "compare two detectors, got 1"),
        (
            ["compare", "OUT", "OUT", "--detector", "x", "--detector", "voting_monitor"],
            "no detector is called 'x' there",
        ),
        (["compare", "OUT", "OUT", "--require", "speed"], "nothing is measured as 'speed'; known: right"),
        (["compare", "OUT", "nowhere"], "nowhere"),
    ],
)
def test_wrong_use_is_a_message(folder, capsys, argv, message):
    assert main([str(folder) if part == "OUT" else part for part in argv]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert "Traceback" not in said


def test_flights_of_another_seed_are_no_pairs(folder, tmp_path, capsys):
    (tmp_path / "other.yaml").write_text(CAMPAIGN.replace("seed: 4", "seed: 5"), encoding="utf-8")
    assert main(["run", str(tmp_path / "other.yaml"), "--out", str(tmp_path / "out"), "--quiet", "--jobs", "1"]) == 0
    assert main(["compare", str(folder), str(tmp_path / "out")]) == 2
    assert "have no flight in common" in capsys.readouterr().err


def test_sizes_that_differ_have_a_curve_or_the_reason_why_not(folder, tmp_path, capsys):
    # what is not found after 2 s is missed
    sizes = CAMPAIGN.replace("jam_a, manoeuvre: cruise,", "jam_a, manoeuvre: cruise, detection_time_limit_s: 2.0,")
    sizes = sizes.replace("amplitude_percent: 1.25", "amplitude_percent: {log_uniform: [0.2, 3.0]}").replace(
        "runs: 8", "runs: 30"
    )
    (tmp_path / "sizes.yaml").write_text(sizes, encoding="utf-8")
    assert main(["run", str(tmp_path / "sizes.yaml"), "--out", str(tmp_path / "out"), "--quiet", "--jobs", "1"]) == 0
    capsys.readouterr()
    assert main(["pod", str(tmp_path / "out")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 3
    assert all("f1_amplitude_percent" in line for line in lines[1:])
    table = fddbench.pod(tmp_path / "out")
    voting = table[table["detector"] == "voting_monitor"].iloc[0]
    # 0.75 % of the range is what its flag takes
    assert voting["size_90"] == pytest.approx(0.75, abs=0.15)
    assert main(["pod", str(folder)]) == 2
    assert "has a size that differs; sweep one" in capsys.readouterr().err
    assert main(["pod", str(tmp_path / "out"), "--size", "f1_amplitud"]) == 2
    assert "the rows have no column 'f1_amplitud'. Did you mean 'f1_amplitude_percent'?" in capsys.readouterr().err
