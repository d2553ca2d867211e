"""A benchmark and two detectors that exist only here, so that these tests know every name and number."""

from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, ClassVar

import pytest
from pydantic import BaseModel, ConfigDict, Field

from fddbench import gallery, registry
from fddbench.blocks.layout import Layout
from fddbench.errors import DesignError, FddbenchError
from fddbench.interfaces import Bus, FaultUnits, Parameter


class Toy:
    name = "toy"
    about = "three yaw-rate sensors on nothing"
    sites = ("r1", "r2", "r3")
    parameters = (
        Parameter(name="mass_kg", about="mass", default=200e3, low=120e3, high=260e3),
        Parameter(name="x_cg_percent", about="centre of gravity", default=30.0, low=17.0, high=41.0),
        Parameter(name="altitude_ft", about="altitude", default=20e3, low=5e3, high=40e3),
        Parameter(name="speed_kt", about="calibrated airspeed", default=260.0, low=160.0, high=300.0),
    )
    refused_parameters: ClassVar = {"mach": "it follows from speed_kt and altitude_ft; disperse those"}
    plants = ("lateral_lpv", "frozen")
    voters = ("median", "closest_two")
    sensors = ("white",)
    winds = ("none", "gust")
    manoeuvres: ClassVar = {"cruise": 60.0, "roll_doublet": 40.0}
    fault_units = FaultUnits(unit="deg/s", admissible=40.0, sensor_range=40.0)

    def detection_time_limit_s(self, n_faulty):
        limits = {1: 120.0, 2: 0.36}
        if n_faulty not in limits:
            raise FddbenchError(f"no limit for {n_faulty} faulty sensors")
        return limits[n_faulty]


class Gains(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)
    threshold_deg_s: Annotated[float, Field(gt=0.0)]
    confirmation_s: float = 0.1
    weights: tuple[float, ...] = ()


class Watcher:
    Gains = Gains

    def __init__(self, gains: Gains, bus: Bus) -> None:
        self.gains, self.bus = gains, bus

    @classmethod
    def from_design(cls, gains, bus):
        if gains.confirmation_s < bus.sample_s:
            raise DesignError(f"confirmation_s = {gains.confirmation_s} is shorter than a sample of {bus.sample_s} s")
        return cls(gains, bus)

    states = Layout(held=0)
    recorded = ()

    def start(self, n_cases):
        return self.states.zeros(n_cases)

    def step(self, state, measured):
        raise NotImplementedError


@pytest.fixture(autouse=True)
def toys(monkeypatch, tmp_path_factory):
    """Registers the benchmark and the detectors beside the real faults."""
    real = registry.kinds
    toys = {
        "benchmark": {"toy": SimpleNamespace(load=lambda: Toy, value="tests:Toy")},
        "detector": {"watcher": SimpleNamespace(load=lambda: Watcher, value="tests:Watcher")},
    }
    shipped = tmp_path_factory.getbasetemp() / "shipped"
    for folder in ("campaigns", "detectors"):
        (shipped / folder).mkdir(parents=True, exist_ok=True)
    monkeypatch.setattr(gallery, "folder", lambda name: shipped / name)
    monkeypatch.setattr(registry, "kinds", lambda family: toys.get(family) or real(family))


@pytest.fixture
def bad_campaigns() -> Path:
    """Folder of campaigns that nobody should get away with."""
    return Path(__file__).parent.parent / "bad_campaigns"


GOOD = """\
name: good
about: Does it work?
benchmark: toy
seed: 7
scenarios:
  - name: healthy
    manoeuvre: cruise
  - name: jam_a
    manoeuvre: cruise
    faults:
      - {kind: jam, sites: [r1], onset_s: 4, amplitude_percent: 10}
dispersions:
  monte_carlo:
    runs: 5
    mass_kg: {uniform: [150e3, 200e3]}
detectors: [plain]
"""

PLAIN = """\
kind: watcher
about: A threshold.
source: made up
tuned_on: [{campaign: tuning, seed: 3}]
gains: {threshold_deg_s: 1, weights: [1, 2.5]}
"""


@pytest.fixture
def write(tmp_path):
    """Writes a campaign (the good one by default, after replacements) and its designs; returns the path."""

    def _write(text=GOOD, *, designs=None, name="campaign.yaml", **changes):
        for old, new in changes.items():
            text = text.replace(old, new)
        folder = tmp_path / "detectors"
        folder.mkdir(exist_ok=True)
        for design, content in ({"plain": PLAIN} | (designs or {})).items():
            (folder / (design if "." in design else f"{design}.yaml")).write_text(content)
        path = tmp_path / name
        path.write_text(text)
        return path

    return _write
