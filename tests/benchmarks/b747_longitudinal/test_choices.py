"""Contract: a law and a plant of one's own fly from a file beside the campaign."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench.benchmarks.b747_longitudinal.laws import tracking
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer

MINE = '''
from fddbench.benchmarks.b747_longitudinal.laws.open_loop import OpenLoop
from fddbench.benchmarks.b747_longitudinal.plants.nonlinear import Nonlinear


class Damper(OpenLoop):
    """Elevator against the pitch rate."""

    def step(self, x, c, n, seen, command, elevator_declared):
        x, orders = super().step(x, c, n, seen, command, elevator_declared)
        return x, type(orders)(
            elevator_deg=orders.elevator_deg + 2.0 * seen.q_deg_s,
            stabiliser_deg=orders.stabiliser_deg,
            thrust_n=orders.thrust_n,
        )


class Heavy(Nonlinear):
    """Twice the inertia."""

    def prepare(self, parameters, manoeuvres):
        made = super().prepare(parameters, manoeuvres)
        made.constants.aircraft.iyy_kg_m2[...] *= 2.0
        return made


class NoLaw:
    """Nothing."""
'''
NUMBERS = '''
from pathlib import Path

from fddbench.benchmarks.b747_longitudinal.laws.law_file import read_law
from fddbench.benchmarks.b747_longitudinal.laws.tracking import Tracking


class Own(Tracking):
    """Linear-quadratic, of a file of mine."""

    law = read_law(Path(__file__).with_name("numbers.yaml"))
'''
WATCHER = """
import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Nothing
from fddbench.interfaces import Verdict


class Watcher:
    about, recorded, watches, states = "nothing", (), (), Layout(Nothing())

    class Gains(BaseModel):
        pass

    from_design = classmethod(lambda cls, gains, bus: cls())

    def start(self):
        return Nothing()

    def step(self, x, measured):
        zero = 0.0 * np.abs(measured.q_deg_s)
        return x, Verdict(np.stack([zero])[:0], zero)
"""


@pytest.fixture
def write(tmp_path):
    (tmp_path / "detectors").mkdir()
    (tmp_path / "mine.py").write_text(MINE, encoding="utf-8")
    (tmp_path / "detectors" / "watcher.py").write_text(WATCHER, encoding="utf-8")
    design = "kind: watcher.py:Watcher\nsource: none\ntuned_on: null\ngains: {}\n"
    (tmp_path / "detectors" / "watcher.yaml").write_text(design, encoding="utf-8")

    def campaign(**chosen):
        path = tmp_path / "campaign.yaml"
        content = {
            "name": "own", "benchmark": "b747_longitudinal", "seed": 1, "sample_s": 0.04, "duration_s": 20.0,
            "detectors": ["watcher"], "scenarios": [{"name": "pulse", "manoeuvre": "elevator_pulse"}], **chosen,
        }  # fmt: skip
        path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        return path

    return campaign


def pitch_rate_deg_s(path):
    assembly = assemble(read_campaign(path))
    return Flyer(assembly).fly(assembly.batch(np.array([0])), ["measured:q_deg_s"]).recorded["measured:q_deg_s"]


def test_a_law_and_a_plant_of_ones_own(write):
    opened, damped, heavy = (
        pitch_rate_deg_s(write(**chosen))
        for chosen in (
            {"law": "open_loop"},
            {"law": "mine.py:Damper"},
            {"law": "open_loop", "plant": "mine.py:Heavy"},
        )
    )
    assert np.abs(damped).max() < 0.7 * np.abs(opened).max()
    assert np.abs(heavy[130]) < 0.7 * np.abs(opened[130])


def test_a_law_of_numbers_of_ones_own(write, tmp_path):
    numbers = Path(tracking.__file__).parents[1] / "data" / "law_lqi.yaml"
    (tmp_path / "numbers.yaml").write_text(numbers.read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "numbers.py").write_text(NUMBERS, encoding="utf-8")
    path = write(law="numbers.py:Own")
    np.testing.assert_array_equal(pitch_rate_deg_s(path), pitch_rate_deg_s(write(law="lqi")))
    # the numbers travel with the results, like every file that a plug-in reads
    assert "numbers.yaml" in read_campaign(write(law="numbers.py:Own")).files()


def test_a_class_that_is_no_law_is_told_what_is_missing(write):
    with pytest.raises(CampaignError, match="prepare"):
        read_campaign(write(law="mine.py:NoLaw"))
