"""What the published benchmark does not have: more sensors, surfaces that fail, a voter with a memory."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.blocks.layout import ROW, Layout, Row, record
from fddbench.faults.bias import Bias
from fddbench.faults.jam import Jam
from fddbench.interfaces import Site


class MoreSites(LateralLpvPlant):
    """The same aircraft with five yaw-rate sensors, and two surfaces that may fail."""

    sites = (
        *(replace(LateralLpvPlant.sites[0], name=f"r{row + 1}", row=row) for row in range(5)),
        Site(name="rudder", signal="surface_deg", row=0, kind="actuator", unit_name="deg", admissible=30.0),
        Site(name="spoiler_8", signal="surface_deg", row=12, kind="actuator", unit_name="deg", admissible=35.0),
    )


def test_more_sensors_are_read_voted_and_have_noise_of_their_own(bench):
    loop = bench.loop(plant=MoreSites, sensors="white")
    assert loop.bus.redundant("r_deg_s") == ("r1", "r2", "r3", "r4", "r5")
    assert loop.bus.sites_of("actuator") == ("rudder", "spoiler_8")
    # the fourth and fifth sensor draw beside, so that the first three keep their numbers
    assert loop.draws.streams == ((0, "flight"), (512, "flight"), (1, "flight"))
    draws = np.random.default_rng(0).normal(size=(51, loop.draws.size, 2))
    now = bench.fly(loop, 2, 0.5, draws=draws)
    numbers = draws[:, [0, 1, 2, 4, 5]]
    np.testing.assert_allclose(now["r_deg_s"] - now["r_true_deg_s"][:, np.newaxis], 0.01 * numbers, atol=1e-15)
    assert np.array_equal(now["r_voted_deg_s"], np.median(now["r_deg_s"], axis=1))


def test_a_surface_that_is_stuck_moves_the_aircraft_and_is_seen_on_the_bus(bench):
    jam = [
        Jam.in_unit("deg")(kind="jam", sites=("rudder",), onset_s=0.5, mode="replace", hold_value_deg=3.0),
        Jam.in_unit("deg")(kind="jam", sites=("spoiler_8",), onset_s=1.0, amplitude_percent=10.0),
    ]
    loop = bench.loop(plant=MoreSites, faults=[jam])
    now = bench.fly(loop, 2, 3.0, faults=[jam, []])
    surface = now["surface_deg"]
    assert (surface[50:, 0, 0] == 3.0).all()
    assert not surface[:50].any()
    assert (surface[100, 12] == [3.5, 0.0]).all()
    assert now["r_true_deg_s"][51, 0] != 0.0
    assert np.abs(now["beta_true_deg"][-1, 0]) > 0.1
    assert not surface[:, :, 1].any()
    assert not now["r_true_deg_s"][:, 1].any()
    # the sensors are healthy: they read the truth
    assert np.array_equal(now["r_deg_s"][:, 0], now["r_true_deg_s"])


@record
class Voted:
    """What was voted last [deg/s]."""

    deg_s: Row


class Sluggish:
    """A voter with a memory: half of what it voted before."""

    states = Layout(Voted(deg_s=ROW))

    def start(self):
        return Voted(deg_s=0.0)

    def step(self, x, sensors):
        voted = 0.5 * x.deg_s + 0.5 * np.median(sensors, axis=0)
        return Voted(deg_s=voted), voted


def test_a_voter_with_a_memory_flies(bench):
    bias = [Bias(kind="bias", sites=("r1", "r2", "r3"), onset_s=0.0, amplitude_deg_s=1.0)]
    loop = bench.loop(voter=Sluggish, faults=[bias])
    assert loop.states.size == bench.loop(faults=[bias]).states.size + 1
    now = bench.fly(loop, 1, 0.02, faults=[bias])
    assert now["r_voted_deg_s"][0, 0] == 0.5
    assert now["r_voted_deg_s"][1, 0] == pytest.approx(0.75, abs=0.01)


def test_a_plant_that_is_not_flown_is_not_imported():
    """A small campaign would spend more on it than on itself."""
    code = (
        "import sys; from fddbench.benchmarks.yaw_rate import YawRate; "
        "plants = YawRate.choices['plant'].options; assert list(plants) == ['lateral_lpv', 'transport_6dof']; "
        "plants['lateral_lpv']; print(*(name for name in sys.modules if 'transport' in name))"
    )
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert not set(told.stdout.split()) - {"fddbench.flight.transport", "fddbench.flight.transport.shipped"}
