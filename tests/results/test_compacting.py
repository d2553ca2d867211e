"""Joined shards: the same rows bit for bit, whatever moment a crash comes at, and nothing of anybody else's removed."""

import os
import random
import shutil
from dataclasses import replace

import pandas as pd
import pytest
from tests.results.conftest import TEXT, everything, fly

import fddbench
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.errors import ResultsError
from fddbench.results import compacting, manifest
from fddbench.results.lock import locked
from fddbench.results.ours import sweep
from fddbench.runner import run


def tables(folder):
    return fddbench.load(folder), fddbench.load_events(folder)


def same(one, other):
    for mine, theirs in zip(one, other, strict=True):
        pd.testing.assert_frame_equal(mine, theirs, check_exact=True)


def test_rows_and_events_are_the_same_and_the_folder_is_sound(out, capsys):
    before = tables(out)
    assert main(["compact", str(out)]) == 0
    assert capsys.readouterr().out == f"{out} holds 12 rows in 1 shards, before in 6\n"
    same(tables(out), before)
    assert [len(list((out / which).iterdir())) for which in ("rows", "events")] == [1, 1]
    assert not fddbench.verify(out).wrong
    once = everything(out)
    fddbench.compact(out)
    assert everything(out) == once


def test_the_order_in_which_shards_came_is_no_part_of_the_bytes(out, flown, tmp_path):
    listed = list(manifest.shards(out))
    random.Random(3).shuffle(listed)
    manifest.keep(out, listed)
    fddbench.compact(out)
    fddbench.compact(shutil.copytree(flown, tmp_path / "other"))
    assert everything(out) == everything(tmp_path / "other")


@pytest.mark.parametrize("most", [2, 4, 5, 7, 12])
def test_no_shard_is_much_larger_than_asked_for_and_flights_keep_their_place(out, most):
    before = tables(out)
    found = compacting.compact(out, most=most)
    sizes = [sum(shard.statuses.values()) for shard in manifest.shards(out)]
    assert found.after == len(sizes)
    assert sum(sizes) == 12
    assert max(sizes) <= most + 1
    same(tables(out), before)
    assert fly(read_campaign(out / "campaign.yaml"), out).flights == 0


class KilledError(Exception):
    """Stands for a kill."""


def _until(name, left):
    """A function of the system that works until the moment of the kill."""
    real = getattr(os, name)

    def counted(*args, **more):
        if not left[0]:
            raise KilledError
        left[0] -= 1
        return real(*args, **more)

    return counted


def test_a_crash_at_any_moment_loses_nothing(flown, tmp_path, monkeypatch):
    expected = fddbench.load(flown)
    fddbench.compact(shutil.copytree(flown, tmp_path / "whole"))
    joined, moment, ended = everything(tmp_path / "whole"), 0, False
    while not ended:
        out, left = shutil.copytree(flown, tmp_path / str(moment)), [moment]
        with monkeypatch.context() as patched:
            for name in ("replace", "unlink", "fsync"):
                patched.setattr(os, name, _until(name, left))
            try:
                compacting.compact(out)
                ended = True
            except KilledError:
                moment += 1
        pd.testing.assert_frame_equal(fddbench.load(out), expected, check_exact=True)
        fddbench.compact(out)
        sweep(out)
        assert everything(out) == joined
    assert moment > 10


def test_a_damaged_shard_stops_it_before_anything_is_written(out):
    path = sorted((out / "rows").iterdir())[2]
    path.write_bytes(path.read_bytes()[:-1])
    before = everything(out)
    with pytest.raises(ResultsError, match="is damaged or gone; run the campaign again"):
        compacting.compact(out)
    assert everything(out) == before


def test_shards_of_another_stage_or_other_detectors_are_not_mixed(out):
    fddbench.extend(out, runs=8, detectors=["sliding_mode_published"], jobs=1, backend="numpy")
    before, kinds = tables(out), {(shard.fingerprint, shard.detectors) for shard in manifest.shards(out)}
    fddbench.compact(out)
    listed = manifest.shards(out)
    assert len(listed) == len(kinds) == 3
    assert {(shard.fingerprint, shard.detectors) for shard in listed} == kinds
    same(tables(out), before)
    assert not fddbench.verify(out).wrong


def test_few_shards_with_failed_rows_stay_as_they_are(out):
    first, *rest = manifest.shards(out)
    manifest.keep(out, [replace(first, statuses={"error": 1, "ok": 1}), *rest])
    assert compacting.compact(out).after == 2
    assert first.rows in [shard.rows for shard in manifest.shards(out)]


def test_where_most_fail_all_are_joined(out):
    *most, last = manifest.shards(out)
    manifest.keep(out, [*[replace(shard, statuses={"error": 2}) for shard in most], last])
    (joined,) = manifest.shards(out) if compacting.compact(out).after == 1 else [None]
    assert joined.statuses == {"error": 10, "ok": 2}


def test_a_large_run_joins_what_it_flew_and_a_small_one_does_not(campaign, flown, tmp_path, monkeypatch):
    assert len(manifest.shards(flown)) == 6
    monkeypatch.setattr(run, "ENOUGH", 12)
    fly(campaign, tmp_path / "out")
    (shard,) = manifest.shards(tmp_path / "out")
    same(tables(tmp_path / "out"), tables(flown))
    assert sum(shard.statuses.values()) == 12


def test_a_full_disk_leaves_a_run_as_it_is(out, monkeypatch):
    def full(*_args, **_more):
        raise OSError(28, "No space left on device")

    told, before = [], everything(out)
    monkeypatch.setattr(run, "ENOUGH", 12)
    monkeypatch.setattr(compacting, "write_tables", full)
    run._few_files(out, manifest.shards(out)[0].fingerprint, told.append)
    assert told == [
        f"{out}: its shards stay as small as they are (No space left on device); join them with `fddbench compact`"
    ]
    assert everything(out) == before


def test_wrong_use_is_met_with_words(out, tmp_path, capsys):
    assert main(["compact", str(tmp_path / "none")]) == 2
    assert "is no folder of results: it has no provenance.json" in capsys.readouterr().err
    assert not (tmp_path / "none").exists()
    with locked(out):
        assert main(["compact", str(out)]) == 2
    assert "is being written by process" in capsys.readouterr().err


def test_a_link_is_not_followed(out, tmp_path):
    (out / "rows").rename(tmp_path / "elsewhere")
    (out / "rows").symlink_to(tmp_path / "elsewhere")
    before = everything(tmp_path / "elsewhere")
    with pytest.raises(ResultsError, match="is a link"):
        fddbench.compact(out)
    assert everything(tmp_path / "elsewhere") == before


@pytest.mark.slow
def test_a_hundred_thousand_rows_end_in_one_shard_and_are_those_of_many(tmp_path, monkeypatch):
    path = tmp_path / "many.yaml"
    path.write_text(TEXT.replace("runs: 6", "runs: 50000").replace("duration_s: 1.0", "duration_s: 0.5"))
    many = read_campaign(path, ["scenarios.1.faults.0.end_s=0.4"])
    run.run_campaign(many, tmp_path / "joined")
    assert [sum(shard.statuses.values()) for shard in manifest.shards(tmp_path / "joined")] == [100_000]
    monkeypatch.setattr(run, "ENOUGH", 100_001)
    run.run_campaign(many, tmp_path / "small")
    assert len(manifest.shards(tmp_path / "small")) > 90
    same(tables(tmp_path / "joined"), tables(tmp_path / "small"))
    some = [("scenario", "=", "jam"), ("p_mass_kg", "<", 181e3)]
    few = fddbench.load(tmp_path / "joined", filters=some)
    pd.testing.assert_frame_equal(few, fddbench.load(tmp_path / "small", filters=some), check_exact=True)
    assert 1000 < len(few) < 1500
