"""Faults from outside: processes killed at random moments, Ctrl-C twice, a disk of 2 MB, files that are gone.

Each time the table is the one of a run in one process that nothing happened to, bit for bit.
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.runner.plugins import PLAIN
from tests.runner.test_endings import CAMPAIGN as ENDING
from tests.runner.test_poison import marked, written
from tests.runner.test_same_bits import bits

from fddbench import load, run
from fddbench.campaign.load import read_campaign
from fddbench.results import manifest
from fddbench.runner.run import run_campaign

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="signals, /proc and mounts of Linux")


def _command(path, out, *more):
    return [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(out), "--quiet", *more]


def _flies(pid):
    """Whether a process is a worker or a supervised one, and none that Python keeps for its own sweeping."""
    try:
        return b"resource_tracker" not in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


@pytest.fixture(scope="module")
def clean(everything, tmp_path_factory):
    """A folder of eleven shards that nothing happened to."""
    folder = tmp_path_factory.mktemp("clean") / "out"
    run_campaign(everything, folder, jobs=1, chunk=3)
    return folder


@given(data=st.data())
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_files_deleted_are_flown_again(everything, clean, tmp_path_factory, data):
    """With `_wrong` of results/mending.py saying nothing the run ends and the table cannot be read."""
    names = [name for shard in manifest.shards(clean) for name, _ in shard.files]
    gone = data.draw(st.sets(st.sampled_from(names), min_size=1))
    out = shutil.copytree(clean, tmp_path_factory.mktemp("gone") / "out")
    for name in gone:
        (out / name).unlink()
    told = []
    report = run_campaign(everything, out, jobs=1, notice=told.append)
    assert len(told) == sum(bool(gone & {name for name, _ in shard.files}) for shard in manifest.shards(clean))
    assert report.flights + report.continued == report.total
    assert bits(load(out)) == bits(load(clean))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_workers_and_supervised_processes_killed_at_random_moments(tmp_path, seed):
    """With one attempt (of runner/pool.py, of a supervised flight) the run ends early or rows are `crashed`."""
    path = written(tmp_path, {"plain": PLAIN})
    path.write_text(path.read_text().replace("runs: 80", "runs: 400").replace("duration_s: 0.6", "duration_s: 2.0"))
    run_campaign(read_campaign(path), tmp_path / "clean", jobs=1)
    mark, chance = f"FDDBENCH_MARK={os.getpid()}_{seed}", random.Random(seed)
    process = subprocess.Popen(
        _command(path, tmp_path / "out", "--jobs", "2"),
        env={**os.environ, **dict([mark.split("=")])}, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    killed = 0
    while process.poll() is None and killed < 6:
        time.sleep(chance.uniform(0.2, 0.8))
        others = [pid for pid in map(int, marked(mark)) if pid != process.pid and _flies(pid)]
        if others:
            with_luck = chance.choice(sorted(others))
            try:
                os.kill(with_luck, signal.SIGKILL)
                killed += 1
            except ProcessLookupError:
                pass
    said = process.communicate(timeout=120)[1]
    assert killed
    assert "Traceback" not in said
    time.sleep(1.0)
    assert marked(mark) == []
    report = run(path, tmp_path / "out", jobs=1)  # where workers died three times in a row it said so, and goes on
    assert report.total == 400
    assert bits(load(tmp_path / "out")) == bits(load(tmp_path / "clean"))


@pytest.mark.slow
def test_ctrl_c_twice_ends_it_with_a_true_count(tmp_path):
    """With the second signal passed on there is a traceback out of the closing of the pool."""
    path, out = tmp_path / "ending.yaml", tmp_path / "out"
    path.write_text(ENDING.format(runs=6000))
    process = subprocess.Popen(_command(path, out), stderr=subprocess.PIPE, text=True)
    while not ((out / "manifest.jsonl").exists() and (out / "manifest.jsonl").stat().st_size):
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    time.sleep(0.03)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert "Traceback" not in said
    done = sum(n for shard in manifest.shards(out) for _, n in shard.cases)
    assert f"interrupted; {done} of 6000" in said
    assert run(path, out).continued == done
    run(path, tmp_path / "clean")
    assert bits(load(out)) == bits(load(tmp_path / "clean"))


_MOUNTED = """
set -e
mount -t tmpfs -o size=2m none "$1"
code=0; "$2" -m fddbench run "$3" --out "$1/out" --quiet || code=$?
find "$1" -name '*.tmp' | wc -l
mount -o remount,size=64m "$1"
"$2" -m fddbench run "$3" --out "$1/out" --quiet >&2
cp -r "$1/out" "$4"
exit $code
"""


@pytest.mark.slow
def test_a_disk_of_two_megabytes(tmp_path):
    """Where nothing may be mounted test_endings.py has the same with RLIMIT_FSIZE. Without the handler: a traceback."""
    disk, path = tmp_path / "disk", tmp_path / "ending.yaml"
    disk.mkdir()
    path.write_text(
        ENDING.format(runs=30_000)
        .replace("12.0", "1.0")
        .replace("runs: 30000", "runs: 30000, mass_kg: {uniform: [180000, 220000]}")
    )
    tried = subprocess.run(
        ["unshare", "-rm", "mount", "-t", "tmpfs", "none", str(disk)], capture_output=True, text=True
    )
    if tried.returncode:
        pytest.skip(
            f"nothing may be mounted here ({tried.stderr.strip()}); RLIMIT_FSIZE stands in, tests/runner/test_endings.py"
        )
    line = ["unshare", "-rm", "sh", "-c", _MOUNTED, "sh", str(disk), sys.executable, str(path), str(tmp_path / "out")]
    done = subprocess.run(line, capture_output=True, text=True, cwd=Path.cwd())
    assert done.returncode == 74, done.stderr
    assert "No space left on device" in done.stderr
    assert str(disk / "out") in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout.split()[-1] == "0" or "\n0\n" in f"\n{done.stdout}\n"
    run(path, tmp_path / "clean")
    assert bits(load(tmp_path / "out")) == bits(load(tmp_path / "clean"))
