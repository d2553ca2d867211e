"""Killed at any file-system event, a run goes on to the same table and leaves nothing behind."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

CAMPAIGN = """
name: killed
benchmark: yaw_rate
seed: 7
duration_s: 6.0
dispersions:
  monte_carlo: {runs: 6}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - name: jam_a
    manoeuvre: cruise
    faults: [{kind: jam, mode: replace, freeze: true, sites: [r1], onset_s: 2.0}]
detectors: [voting_monitor]
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks of POSIX")
def test_killed_before_every_event_of_a_run_and_of_its_going_on(tmp_path):
    """Without `ours.sweep` 13 of these 71 kills leave a temporary file."""
    campaign = tmp_path / "killed.yaml"
    campaign.write_text(CAMPAIGN)
    command = [sys.executable, str(Path(__file__).with_name("killing.py")), str(campaign), str(tmp_path)]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True, timeout=900).stdout)
    assert (found["run"], found["going on"]) == (0, 0)  # each came to its end once it was killed at every event
    assert found["clean"]["n"] == 12
    kills = found["kills"]
    assert sum(what == "run" for what, *_ in kills) > 30
    assert sum(what == "going on" for what, *_ in kills) > 10
    assert [kill for kill in kills if kill[2] != 0 or kill[3] != found["clean"]] == []
