"""A campaign in shards: as many jobs, one table."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.runner.jammed import jammed

import fddbench
from fddbench.cli import main
from fddbench.runner.shares import Shares


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("shared.yaml").write_text(jammed("shared", duration_s=4.0))
    return tmp_path


def _said(capsys):
    found = capsys.readouterr()
    return found.out + found.err


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 60))
def test_every_flight_is_in_one_shard(count):
    plan = fddbench.plan("smoke")
    parts = [Shares(Path(), count).cases(plan, k) for k in range(1, count + 1)]
    assert sorted(np.concatenate(parts).tolist()) == list(range(plan.n_cases))


def test_shards_in_any_order_are_the_campaign_flown_at_once(here, capsys):
    assert main(["plan", "shared.yaml", "--shards", "3", "--out", "s p"]) == 0
    assert main(["plan", "shared.yaml", "--shards", "3", "--out", "s p"]) == 0
    for k in (3, 1):
        assert main(["shard", str(k), "s p", "--quiet", "--jobs", "1"]) == 0
    assert main(["merge", "s p", "--output", "part"]) == 0
    assert "part holds " in (said := _said(capsys))
    assert " of 80 flights" in said
    assert main(["shard", "2", "s p", "--quiet", "--jobs", "1"]) == 0
    assert main(["shard", "2", "s p", "--quiet", "--jobs", "1"]) == 0
    assert "0 flights flown" in _said(capsys)
    assert main(["merge", "s p", "--output", "whole"]) == 0
    fddbench.run("shared.yaml", "once", jobs=1)
    assert fddbench.load("whole").equals(fddbench.load("once"))


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("shard 1 nowhere", "nowhere is not planned in shards"),
        ("shard 4 planned", "planned is planned in shards 1 to 3, there is no shard 4"),
        ("plan shared.yaml --shards 2 --out planned", "is planned in 3 shards, not 2"),
        ("plan other.yaml --shards 3 --out planned", "another campaign"),
        ("plan shared.yaml --shards 2000 --out new", "too few for 2000 shards: ask for at most "),
        ("plan shared.yaml --shards 2 --out full", "full holds something else than a plan"),
        ("merge planned --output new", "no shard of planned was flown"),
        ("run shared.yaml --out planned", "planned is no folder of results"),
    ],
)
def test_what_cannot_be_is_said_and_writes_nothing(here, capsys, command, said):
    Path("other.yaml").write_text(jammed("shared", duration_s=4.0, seed=8))
    Path("full").mkdir()
    Path("full/mine.txt").write_text("mine")
    assert main(["plan", "shared.yaml", "--shards", "3", "--out", "planned"]) == 0
    before = sorted(here.rglob("*"))
    assert main([*command.split(), "--quiet"] if command.startswith(("run", "shard")) else command.split()) == 2
    assert said in _said(capsys)
    assert [path for path in sorted(here.rglob("*")) if path not in before and path.name not in (".lock", ".pid")] == []


def test_the_job_of_slurm_names_what_it_flies(here, capsys):
    assert main(["slurm", "shared.yaml", "--shards", "3", "--out", "s p", "--time", "1:00:00"]) == 0
    found = capsys.readouterr()
    for line in ("#SBATCH --array=1-3", "#SBATCH --requeue", "#SBATCH --signal=B:TERM@120", "#SBATCH --time=1:00:00"):
        assert line in found.out.splitlines()
    assert "fddbench plan shared.yaml --shards 3 --out 's p'" in found.err
    with pytest.raises(SystemExit):
        main(["slurm", "shared.yaml", "--time", "soon"])
    subprocess.run(["bash", "-n"], input=found.out, text=True, check=True)


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals and bash")
def test_a_job_that_is_ended_is_requeued_and_goes_on(here, capsys):
    """Without the trap the shell ends by the signal (-15), the shard flies on without it, and nobody asks for another turn."""
    Path("shared.yaml").write_text(jammed("shared", runs=20000, duration_s=20.0))
    main(["plan", "shared.yaml", "--shards", "1", "--out", "s"])
    capsys.readouterr()
    main(["slurm", "shared.yaml", "--shards", "1", "--out", "s"])
    Path("job.sbatch").write_text(capsys.readouterr().out)
    (here / "bin").mkdir()
    for name, text in (("scontrol", 'echo "$@" >> asked'), ("fddbench", f'exec "{sys.executable}" -m fddbench "$@"')):
        (here / "bin" / name).write_text(f"#!/bin/bash\n{text}\n")
        (here / "bin" / name).chmod(0o755)
    own = {"PATH": f"{here / 'bin'}:{os.environ['PATH']}", "SLURM_ARRAY_TASK_ID": "1", "SLURM_ARRAY_JOB_ID": "77"}
    job = subprocess.Popen(["bash", "job.sbatch"], env={**os.environ, **own}, start_new_session=True)
    listed = here / "s" / "shard-0001" / "manifest.jsonl"
    while not (listed.is_file() and listed.stat().st_size):
        assert job.poll() is None
        time.sleep(0.05)
    job.send_signal(signal.SIGTERM)  # to the shell alone, as B: says
    assert job.wait(timeout=60) == 143
    assert Path("asked").read_text() == "requeue 77_1\n"
    assert main(["merge", "s", "--output", "part"]) == 0
    with pytest.warns(UserWarning, match="partial"):
        assert len(fddbench.load("part"))
