"""A small campaign in a folder of results with several shards, flown once and copied for every test."""

import shutil

import pytest

from fddbench.campaign.load import read_campaign
from fddbench.runner.run import run_campaign

TEXT = """\
name: small
benchmark: yaw_rate
seed: 5
duration_s: 1.0
detectors: [voting_monitor]
dispersions: {monte_carlo: {runs: 6, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - name: jam
    manoeuvre: cruise
    faults: [{kind: jam, sites: [r1], onset_s: 0.2, end_s: 0.8, amplitude_percent: 5}]
"""


def fly(campaign, folder, **options):
    """Run with NumPy, two flights a shard: 6 shards of rows, 6 of events."""
    return run_campaign(campaign, folder, **{"jobs": 1, "chunk": 2, "backend": "numpy"} | options)


@pytest.fixture(scope="session")
def campaign(tmp_path_factory):
    path = tmp_path_factory.mktemp("small") / "small.yaml"
    path.write_text(TEXT)
    return read_campaign(path)


@pytest.fixture(scope="session")
def flown(campaign, tmp_path_factory):
    folder = tmp_path_factory.mktemp("flown") / "out"
    fly(campaign, folder)
    return folder


@pytest.fixture
def out(flown, tmp_path):
    """Finished folder of one's own."""
    return shutil.copytree(flown, tmp_path / "out")


def everything(folder):
    """Content by name of all files below a folder, but for the lock."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in (".lock", ".pid")
    }
