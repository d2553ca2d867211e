"""Processes below a run that are killed from outside at random times: no row is lost or changed, and no process stays."""

import os
import random
import signal
import subprocess
import sys
import time

import pytest
from tests.runner.jammed import jammed
from tests.runner.living import below
from tests.runner.plugins import PLAIN, write
from tests.runner.tables import digest

import fddbench
from fddbench.results.manifest import shards

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc"),
]


def flown_while_killing(path, out, options, word, kills, chance, least=1):
    """Run a campaign, kill so many times one of the processes whose command line has a word, while there are at least so many.

    Gives its exit code, what it said, and how many were killed.
    """
    name, value = "FDDBENCH_MARK", f"{os.getpid()}_{out.name}"
    command = [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(out), "--quiet", *options]
    run = subprocess.Popen(
        command, env={**os.environ, name: value}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    killed = []
    while run.poll() is None and len(killed) < kills:
        time.sleep(chance.uniform(0.05, 0.6))
        able = [n for n, line in below(f"{name}={value}").items() if word in line and n not in killed]
        if len(able) >= least:
            killed.append(chance.choice(able))
            os.kill(killed[-1], signal.SIGKILL)
    said = run.communicate(timeout=300)[1]
    time.sleep(1.0)
    assert below(f"{name}={value}") == {}
    assert "Traceback" not in said
    return run.returncode, said, len(killed)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    path = tmp_path_factory.mktemp("killed") / "killed.yaml"
    path.write_text(jammed("killed", runs=8000, duration_s=6.0))
    fddbench.run(path, path.parent / "clean", jobs=1)
    return path


def test_killed_workers_of_loky_lose_nothing(campaign, tmp_path):
    """Seen to fail with one attempt of the pool (`_ATTEMPTS`) instead of three: the run ends with 2."""
    code, said, killed = flown_while_killing(
        campaign, tmp_path / "out", ["--engine", "loky"], "popen_loky", 2, random.Random(1)
    )
    assert (code, killed) == (0, 2), said
    assert digest(tmp_path / "out") == digest(campaign.parent / "clean")


def test_workers_of_loky_that_are_always_killed_end_the_run_and_it_goes_on(campaign, tmp_path):
    code, said, _ = flown_while_killing(
        campaign, tmp_path / "out", ["--engine", "loky"], "popen_loky", 99, random.Random(2)
    )
    assert code == 2
    assert "workers died 3 times" in said
    assert "Run the same command again to continue" in said
    assert sum(shard.statuses["ok"] for shard in shards(tmp_path / "out")) < 16000
    fddbench.run(campaign, tmp_path / "out")
    assert digest(tmp_path / "out") == digest(campaign.parent / "clean")


@pytest.mark.parametrize("seed", [1, 2])
def test_killed_processes_of_a_supervised_detector_lose_nothing(tmp_path, seed):
    """Servers, stages and flight processes alike. Seen to fail with one try of a flight (`verdicts._TRIES`): crashed rows."""
    path = write(tmp_path, {"plain": PLAIN}, text=jammed("killed", runs=24, duration_s=6.0, detectors="NAMES"))
    fddbench.run(path, tmp_path / "clean", jobs=1)
    code, said, killed = flown_while_killing(
        path, tmp_path / "out", ["--jobs", "1"], "supervised.server", 4, random.Random(seed), least=3
    )
    assert (code, killed) == (0, 4), said
    assert digest(tmp_path / "out") == digest(tmp_path / "clean")
