"""Where and as whom a run is started changes nothing: beside files with names of Python's own modules, without a home."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from fddbench import gallery, load
from fddbench.blocks import cache
from fddbench.cli import main

NAMES = ("random", "types", "numpy", "signal")
TEXT = """\
name: names
benchmark: yaw_rate
seed: 11
duration_s: 0.5
detectors: [{detectors}]
dispersions: {{monte_carlo: {{runs: 40, mass_kg: {{uniform: [180000, 220000]}}}}}}
scenarios: [{{name: healthy, manoeuvre: cruise}}]
"""
COMMAND = [sys.executable, "-P", "-c", "from fddbench.cli import entry; entry()"]
"""As the installed command is: without the working folder on the path."""


def test_plugins_may_be_called_as_modules_of_python_are(tmp_path):
    """Workers are processes of their own, which begin where the run was started."""
    (tmp_path / "detectors").mkdir()
    (tmp_path / "a.yaml").write_text(TEXT.format(detectors=", ".join(NAMES)))
    for name in NAMES:
        for end in (".py", ".yaml"):
            text = (gallery.folder("detectors") / f"cusum_example{end}").read_text(encoding="utf-8")
            (tmp_path / "detectors" / f"{name}{end}").write_text(text.replace("cusum_example.py", f"{name}.py"))
    options = ["run", "../a.yaml", "--backend", "numpy", "--jobs", "2", "--out", "../out", "--quiet"]
    done = subprocess.run(
        [*COMMAND, *options], cwd=tmp_path / "detectors", capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert len(load(tmp_path / "out")) == 4 * 40
    assert os.environ.get("PYTHONSAFEPATH") is None


def test_a_notebook_may_go_to_another_folder_between_two_runs(tmp_path, monkeypatch):
    """Worker processes of the first run stay in its folder."""
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        monkeypatch.chdir(tmp_path / name)
        Path("a.yaml").write_text(TEXT.format(detectors="voting_monitor"))
        options = ["--backend", "numpy", "--jobs", "2", "--out", "out", "--quiet"]
        assert main(["run", "a.yaml", *options]) == 0
    assert len(load(tmp_path / "second" / "out")) == len(load(tmp_path / "first" / "out")) == 40


def test_no_cache_without_a_home(monkeypatch):
    def home():
        raise RuntimeError("Could not determine home directory.")

    for name in ("FDDBENCH_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", home)
    cache.store("a", b"body")
    assert cache.load("a") is None


def test_a_run_and_its_report_without_a_home(tmp_path, monkeypatch):
    def home():
        raise RuntimeError("Could not determine home directory.")

    for name in ("FDDBENCH_CACHE", "XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path / "matplotlib"))
    monkeypatch.setattr(Path, "home", home)
    (tmp_path / "a.yaml").write_text(TEXT.format(detectors="voting_monitor"))
    out = str(tmp_path / "out")
    assert main(["run", str(tmp_path / "a.yaml"), "--quiet", "--jobs", "1", "--out", out]) == 0
    assert main(["report", out]) == 0
    assert main(["cost", "voting_monitor"]) == 0


@pytest.mark.skipif(
    sys.platform != "linux" or os.geteuid() != 0 or shutil.which("setpriv") is None, reason="needs another user"
)
def test_a_user_that_nobody_knows(tmp_path):
    """A container started with ``--user 54321``: no home, and no entry in passwd."""
    somebody = [shutil.which("setpriv"), "--reuid", "54321", "--regid", "54321", "--clear-groups"]
    known = subprocess.run([*somebody, *COMMAND, "--version"], capture_output=True, check=False).returncode
    if known:
        pytest.skip("this Python is not for everybody")
    tmp_path.chmod(0o777)
    for parent in tmp_path.parents:
        if parent == Path(tempfile.gettempdir()).resolve():
            break
        parent.chmod(0o755)
    (tmp_path / "a.yaml").write_text(TEXT.format(detectors="voting_monitor"))
    left_out = ("HOME", "XDG_CACHE_HOME", "FDDBENCH_CACHE")
    done = subprocess.run(
        [*somebody, *COMMAND, "run", "a.yaml", "--out", "out", "--quiet"], cwd=tmp_path,
        env={name: value for name, value in os.environ.items() if name not in left_out},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
