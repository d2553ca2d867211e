"""A mass on a spring, pushed: a sensor in deg/s, an actuator in deg and a thruster in N in one benchmark."""

from types import SimpleNamespace

import numpy as np

from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, record
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import Bus, Prepared, Sample, SinglePlant, Site

SITES = (
    Site(name="gyro", signal="q_deg_s", unit_name="deg/s", admissible=20.0, limits_s=(2.0,)),
    Site(
        name="vane",
        kind="actuator",
        signal="vane_deg",
        unit_name="deg",
        admissible=25.0,
        stops=(-25.0, 25.0),
        floats=True,
        limits_s=(3.0,),
    ),
    Site(name="thruster", kind="actuator", signal="thrust_n", unit_name="N", admissible=1000.0, limits_s=(4.0,)),
)


def parts(names):
    return record(type("Parts", (), {"__annotations__": dict.fromkeys(names, object)}))


State, Faults = parts(("rate", *[site.name for site in SITES])), parts([site.name for site in SITES])


class Loop:
    truth, before = ("rate_true_deg_s",), NO_DRAWS

    def __init__(self, options):
        self.faults = {s.name: SignalFaults(SITES, s.signal, options.faults, options.sample_s) for s in SITES}
        self.T = options.sample_s
        self.states = Layout(State(rate=ROW, **{name: f.states.shape for name, f in self.faults.items()}))
        self.constants = Layout(Faults(**{name: f.constants.shape for name, f in self.faults.items()}))
        self.draws = Draws(Faults(**{name: f.draws.names for name, f in self.faults.items()}))
        self.bus = Bus(sample_s=self.T, sites=SITES, signals={"q_deg_s": 0, "vane_deg": 0, "thrust_n": 0})

    def prepare(self, flights):
        made = Faults(**{name: f.prepare(flights.faults) for name, f in self.faults.items()})
        return Prepared(constants=made, infeasible_reason=("",) * flights.n_cases)

    def start(self, c):
        return State(rate=0.0, **{name: f.start(getattr(c, name)) for name, f in self.faults.items()})

    def step(self, x, c, n, sample):
        healthy = {"gyro": x.rate, "vane": 0.0 * x.rate + 2.0, "thruster": 0.0 * x.rate + 100.0}
        after, shown = {}, {}
        for name, f in self.faults.items():
            args = (getattr(x, name), getattr(c, name), getattr(n, name))
            after[name], rows = f.step(*args, np.stack([healthy[name]]), sample, free=np.stack([-0.3 * x.rate]))
            shown[name] = rows[0]
        rate = x.rate + self.T * (0.5 * shown["vane"] + 0.01 * shown["thruster"] - shown["gyro"])
        bus = SimpleNamespace(q_deg_s=shown["gyro"], vane_deg=shown["vane"], thrust_n=shown["thruster"])
        seen = Sample(measured=bus, truth={"rate_true_deg_s": x.rate}, departed=np.abs(x.rate) > 1e6)
        return State(rate=rate, **after), seen


class ThreeUnits(SinglePlant):
    name, about = "three_units", "sites in deg/s, deg and N"
    sites, manoeuvres = SITES, {"hold": 5.0}

    def loop(self, options):
        return Loop(options)
