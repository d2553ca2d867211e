"""Contract: mappings and campaigns on logs, from the file to the folder of results."""

import shutil

import numpy as np
import pandas as pd
import pytest
from tests.benchmarks.recorded import logging, ulog

import fddbench
from fddbench.api import campaigns
from fddbench.api.checking import described
from fddbench.api.starting import start
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer

RATES = {"r_deg_s": {"from": ["a", "b", "c"], "unit": "deg/s"}, "r_voted_deg_s": {"vote": "r_deg_s"}}
RECORDED = {"scenarios": [{"name": "as_recorded", "manoeuvre": "recorded"}], "detectors": ["voting_monitor"]}
JAM = {"kind": "jam", "sites": ["r1"], "onset_s": 1.0, "amplitude_deg_s": 2.0}


def table(path, n=300, step=0.01, **columns):
    """Log of three rates, quiet but for what is given."""
    found = {"time_s": np.round(np.arange(n) * step, 9)} | {name: np.sin(np.arange(n) * 0.01) for name in "abc"}
    pd.DataFrame(found | columns).to_csv(path, index=False)
    return path


@pytest.fixture
def folder(tmp_path):
    """A log of 3 s and one of 2 s, a mapping and a campaign on them."""
    table(tmp_path / "one.csv")
    table(tmp_path / "two.csv", n=201)
    logging.mapping(tmp_path, {"one": "one.csv", "two": "two.csv"}, signals=RATES)
    logging.on_logs(tmp_path, **RECORDED)
    return tmp_path


def refused(folder, match, logs=None, **more):
    logging.mapping(folder, logs or {"one": "one.csv", "two": "two.csv"}, **{"signals": RATES, **more})
    with pytest.raises(CampaignError, match=match) as found:
        read_campaign(folder / "logged.yaml")
    return str(found.value)


WRONG = {
    "column": ({"signals": {"r_deg_s": {"from": ["a", "b", "q"]}}}, r"one.csv: no column q. .*It has time_s, a, b, c"),
    "unit": ({"signals": {"r_deg_s": {"from": ["a", "b", "c"], "unit": "deg"}}}, "deg is no unit of angular rate"),
    "no_unit": ({"signals": {"r_deg_s": {"from": "a", "unit": "dge/s"}}}, "no such unit. Did you mean 'deg/s'"),
    "row": ({"signals": {"r_deg_s": {"from": "a"}}}, "r_deg_s has 1 rows and cannot have the 3 sites r1, r2, r3"),
    "both": (
        {"signals": {"r_deg_s": {"from": "a", "value": 1}}},
        "exactly one of from | value | vote, got from, value",
    ),
    "vote": ({"signals": {**RATES, "r_voted_deg_s": {"vote": "q"}}}, "votes q, which must be a signal of two or more"),
    "key": ({"between": "cubic"}, "between: Input should be 'previous' or 'linear', got 'cubic'"),
    "up": ({"faults": "../faults.csv"}, "need a file in the folder of this mapping"),
    "gone": ({"faults": "faults.csv"}, "faults.csv: no such file in the folder of the mapping"),
    "true": (
        {"signals": {**RATES, "r_voted_deg_s": {"vote": "r_deg_s", "true": "r"}}},
        "true says r, which truth does not",
    ),
    "stops": ({"sites": [{**logging.SITES[0], "stops_deg": [0, 1]}]}, "stops_deg is no key of a mapping here"),
}


@pytest.mark.parametrize("which", WRONG)
def test_a_wrong_mapping_is_refused_with_its_key(folder, which):
    more, message = WRONG[which]
    assert "logged.yaml:3:7" in refused(folder, message, **more)


def test_a_column_that_is_named_in_another_unit_needs_a_word(folder):
    table(folder / "one.csv", a_rad_s=0.1)
    table(folder / "two.csv", a_rad_s=0.1)
    signals = {"r_deg_s": {"from": ["a_rad_s", "b", "c"]}}
    refused(
        folder,
        "the column a_rad_s is named in rad/s, the signal in deg/s; say what it is in, `unit: rad/s`",
        signals=signals,
    )
    signals["r_deg_s"]["unit"] = "rad/s"
    logging.mapping(folder, {"one": "one.csv"}, signals=signals)
    sampled = read_campaign(folder / "logged.yaml").plant.sampled(0.01)[0]
    np.testing.assert_allclose(sampled["r_deg_s", 0].values, np.rad2deg(0.1))


def test_gaps_and_pieces_are_checked(folder):
    keep = np.ones(300, dtype=bool)
    keep[100:140] = False
    pd.read_csv(folder / "one.csv")[keep].to_csv(folder / "one.csv", index=False)
    refused(folder, r"one.csv:102: a has no row for 0.41 s before this one, at most 0.02 s; .*`largest_gap_s: 0.41`")
    pieces = [{"name": "one", "file": "one.csv", "start_s": 1.5}, {"name": "late", "file": "two.csv", "start_s": 7.0}]
    refused(folder, r"two.csv: start_s of log late is 7, all channels cover 0 s \(r_deg_s\) to 2 s", logs=pieces)
    logging.mapping(folder, pieces[:1], signals=RATES)
    assert read_campaign(folder / "logged.yaml").plant.manoeuvres == {"recorded": 1.49}


def test_labels_are_checked_line_by_line(folder):
    (folder / "faults.csv").write_text(
        "log,sites,onset_s,end_s\nsix,r1,1,\none,r9,1,\none,r1+r1,1,\none,r1,9,\none,r1,1,0.5\none,r1,x,\none,r1,1,\n"
    )
    said = refused(folder, "faults.csv:2: no log is called 'six'", faults="faults.csv")
    for line, message in enumerate(
        ("no fault site is called 'r9'", "'r1', or twice", "lies outside of what is flown of log one, 0 to 2.99 s",
         "end_s = 0.5 does not lie after onset_s = 1", "onset_s is 'x', it must be a time"), 3
    ):  # fmt: skip
        assert f"faults.csv:{line}: " in said
        assert message in said
    assert "faults.csv:8" not in said
    (folder / "faults.csv").write_text("log,site,onset\n")
    refused(folder, "has the columns log, sites, onset_s, end_s, got log, site, onset", faults="faults.csv")


def test_a_detector_that_needs_what_no_log_has_is_refused(folder):
    logging.on_logs(folder, scenarios=RECORDED["scenarios"], detectors=["voting_monitor", "cusum_yaw_rate"])
    with pytest.raises(
        CampaignError,
        match=r"logged.yaml:7:3: design 'cusum_yaw_rate'.*needs the signals .*beta_deg.*this benchmark has .*r_voted",
    ):
        assemble(read_campaign(folder / "logged.yaml"))


def test_logs_are_points_of_their_own_length_and_are_whole_numbers(folder):
    late = {**JAM, "onset_s": {"grid": [1.0, 2.5]}}
    scenarios = [*RECORDED["scenarios"], {"name": "late", "manoeuvre": "recorded", "faults": [late]}]
    points = {"grid": {"log": [2, 1]}}
    rows, _ = logging.rows_of(logging.on_logs(folder, **{**RECORDED, "scenarios": scenarios}, dispersions=points))
    healthy, injected = rows[rows["scenario"] == "as_recorded"], rows[rows["scenario"] == "late"]
    assert healthy[["p_log", "flight_s"]].to_numpy().tolist() == [[2.0, 2.0], [1.0, 2.99]]
    assert injected["status"].tolist() == ["ok", "infeasible", "ok", "ok"]
    assert injected["reason"].tolist()[1] == "a fault begins at 2.5 s, after the log's end at 2 s"
    for wrong, message in (
        ({"grid": {"log": [1.5]}}, "log is a whole number .*1 one, 2 two.*got 1.5"),
        ({"grid": {"log": [3]}}, "log must be within 1 to 2"),
        ({"monte_carlo": {"runs": 2, "log": {"uniform": [1, 2]}}}, "log counts and is not drawn"),
    ):
        with pytest.raises(CampaignError, match=message):
            read_campaign(logging.on_logs(folder, **RECORDED, dispersions=wrong))
    with pytest.raises(CampaignError, match="the longest log lasts 2.99 s, got 9"):
        read_campaign(logging.on_logs(folder, **RECORDED, duration_s=9.0))


def test_results_hold_the_logs_and_say_what_is_in_them(folder, monkeypatch):
    (folder / "faults.csv").write_text("log,sites,onset_s,end_s\ntwo,r1,1,\n")
    table(folder / "two.csv", n=201, a=np.where(np.arange(201) >= 100, 2.0, 0.0))
    logging.mapping(folder, {"one": "one.csv", "two": "two.csv"}, signals=RATES, faults="faults.csv")
    path = logging.on_logs(folder, **RECORDED, dispersions={"grid": {"log": [1, 2]}}, sample_s=0.02)
    assert "2 two: two.csv, 2 s from 0 s on; faulty: r1 from 1 s" in " ".join(described(path).split())
    out = folder / "out"
    campaigns.run(read_campaign(path), out)
    before = fddbench.load(out)
    assert before["outcome"].tolist() == ["quiet", "right"]
    for name in ("one.csv", "two.csv", "logs.yaml", "faults.csv"):
        assert (out / name).read_bytes() == (folder / name).read_bytes()
    said = campaigns.read(out / "campaign.yaml").plant.notes(0.02)["1 one"]
    assert "largest gap 0.01 s" in said
    assert "up to 149 rows of a channel between two samples not used" in said
    shutil.move(folder / "one.csv", folder / "gone.csv")
    shown = fddbench.signals(out, "as_recorded/1/0/0")
    assert shown.onset_s.tolist() == [1.0]
    assert shown.signals["r_deg_s_1"][50, 0] == 2.0


def test_a_changed_log_is_another_campaign(folder):
    before = read_campaign(folder / "logged.yaml").sha256
    table(folder / "two.csv", n=201, a=0.5)
    assert read_campaign(folder / "logged.yaml").sha256 != before


def test_a_px4_log_flies_compiled_and_plain_alike(folder, tmp_path):
    pytest.importorskip("pyulog")
    rate = [[(5_000_000 + 4_000 * k, *(0.002 * np.sin(0.01 * k + j) for j in range(3))) for k in range(700)]]
    topics = {"rates": ([("double[3]", "xyz")], rate)}
    ulog.write(tmp_path / "flight.ulg", 4_900_000, topics)
    signals = {**RATES, "r_deg_s": {"from": [f"rates.xyz[{j}]" for j in range(3)], "unit": "rad/s"}}
    logging.mapping(folder, {"px4": "flight.ulg"}, signals=signals, between="linear")
    scenarios = [{"name": "jam", "manoeuvre": "recorded", "faults": [JAM]}]
    path = logging.on_logs(folder, **{**RECORDED, "scenarios": scenarios})
    compiled, plain = (logging.rows_of(path, backend)[0] for backend in ("auto", "numpy"))
    pd.testing.assert_frame_equal(compiled, plain)
    assert compiled["outcome"].tolist() == ["right"]
    flyer = Flyer(assemble(read_campaign(path)))
    shown = flyer.fly(flyer.assembly.batch(np.array([0])), ["measured:r_deg_s"]).recorded["measured:r_deg_s"]
    assert shown[0, 1, 0] == np.float64(0.002 * np.sin(1.0)) * (180.0 / np.pi) or shown[0, 1, 0] == pytest.approx(
        0.0964, abs=1e-3
    )
    assert "estimated error" in described(path)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("largest_gap_s: 9\n", "'largest_gap_s' stands twice in this block, first at line [1-9]"),
        ("truth: {r_true_deg_s: {from: a}, r_true_deg_s: {from: b}}\n", "'r_true_deg_s' stands twice"),
    ],
)
def test_a_key_that_stands_twice_in_a_mapping_is_refused(folder, more, said):
    path = folder / "logs.yaml"
    path.write_text(path.read_text() + more)
    with pytest.raises(CampaignError, match=rf"logs.yaml.*{said}.*line {path.read_text().count(chr(10))}, column"):
        read_campaign(folder / "logged.yaml")


def test_too_many_numbers_fly_in_python_with_the_same_bits(folder, monkeypatch):
    path = folder / "logged.yaml"
    before, _ = logging.rows_of(path)
    assert "in Python" not in described(path)
    monkeypatch.setattr("fddbench.benchmarks.recorded.loop.MOST_NUMBERS", 100)
    assembly = assemble(read_campaign(path))
    assert not Flyer(assembly).compiled
    assert "All fly in Python: the logs hold 1,503 numbers, at most 100 are compiled" in " ".join(
        described(path).split()
    )
    pd.testing.assert_frame_equal(logging.rows_of(path)[0], before)


def test_what_init_writes_flies_and_has_a_page(tmp_path):
    written = start(tmp_path, "benchmark", "recorded")
    assert written[-1] == tmp_path / "campaigns/logged.yaml"
    out = tmp_path / "out"
    campaigns.run(read_campaign(written[-1]), out)
    page = fddbench.report(out).read_text(encoding="utf-8")
    assert "logs.2 jam" in page
    assert set(fddbench.load(out)["status"]) == {"ok"}
