"""A level held on one of two sensors: a benchmark that flies on the spare one once the first is declared."""

from types import SimpleNamespace

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import ROW, Layout, record
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import Bus, Detectability, Parameter, Prepared, Sample, SinglePlant, Site

SITES = tuple(
    Site(name=name, signal="level_deg", row=row, unit_name="deg", admissible=10.0, limits_s=(1.0,))
    for row, name in enumerate(("first", "spare"))
)
State = record(type("State", (), {"__annotations__": {"level": object, "faults": object}}))
Constants = record(type("Constants", (), {"__annotations__": {"gain": object, "faults": object}}))
Numbers = record(type("Numbers", (), {"__annotations__": {"noise": object, "faults": object}}))


class Loop:
    truth, before, reconfigures = ("level_true_deg", "used"), NO_DRAWS, True

    def __init__(self, options):
        self.faults, self.T = SignalFaults(SITES, "level_deg", options.faults, options.sample_s), options.sample_s
        self.states = Layout(State(level=ROW, faults=self.faults.states.shape))
        self.constants = Layout(Constants(gain=ROW, faults=self.faults.constants.shape))
        self.draws = Draws(Numbers(noise=Draw(consumers.SENSORS_A, rows=2), faults=self.faults.draws.names))
        self.bus = Bus(sample_s=self.T, sites=SITES, signals={"level_deg": 2})

    def prepare(self, flights):
        constants = Constants(gain=flights.parameters["gain_per_s"], faults=self.faults.prepare(flights.faults))
        return Prepared(constants=constants, infeasible_reason=("",) * flights.n_cases)

    def start(self, c):
        return State(level=0.0, faults=self.faults.start(c.faults))

    def step(self, x, c, n, sample, declared=None):
        healthy = np.stack([x.level, x.level]) + 0.01 * n.noise
        faults, shown = self.faults.step(x.faults, c.faults, n.faults, healthy, sample)
        used = np.zeros_like(x.level) if declared is None else declared[0]
        order = -c.gain * np.where(used > 0.0, shown[1], shown[0])
        truth = {"level_true_deg": x.level, "used": used}
        gone = np.abs(x.level) > 8.0
        seen = Sample(measured=SimpleNamespace(level_deg=shown), truth=truth, departed=gone, added=shown - healthy)
        return State(level=x.level + self.T * order, faults=faults), seen


class Standby(SinglePlant):
    name, about = "standby", "a level held on one of two sensors"
    sites, manoeuvres, shown = SITES, {"hold": 6.0}, ("level_deg_1",)
    detectability = (Detectability(site="first", size="amplitude_deg", axes=("gain_per_s", "time_constant_s")),)
    parameters = (Parameter(name="gain_per_s", about="loop gain", default=2.0, low=0.5, high=4.0),)

    def loop(self, options):
        return Loop(options)

    def derived(self, chosen, parameters):
        return {"time_constant_s": 1.0 / parameters["gain_per_s"]}
