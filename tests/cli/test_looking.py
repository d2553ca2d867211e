"""One flight again: what is shown of it is what its row says, in every format; and which flights to look at."""

import numpy as np
import pandas as pd
import pytest
from scipy.io import loadmat

import fddbench
from fddbench.cli.main import main
from fddbench.reporting.declarations import declarations

CAMPAIGN = """
name: looked
about: What is there to see?
benchmark: yaw_rate
seed: 4
duration_s: 4.0
detectors: [sliding_mode_published, voting_monitor]
dispersions: {monte_carlo: {runs: 2, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam_a, manoeuvre: cruise, faults: [{kind: jam, sites: [r1], onset_s: 1.0, amplitude_percent: 1.25}]}
  - {name: jam_b, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_percent: 5.0}]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder of results of a small campaign."""
    own = tmp_path_factory.mktemp("looked")
    (own / "looked.yaml").write_text(CAMPAIGN, encoding="utf-8")
    assert main(["run", str(own / "looked.yaml"), "--out", str(own / "out"), "--quiet", "--jobs", "1"]) == 0
    return own / "out"


def test_declarations_of_a_replay_are_those_of_its_row(folder):
    for line in fddbench.load(folder).to_dict("records"):
        flight = fddbench.signals(folder, line["case"])
        own = [(time_s, sites) for name, time_s, sites, _ in declarations(flight) if name == line["detector"]]
        declared = "" if line["declared_sites"] is pd.NA or line["declared_sites"] is None else line["declared_sites"]
        assert (own[-1][1] if own else "") == declared
        for column in ("detection_time_s", "wrong_site_time_s"):
            if not pd.isna(line[column]):
                assert own[0][0] - 1.0 == pytest.approx(line[column])
        margin = np.nanmax(flight.detectors[line["detector"]]["residual"][:100, 0])
        assert margin <= line["margin_healthy"] or line["scenario"] != "healthy"


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".mat", ".h5"])
def test_every_format_holds_the_same_numbers(folder, tmp_path, suffix):
    path = tmp_path / f"flight{suffix}"
    assert main(["replay", str(folder), "jam_b/0/0/1", "--to", str(path), "--detector", "voting_monitor"]) == 0
    flight = fddbench.signals(folder, "jam_b/0/0/1")
    table = fddbench.table_of(flight)
    if suffix == ".csv":
        found = pd.read_csv(path)
    elif suffix == ".parquet":
        found = pd.read_parquet(path)
    elif suffix == ".mat":
        inside = loadmat(path, squeeze_me=True)
        assert "jam_b/0/0/1" in str(inside["about"])
        found = pd.DataFrame(
            {name.replace("__", "."): inside["flight"][name].item() for name in inside["flight"].dtype.names}
        )
    else:
        import h5py

        with h5py.File(path) as file:
            found = pd.DataFrame({name: file[name][:] for name in file})
    assert "voting_monitor.declared_r3" in found.columns
    assert not [name for name in found.columns if name.startswith("sliding_mode")]
    for name in found.columns:
        assert np.array_equal(found[name].to_numpy(float), table[name].to_numpy(float)), name


@pytest.mark.parametrize(
    ("suffix", "magic"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF"), (".html", b"<!doctype")]
)
def test_every_picture_is_one_and_the_same_twice(folder, tmp_path, suffix, magic):
    pictures = [tmp_path / f"{n}{suffix}" for n in "ab"]
    for path in pictures:
        assert main(["replay", str(folder), "jam_b/0/0/0", "--plot", str(path), "--detector", "voting_monitor"]) == 0
    first, second = (path.read_bytes() for path in pictures)
    assert first.startswith(magic)
    assert first == second
    assert b"<script" not in first


def test_replay_says_onset_and_declarations(folder, capsys):
    assert main(["replay", str(folder), "jam_b/0/0/0"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "flight jam_b/0/0/0: onset 1 s, 401 samples"
    assert lines[1].split() == ["1.10", "s", "sliding_mode_published", "declares", "r1+r2"]
    assert lines[2].split() == ["2.00", "s", "voting_monitor", "declares", "r3"]
    assert main(["replay", str(folder), "healthy/0/0/0"]) == 0
    assert "  sliding_mode_published, voting_monitor: nothing" in capsys.readouterr().out


def test_the_worst_flights_come_first(folder, capsys):
    assert main(["worst", str(folder), "--most", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("jam_b/0/0/")
    assert "voting_monitor" in lines[1]
    assert lines[1].endswith("declares r3, faulty is r1+r2; wrong 1.00 s after the onset")
    assert lines[-1].startswith(f"next: fddbench replay {folder} jam_b/0/0/")
    table = fddbench.worst(folder, ["sliding_mode_published"])
    assert table["outcome"].tolist() == ["right", "right", "quiet"]


def test_flights_without_a_score_are_no_worst_flights_but_for_their_reason(tmp_path):
    """Nobody flies at 40,000 ft and 280 kt: half of the rows have no outcome."""
    path, out = tmp_path / "high.yaml", tmp_path / "out"
    path.write_text(
        CAMPAIGN.replace("dispersions: {", "dispersions: {grid: {altitude_ft: [10000, 40000], v_cas_kt: [280]}, ")
    )
    fddbench.run(path, out, jobs=1)
    assert set(fddbench.load(out)["status"]) == {"ok", "infeasible"}
    found = fddbench.worst(out)
    assert {"wrong_site", "right", "quiet"} <= set(found["outcome"])
    assert {case.split("/")[1] for case in found["case"]} == {"0"}


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["replay", "OUT", "jam_b"], "a flight is named as in the column case, jam_a/3/0/17, got 'jam_b'"),
        (["replay", "OUT", "jam_x/0/0/0"], "no scenario 'jam_x'; known: healthy, jam_a, jam_b"),
        (["replay", "OUT", "jam_b/0/0/9"], "jam_b/0/0/9"),
        (
            ["replay", "OUT", "jam_b/0/0/0", "--detector", "x"],
            "no detector of this campaign is called 'x'; known: sliding_mode",
        ),
        (["replay", "OUT", "jam_b/0/0/0", "--to", "x.xlsx"], "let it end in .csv, .parquet, .mat, .h5"),
        (["replay", "OUT", "jam_b/0/0/0", "--plot", "x.bmp"], "let it end in .html, .png, .svg, .pdf"),
        (["replay", "OUT", "jam_b/0/0/0", "--plot", "/nowhere/x.png"], "cannot write /nowhere/x.png"),
        (["replay", "OUT", "jam_b/0/0/0", "--to", "/nowhere/x.csv"], "cannot write /nowhere/x.csv"),
        (["replay", "OUT", "jam_b/0/0/0", "--plot", "x.png", "--signal", "q"], "no signal 'q'"),
        (["replay", "nowhere", "jam_b/0/0/0"], "no such file"),
        (["worst", "OUT", "--detector", "x"], "no detector in"),
        (["worst", "nowhere"], "nowhere"),
    ],
)
def test_wrong_use_is_a_message_with_place_and_cure(folder, tmp_path, monkeypatch, capsys, argv, message):
    monkeypatch.chdir(tmp_path)
    assert main([str(folder) if part == "OUT" else part for part in argv]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert "Traceback" not in said
    assert list(tmp_path.iterdir()) == []


def test_flights_of_several_scenarios_are_refused_in_words(folder):
    with pytest.raises(fddbench.errors.FddbenchError, match=r"flights of one scenario at a time.*jam_a, jam_b"):
        fddbench.signals(folder, ["jam_a/0/0/0", "jam_b/0/0/0"])
