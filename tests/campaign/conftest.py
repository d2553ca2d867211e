"""A benchmark and two detectors that exist only here, so that these tests know every name and number."""

from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, ClassVar

import numpy as np
import pytest
from pydantic import BaseModel, ConfigDict, Field

from fddbench import gallery, kinds
from fddbench.blocks.layout import Layout, Rows, record
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Choice, Parameter, SinglePlant, Site, Verdict
from fddbench.voting.closest_two import ClosestTwo
from fddbench.voting.median import Median

RATE = {
    "signal": "r_deg_s",
    "unit_name": "deg/s",
    "admissible": 40.0,
    "stops": (-40.0, 40.0),
    "limits_s": (120.0, 0.36),
}


class Toy(SinglePlant):
    name = "toy"
    about = "three yaw-rate sensors on nothing, and a surface that nobody requires to be found"
    sites = (
        *(Site(name=f"r{row + 1}", row=row, **RATE) for row in range(3)),
        Site(name="rudder", kind="actuator", signal="rudder_deg", unit_name="deg", admissible=30.0),
    )
    parameters = (
        Parameter(name="mass_kg", about="mass", default=200e3, low=120e3, high=260e3),
        Parameter(name="x_cg_percent", about="centre of gravity", default=30.0, low=17.0, high=41.0),
        Parameter(name="altitude_ft", about="altitude", default=20e3, low=5e3, high=40e3),
        Parameter(name="speed_kt", about="calibrated airspeed", default=260.0, low=160.0, high=300.0),
    )
    refused_parameters: ClassVar = {"mach": "it follows from speed_kt and altitude_ft; disperse those"}
    choices: ClassVar = {
        "plant": Choice(about="what flies", options={"lateral_lpv": "moving", "frozen": "frozen"}),
        "voter": Choice(
            about="voter", options={"median": Median, "closest_two": ClosestTwo}, family="voter", needs=("vote",)
        ),
        "sensors": Choice(about="noise", options={"white": 0.01}, family="sensor", needs=("r_deg_s",)),
        "wind": Choice(about="gust", options={"none": 0.0, "gust": 3.0}),
    }
    manoeuvres: ClassVar = {"cruise": 60.0, "roll_doublet": 40.0}

    def loop(self, options):
        raise NotImplementedError


class Gains(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)
    threshold_deg_s: Annotated[float, Field(gt=0.0)]
    confirmation_s: float = 0.1
    weights: tuple[float, ...] = ()


@record
class Held:
    held: Rows


class Watcher:
    Gains = Gains
    states, recorded = Layout(Held(held=3)), ()
    watches = ("r1", "r2", "r3")

    def __init__(self, gains: Gains, bus: Bus) -> None:
        self.gains, self.bus = gains, bus

    @classmethod
    def from_design(cls, gains, bus):
        if gains.confirmation_s < bus.sample_s:
            raise DesignError(f"confirmation_s = {gains.confirmation_s} is shorter than a sample of {bus.sample_s} s")
        return cls(gains, bus)

    def start(self):
        return Held(held=0.0)

    def step(self, x, measured):
        rates = np.abs(measured.r_deg_s)
        held = np.where(rates > self.gains.threshold_deg_s, 1.0, x.held)
        return Held(held=held), Verdict(held, rates[0] / self.gains.threshold_deg_s)


def pretend(monkeypatch, family, **members):
    """Register members of a family beside the real ones, as a package would."""
    real = kinds.registered
    points = {
        name: member
        if hasattr(member, "load")
        else SimpleNamespace(load=lambda found=member: found, value=f"tests:{name}")
        for name, member in members.items()
    }
    monkeypatch.setattr(kinds, "registered", lambda asked: real(asked) | (points if asked == family else {}))


def broken(error):
    """Entry point of a package that raises on import."""

    def load():
        raise error

    return SimpleNamespace(load=load, value="broken.package:Thing")


@pytest.fixture(autouse=True)
def toys(monkeypatch, tmp_path_factory):
    """Registers the benchmark and the detector instead of the real ones, beside the real faults."""
    real = kinds.registered
    toys = {
        "benchmark": {"toy": SimpleNamespace(load=lambda: Toy, value="tests:Toy")},
        "detector": {"watcher": SimpleNamespace(load=lambda: Watcher, value="tests:Watcher")},
    }
    shipped = tmp_path_factory.getbasetemp() / "shipped"
    for folder in ("campaigns", "detectors"):
        (shipped / folder).mkdir(parents=True, exist_ok=True)
    monkeypatch.setattr(gallery, "folder", lambda name: shipped / name)
    monkeypatch.setattr(kinds, "registered", lambda family: toys.get(family) or real(family))


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
