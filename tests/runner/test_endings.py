"""How a run ends that the system ends: by a signal, or because nothing more can be written."""

import os
import resource
import signal
import subprocess
import sys
import time

import pytest

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


def _begin(tmp_path, runs, **options):
    path = tmp_path / "ending.yaml"
    path.write_text(CAMPAIGN.format(runs=runs))
    command = [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(tmp_path / "out"), "--quiet"]
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
