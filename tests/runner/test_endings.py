"""How a run ends that the system ends: by a signal, or because nothing more can be written."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import pytest
from tests.runner.tables import digest

from fddbench import load, run

CAMPAIGN = """\
name: ending
benchmark: yaw_rate
seed: 7
duration_s: 12.0
dispersions:
  monte_carlo: {{runs: {runs}}}
scenarios:
  - {{name: healthy, manoeuvre: cruise}}
detectors: [voting_monitor, sliding_mode_published]
"""


def _begin(tmp_path, runs, more=(), **options):
    path = tmp_path / "ending.yaml"
    path.write_text(CAMPAIGN.format(runs=runs))
    command = [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(tmp_path / "out"), "--quiet", *more]
    return subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, **options)


def _left(tmp_path):
    return [path.name for path in (tmp_path / "out").rglob("*.tmp")]


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(("sign", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_a_signal_ends_it_with_what_is_finished(tmp_path, sign, code):
    """Without the handler SIGTERM gives -15 and no word."""
    process = _begin(tmp_path, 6000)
    manifest = tmp_path / "out" / "manifest.jsonl"
    while not (manifest.exists() and manifest.stat().st_size):
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(sign)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == code
    assert "flights are saved" in said
    assert "Traceback" not in said
    done = int(said.split("interrupted; ")[1].split(" of ")[0])
    with pytest.warns(UserWarning, match=f"partial, it holds {done} of 6000 flights"):
        assert len(load(tmp_path / "out")) == 2 * done
    assert run(tmp_path / "ending.yaml", tmp_path / "out").continued == done
    assert _left(tmp_path) == []  # what a thread was writing is swept when it goes on


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("gap_s", "engine"), [(0.003, "auto"), (0.01, "auto"), (0.02, "auto"), (0.1, "auto"), (0.01, "loky")]
)
def test_ctrl_c_twice_ends_with_a_true_count(tmp_path, gap_s, engine):
    """Without the handler of `main._signals` two of these gaps end without a count, and one with a traceback of joblib."""
    process = _begin(tmp_path, 6000, more=["--engine", engine])
    manifest = tmp_path / "out" / "manifest.jsonl"
    while not (manifest.exists() and manifest.stat().st_size):
        assert process.poll() is None
        time.sleep(0.005)
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(gap_s)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    found = re.fullmatch(r"fddbench: interrupted; (\d+) of 6000 flights are saved in \S+\nRun the same .*\n", said)
    assert found, said
    with pytest.warns(UserWarning, match="partial"):
        assert len(load(tmp_path / "out")) == 2 * int(found[1])


@pytest.mark.skipif(os.name != "posix", reason="limits of POSIX")
def test_a_full_disk_ends_it_with_the_path_and_leaves_nothing_half_written(tmp_path):
    """RLIMIT_FSIZE stands for the disk; without the cleaning in `write_bytes` a temporary file stays."""
    limit = 40_000
    process = _begin(tmp_path, 3000, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    said = process.communicate(timeout=120)[1]
    assert process.returncode == 74, said
    assert str(tmp_path / "out") in said
    assert "File too large" in said
    assert "Traceback" not in said
    assert _left(tmp_path) == []
    assert run(tmp_path / "ending.yaml", tmp_path / "out").total == 3000  # with room it goes on
    run(tmp_path / "ending.yaml", tmp_path / "clean")
    assert load(tmp_path / "out").equals(load(tmp_path / "clean"))


SCRIPT = """
set -e
mount -t tmpfs -o size=2m tmpfs "$1/disk" || exit 99
set +e
"$2" -m fddbench run "$1/ending.yaml" --out "$1/disk/out" --quiet
echo "first $?"
find "$1/disk" -name '*.tmp' | wc -l
mount -o remount,size=64m "$1/disk"
"$2" -m fddbench run "$1/ending.yaml" --out "$1/disk/out" --quiet > "$1/second"
echo "second $?"
cp -r "$1/disk/out" "$1/out"
umount "$1/disk"
"""
"""Fills a disk of 2 MB, makes room and goes on; in a space of its own, where mounting is allowed."""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux" or shutil.which("unshare") is None, reason="mounts as Linux does")
def test_a_disk_of_two_megabytes_ends_it_with_the_path_and_with_room_it_goes_on(tmp_path):
    """Without the cleaning in `write_bytes` a temporary file stays; RLIMIT_FSIZE above stands in where nobody may mount."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "ending.yaml").write_text(CAMPAIGN.format(runs=50000).replace("duration_s: 12.0", "duration_s: 0.5"))
    command = ["unshare", "-rm", "bash", "-c", SCRIPT, "bash", str(tmp_path), sys.executable]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    if done.returncode in (1, 99) and "first" not in done.stdout:
        pytest.skip(f"nobody may mount here ({done.stderr.strip()}); RLIMIT_FSIZE stands in")
    assert done.stdout.split() == ["first", "74", "0", "second", "0"], done.stdout + done.stderr
    assert "No space left on device; what is finished is kept, run again" in done.stderr
    assert f"{tmp_path}/disk/out/" in done.stderr
    assert "Traceback" not in done.stderr
    found_done = re.search(r", (\d+) found done", (tmp_path / "second").read_text())
    assert found_done
    assert 0 < int(found_done[1]) < 50000
    run(tmp_path / "ending.yaml", tmp_path / "clean", jobs=1)
    assert digest(tmp_path / "out") == digest(tmp_path / "clean")
