"""Continuing, refusing, interrupting: nothing that is finished is lost."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import time

import pytest
from tests.runner.conftest import TEXT, write

from fddbench import load
from fddbench.campaign.load import read_campaign
from fddbench.errors import PartialResultsWarning, ResultsError
from fddbench.results import manifest
from fddbench.runner.run import run_campaign


def test_a_second_run_finds_everything_done(everything, tmp_path):
    first = run_campaign(everything, tmp_path / "out", jobs=1)
    again = run_campaign(everything, tmp_path / "out", jobs=1)
    assert (first.flights, first.continued) == (first.total, 0)
    assert (again.flights, again.continued) == (0, first.total)
    assert again.statuses == first.statuses


def test_another_campaign_is_refused_with_the_difference(everything, tmp_path):
    run_campaign(everything, tmp_path / "out", jobs=1)
    other = read_campaign(write(tmp_path, TEXT.replace("seed: 77", "seed: 78")))
    with pytest.raises(ResultsError, match=r"(?s)another campaign.*-seed: 77.*\+seed: 78.*--fresh"):
        run_campaign(other, tmp_path / "out", jobs=1)
    run_campaign(other, tmp_path / "out", jobs=1, fresh=True)
    assert json.loads((tmp_path / "out" / "provenance.json").read_text())["seed"] == 78


def test_foreign_files_are_never_touched(everything, tmp_path):
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "thesis.tex").write_text("precious")
    for fresh in (False, True):
        with pytest.raises(ResultsError, match="no folder of results"):
            run_campaign(everything, folder, jobs=1, fresh=fresh)
    assert {path.name for path in folder.iterdir()} <= {"thesis.tex", ".lock", ".pid"}


@pytest.mark.parametrize("damage", ["truncated", "emptied", "flipped", "text", "foreign", "gone", "half a line"])
def test_a_damaged_folder_is_mended_to_the_same_rows(everything, tmp_path, damage):
    folder = tmp_path / "out"
    run_campaign(everything, folder, jobs=1, chunk=5)
    before = load(folder)
    shard = manifest.shards(folder)[0]
    path = folder / shard.rows
    data = bytearray(path.read_bytes())
    if damage == "half a line":
        text = (folder / "manifest.jsonl").read_text()
        (folder / "manifest.jsonl").write_text(text[:-30])
    elif damage == "gone":
        path.unlink()
    else:
        data[len(data) // 2] ^= 1
        foreign = (folder / manifest.shards(folder)[1].rows).read_bytes()
        damaged = {
            "truncated": data[:-10],
            "emptied": b"",
            "flipped": bytes(data),
            "text": b"no table\n",
            "foreign": foreign,
        }
        path.write_bytes(damaged[damage])
    if damage == "half a line":
        with pytest.warns(PartialResultsWarning):
            load(folder)
    else:
        with pytest.raises(ResultsError, match="run the campaign again"):
            load(folder)
    told = []
    report = run_campaign(everything, folder, jobs=1, notice=told.append)
    assert [text for text in told if "is damaged or gone; its flights are flown again" in text] == told
    assert len(told) == (damage != "half a line")
    assert 0 < report.flights < report.total
    assert load(folder).equals(before)


def _hold(folder, ready):
    from fddbench.results.lock import locked

    with locked(folder):
        ready.set()
        time.sleep(30)


def test_one_run_per_folder(everything, tmp_path):
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    holder = context.Process(target=_hold, args=(tmp_path / "out", ready))
    holder.start()
    try:
        assert ready.wait(30)
        with pytest.raises(ResultsError, match=f"being written by process {holder.pid}"):
            run_campaign(everything, tmp_path / "out", jobs=1)
    finally:
        holder.kill()
        holder.join()
    assert run_campaign(everything, tmp_path / "out", jobs=1).flights


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGKILL])
def test_interrupted_or_killed_it_continues_to_the_same_rows(everything, tmp_path, sign):
    run_campaign(everything, tmp_path / "reference", jobs=1)
    # more and longer flights, so that the signal comes in the middle
    text = TEXT.replace("duration_s: 3.0", "duration_s: 12.0").replace("runs: 2", "runs: 300")
    path, out = write(tmp_path, text), tmp_path / "out"
    command = [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(out), "--jobs", "2"]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, start_new_session=True
    )
    while not ((out / "manifest.jsonl").exists() and (out / "manifest.jsonl").stat().st_size):
        assert process.poll() is None
        time.sleep(0.02)
    os.killpg(process.pid, sign)
    message = process.communicate(timeout=60)[1]
    if sign == signal.SIGINT:
        assert process.returncode == 130
        assert "Run the same command again to continue" in message
        assert "Traceback" not in message
    report = run_campaign(read_campaign(path), out, jobs=2)
    assert 0 < report.continued < report.total
    run_campaign(read_campaign(path), tmp_path / "straight", jobs=2)
    assert load(out).equals(load(tmp_path / "straight"))
