"""A small campaign that has everything: every kind of fault, healthy flights, infeasible ones, several faults, gusts."""

from pathlib import Path

import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.runner.assembling import assemble

TEXT = """\
name: everything
benchmark: yaw_rate
wind: light
seed: 77
duration_s: 3.0
detectors: [sliding_mode_published, voting_monitor]
dispersions:
  grid: {altitude_ft: [20000, 38000]}
  sequence: {mass_error_percent: [0, 10], delta_c_n_percent: [0, -5]}
  monte_carlo:
    runs: 2
    mass_kg: {uniform: [180000, 230000]}
    v_cas_kt: {truncated_normal: {mean: 280, std: 30, low: 200, high: 330}}
    gust_scale_ratio: {uniform: [0.0, 0.3]}
scenarios:
  - {name: healthy, manoeuvre: roll_doublet, duration_s: 8.0}
  - name: oscillatory
    manoeuvre: cruise
    faults: [{kind: oscillatory, sites: [r1, r2], onset_s: 1.0, amplitude_deg_s: 2.0, frequency_hz: 1.0, phase: uniform}]
  - name: nrz_independent
    manoeuvre: turn_coordination_1
    faults: [{kind: nrz, sites: [r2, r3], onset_s: 0.5, amplitude_percent: 20, correlation: independent}]
  - name: noise
    manoeuvre: cruise
    faults: [{kind: noise, sites: [r3], onset_s: 0.0, variance_deg2_s2: 3.0}]
  - name: two_faults
    manoeuvre: cruise
    faults:
      - {kind: jam, mode: replace, freeze: true, sites: [r1], onset_s: 0.5, end_s: 1.5}
      - {kind: runaway, sites: [r2, r3], onset_s: 1.0, rate_deg_s2: 5.0, delay_s: 0.2, correlation: opposite}
"""


def write(folder: Path, text: str = TEXT) -> Path:
    path = folder / "everything.yaml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def everything(tmp_path_factory):
    return read_campaign(write(tmp_path_factory.mktemp("campaign")))


@pytest.fixture(scope="session")
def assembly(everything):
    return assemble(everything)


@pytest.fixture
def shipped():
    return gallery.folder("campaigns")
