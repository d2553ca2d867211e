"""A campaign that does not keep all its rows: what it keeps are the rows, and what it counts is all of them."""

import shutil

import pandas as pd
import pytest
import yaml
from tests.runner.test_growing import BASE

import fddbench
from fddbench.api.tables import overview
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.errors import FddbenchError, PartialResultsWarning, ResultsError
from fddbench.results import manifest
from fddbench.results.counted import read_tallies
from fddbench.results.table import read_events, read_rows
from fddbench.runner.run import run_campaign

_RUNS, _KEPT = 6, 2
_ADDRESS = ["scenario", "point", "level", "run", "detector"]


def _campaign(path, keep, runs=_RUNS, **more):
    content = yaml.safe_load(yaml.safe_dump(BASE)) | {"keep": keep, "kept_runs": _KEPT} | more
    content["detectors"] = ["voting_monitor", "coast"]
    content["dispersions"]["monte_carlo"]["runs"] = runs
    content["scenarios"][1]["faults"][0]["amplitude_percent"] = {"uniform": [0.1, 1.0]}  # some are found, some are not
    path.write_text(yaml.safe_dump(content))
    return path


def _fly(path, out, **options):
    return run_campaign(read_campaign(path), out, **options)


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    base = tmp_path_factory.mktemp("keep")
    for keep in ("all", "failures", "sample"):
        _fly(_campaign(base / f"{keep}.yaml", keep), base / keep, jobs=1, backend="numpy", chunk=3)
    return base


def _kept(rows, keep):
    wrong = rows["outcome"].isin(["false_alarm", "wrong_site", "late", "missed"]) if keep == "failures" else False
    return (rows["run"] < _KEPT) | wrong


def test_some_flights_are_found_and_some_are_not(folders):
    assert {"right", "missed"} <= set(fddbench.load(folders / "all")["outcome"])


@pytest.mark.parametrize("keep", ["failures", "sample"])
def test_kept_rows_and_events_are_those_of_the_campaign_that_keeps_all(folders, keep):
    whole, events = read_rows(folders / "all"), read_events(folders / "all")
    kept = whole[_kept(whole, keep)].reset_index(drop=True)
    pd.testing.assert_frame_equal(read_rows(folders / keep), kept, check_exact=True)
    there = events.merge(kept[_ADDRESS], on=_ADDRESS).reset_index(drop=True)
    pd.testing.assert_frame_equal(read_events(folders / keep), there, check_exact=True)
    assert len(kept) < len(whole)


@pytest.mark.parametrize("keep", ["failures", "sample"])
def test_all_rows_are_counted(folders, keep):
    whole = fddbench.summary(folders / "all")
    found = fddbench.summary(folders / keep)
    for name in (
        "scenario",
        "detector",
        "flights",
        "flown",
        "right",
        "late",
        "missed",
        "detection_time_p95_s",
        "exposure_h",
    ):
        assert found[name].equals(whole[name]), name
    assert read_tallies(folders / keep)["rows"].sum() == len(read_rows(folders / "all"))


@pytest.mark.parametrize(("jobs", "chunk"), [(1, 64), (2, 5)])
def test_chunks_and_workers_are_no_part_of_it(folders, tmp_path, jobs, chunk):
    again = tmp_path / "again"
    _fly(folders / "failures.yaml", again, jobs=jobs, backend="numpy", chunk=chunk)
    pd.testing.assert_frame_equal(read_rows(again), read_rows(folders / "failures"), check_exact=True)
    pd.testing.assert_frame_equal(read_tallies(again), read_tallies(folders / "failures"), check_exact=True)
    fddbench.compact(again)
    pd.testing.assert_frame_equal(read_tallies(again), read_tallies(folders / "failures"), check_exact=True)
    assert len(manifest.shards(again)) == 1
    assert not fddbench.verify(again, refly=8, seed=1).different


def test_who_reads_rows_is_told_and_who_compares_takes_whole_runs(folders):
    with pytest.warns(
        PartialResultsWarning, match="of 48 rows only the rows of runs 0 to 1, and of others those that failed"
    ):
        rows = fddbench.load(folders / "failures")
    assert set(rows["run"]) > {0, 1}
    with pytest.warns(PartialResultsWarning, match="only the rows of runs 0 to 1 are used") as told:
        table = fddbench.compare(folders / "failures", detectors=["voting_monitor", "coast"])
    assert len(told) == 1
    assert set(table["pairs"].dropna()) <= {_KEPT * 2}
    with pytest.warns(PartialResultsWarning, match="are used"):
        assert fddbench.summary(folders / "failures", by="p_v_cas_kt")["flights"].max() == _KEPT


def test_a_damaged_or_missing_tally_is_found_and_flown_again(folders, tmp_path, capsys):
    own = shutil.copytree(folders / "failures", tmp_path / "own")
    one, other = sorted((own / "tallies").iterdir())[:2]
    one.unlink()
    other.write_bytes(b"no table")
    wrong = fddbench.verify(own).wrong
    assert len(wrong) == 2
    assert all("tallies/" in text for text in wrong)
    with pytest.raises(ResultsError, match="tallies"):
        fddbench.summary(own)
    assert (
        main(["run", str(folders / "failures.yaml"), "--out", str(own), "--quiet", "--jobs", "1", "--backend", "numpy"])
        == 0
    )
    assert "tallies/" in capsys.readouterr().err
    pd.testing.assert_frame_equal(read_tallies(own), read_tallies(folders / "failures"), check_exact=True)


def test_a_count_that_was_edited_is_found(folders, tmp_path):
    own = shutil.copytree(folders / "sample", tmp_path / "own")
    path = own / "provenance.json"
    path.write_text(path.read_text().replace('"runs": 2', '"runs": 0'))
    with pytest.raises(ResultsError, match="kept"):
        fddbench.load(own)
    path.write_text((folders / "sample" / "provenance.json").read_text().replace('"kept"', '"given_away"'))
    assert any("its line says" in text for text in fddbench.verify(own).wrong)


def test_more_runs_grow_to_the_folder_of_all_at_once(folders, tmp_path):
    own = tmp_path / "own"
    fddbench.run(_campaign(tmp_path / "few.yaml", "failures", 3), own, jobs=1, backend="numpy")
    fddbench.extend(own, runs=_RUNS, jobs=1, backend="numpy")
    pd.testing.assert_frame_equal(read_rows(own), read_rows(folders / "failures"), check_exact=True)
    pd.testing.assert_frame_equal(read_tallies(own), read_tallies(folders / "failures"), check_exact=True)


def test_shards_of_a_plan_become_the_whole_and_other_parts_do_not(folders, tmp_path):
    plan, whole = tmp_path / "plan", tmp_path / "whole"
    fddbench.plan_shards(fddbench.read(folders / "failures.yaml"), 2, plan)
    for number in (1, 2):
        fddbench.fly_shard(number, plan, jobs=1)
    fddbench.merge([plan], whole)
    pd.testing.assert_frame_equal(read_rows(whole), read_rows(folders / "failures"), check_exact=True)
    pd.testing.assert_frame_equal(read_tallies(whole), read_tallies(folders / "failures"), check_exact=True)
    few = tmp_path / "few"
    fddbench.run(_campaign(tmp_path / "few.yaml", "failures", 3), few, jobs=1, backend="numpy")
    with pytest.raises(ResultsError, match="do not keep all their rows"):
        fddbench.merge([folders / "failures", few], tmp_path / "none")
    assert not (tmp_path / "none" / "provenance.json").exists()


def test_it_is_another_campaign_that_keeps_other_rows(folders, tmp_path):
    own = shutil.copytree(folders / "sample", tmp_path / "own")
    with pytest.raises(ResultsError, match=r"keep: sample[\s\S]*keep: failures"):
        fddbench.run(folders / "failures.yaml", own, jobs=1)
    # one that keeps all is what it was before there was the key
    assert fddbench.read(folders / "all.yaml").sha256 == fddbench.read(folders / "all.yaml", ["kept_runs=7"]).sha256


def test_page_scores_and_worst_say_what_they_stand_on(folders, capsys):
    page = fddbench.report(folders / "sample", replay=False).read_text()
    assert "Not all rows are kept: this page is of the rows of runs 0 to 1." in page
    assert "All flights, counted" in page
    assert main(["scores", str(folders / "sample")]) == 0
    scores = yaml.safe_load(capsys.readouterr().out)
    assert scores["provenance"]["kept"] == {"runs": _KEPT, "failures": False}
    assert scores["scores"][0]["flights"] == 2 * _RUNS
    assert main(["finding", str(folders / "sample")]) == 2
    assert "keep=all" in capsys.readouterr().err
    missed = overview(folders / "sample")[0]["missed"].sum()
    assert missed
    assert main(["worst", str(folders / "sample"), "--most", "50"]) == 0
    assert "missed" in capsys.readouterr().out


def test_requirements_are_judged_by_the_runs_that_are_kept_whole(tmp_path, capsys):
    path = _campaign(tmp_path / "c.yaml", "failures", requirements=[{"of": "right_share", "at_least": 0.5}])
    out = tmp_path / "out"
    fddbench.run(path, out, jobs=1, backend="numpy")
    found = fddbench.requirements(out)
    assert set(found["runs_planned"]) == set(found["runs_used"]) == {_KEPT}
    with pytest.raises(FddbenchError, match="more runs decide nothing"):
        fddbench.run_until_decided(path, tmp_path / "other")
    assert main(["check", str(path)]) == 0
    said = capsys.readouterr().out
    assert "judged after the run by the first 2 runs" in said
    assert "All rows are counted; kept are 16, those of the first 2 runs, and of others those that fail" in said


@pytest.mark.parametrize(("keep", "flights"), [("sample", 4 * _KEPT), ("failures", 4 * _RUNS)])
def test_verify_flies_again_what_there_are_rows_to_compare_with(folders, keep, flights):
    found = fddbench.verify(folders / keep, refly=99)
    assert (found.flights, found.rows) == (flights, len(read_rows(folders / keep)))
    assert found.sound


def test_a_folder_without_rows_says_so(folders, tmp_path):
    own = shutil.copytree(folders / "failures", tmp_path / "own")
    manifest.keep(own, ())
    for read in (fddbench.load, fddbench.summary, fddbench.alarms, lambda path: fddbench.summary(path, by="run")):
        with pytest.raises(ResultsError, match="holds no rows yet"):
            read(own)


def test_a_campaign_of_no_more_runs_than_are_kept_keeps_all_and_says_nothing_else(folders, tmp_path, capsys):
    path, own = _campaign(tmp_path / "few.yaml", "failures", _KEPT), tmp_path / "own"
    assert main(["check", str(path)]) == 0
    assert "All rows are kept: no scenario has more runs than kept_runs, 2" in capsys.readouterr().out
    fddbench.run(path, own, jobs=1, backend="numpy")
    first = fddbench.load(own)  # a warning would be an error
    page = fddbench.report(own, replay=False).read_text()
    assert "Not all rows are kept" not in page
    assert fddbench.verify(own, refly=4, seed=1).rows == 8
    fddbench.extend(own, runs=_RUNS, jobs=1, backend="numpy")
    pd.testing.assert_frame_equal(read_rows(own), read_rows(folders / "failures"), check_exact=True)
    pd.testing.assert_frame_equal(read_tallies(own), read_tallies(folders / "failures"), check_exact=True)
    pd.testing.assert_frame_equal(read_rows(own, fair=True), first, check_exact=True)
