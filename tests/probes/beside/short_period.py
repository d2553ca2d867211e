"""LTI short period with pitch-rate feedback through two voted pitch-rate sensors: a benchmark of one's own, in one file."""

from types import SimpleNamespace

import numpy as np
from scipy.signal import cont2discrete

from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, record
from fddbench.blocks.linear import column, product
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import Bus, Parameter, Prepared, Sample, SinglePlant, Site

A, B, FEEDBACK = np.array([[-1.0, 0.95], [-4.0, -1.5]]), np.array([[-0.1], [-8.0]]), 0.2
LIMITS = {"unit_name": "deg/s", "admissible": 20.0, "stops": (-60.0, 60.0), "limits_s": (2.0,)}
SITES = tuple(Site(name=f"q{j + 1}", signal="q_deg_s", row=j, **LIMITS) for j in range(2))
State = record(type("State", (), {"__annotations__": {"x": object, "faults": object}}))
Constants = record(type("Constants", (), {"__annotations__": {"gain": object, "step_deg": object, "faults": object}}))
Numbers = record(type("Numbers", (), {"__annotations__": {"q": object, "faults": object}}))


class Loop:
    truth, before = ("q_true_deg_s",), Draws(Nothing())

    def __init__(self, options):
        self.faults = SignalFaults(SITES, "q_deg_s", options.faults, options.sample_s)
        self.Ad, self.Bd, *_ = cont2discrete((A, B, np.eye(2), np.zeros((2, 1))), options.sample_s)
        self.states = Layout(State(x=2, faults=self.faults.states.shape))
        self.constants = Layout(Constants(gain=ROW, step_deg=ROW, faults=self.faults.constants.shape))
        self.draws = Draws(Numbers(q=Draw(consumers.SENSORS_A, rows=2), faults=self.faults.draws.names))
        self.bus = Bus(sample_s=options.sample_s, sites=SITES, signals={"q_deg_s": 2, "elevator_deg": 0})

    def prepare(self, flights):
        step = np.array([2.0 if name == "step" else 0.0 for name in flights.manoeuvres])
        gain, faults = flights.parameters["gain_ratio"], self.faults.prepare(flights.faults)
        return Prepared(
            constants=Constants(gain=gain, step_deg=step, faults=faults), infeasible_reason=("",) * len(step)
        )

    def start(self, c):
        return State(x=0.0, faults=self.faults.start(c.faults))

    def step(self, x, c, n, sample):
        healthy = x.x[1] + 0.02 * n.q
        faults, q = self.faults.step(x.faults, c.faults, n.faults, healthy, sample)
        u = FEEDBACK * c.gain * 0.5 * (q[0] + q[1]) - np.where(sample >= 100.0, c.step_deg, 0.0)
        after = product(column(self.Ad), x.x) + product(column(self.Bd), np.stack([u]))
        bus, gone = SimpleNamespace(q_deg_s=q, elevator_deg=u), np.abs(x.x[1]) > 60.0
        seen = Sample(measured=bus, truth={"q_true_deg_s": x.x[1]}, departed=gone, added=q - healthy, voted={})
        return State(x=after, faults=faults), seen


class ShortPeriod(SinglePlant):
    name, about = "short_period", "LTI short period with two pitch-rate sensors"
    sites, manoeuvres, shown = SITES, {"trim": 10.0, "step": 10.0}, ("q_deg_s_1", "q_true_deg_s")
    parameters = (Parameter(name="gain_ratio", about="loop gain", default=1.0, low=0.5, high=2.0),)

    def loop(self, options):
        return Loop(options)
