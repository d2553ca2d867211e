"""One sample of the jet engine: break, disturb, order, run."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.jet_engine import plant
from fddbench.benchmarks.jet_engine.manoeuvres import KNOTS, inputs
from fddbench.benchmarks.jet_engine.uncertainty import N_NORMALS, SETS
from fddbench.blocks import consumers
from fddbench.blocks.functions import interpolate
from fddbench.blocks.layout import Layout, Rows
from fddbench.blocks.philox import PER_DRAW
from fddbench.errors import FddbenchError
from fddbench.faults.injection import FaultStep
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Bus, FaultUnits, Flights, Floats, Options, Start

__all__ = ["HOLD_S", "SIGMA", "JetEngineLoop"]

HOLD_S, SIGMA = 0.1, 2.0
"""Band-limited white noise of the disturbances: how long a value is held [s], and its standard deviation [-]."""


class JetEngineLoop:
    """The engine with faults and disturbances; open loop, since its input histories are given.

    The measured bus holds outputs and inputs. A disturbance is drawn at the sample at which its hold begins.
    """

    truth = ("f_true_1", "f_true_2", "f_true_3", "d_true_1", "d_true_2", "d_true_3")

    def __init__(self, options: Options, sites: tuple[str, ...], units: FaultUnits) -> None:
        self.sample_s, self.units, self.draw = options.sample_s, units, SETS[options.plant]
        self.hold_samples = float(round(HOLD_S / options.sample_s))
        if abs(self.hold_samples * options.sample_s - HOLD_S) > 1e-9 * HOLD_S:
            raise FddbenchError(
                f"sample_s = {options.sample_s:g} does not divide the {HOLD_S:g} s for which jet_engine holds its "
                "disturbances; use 0.1, 0.05, 0.02 or 0.01"
            )
        self.faults = FaultStep(sites, options.fault_slots, options.sample_s)
        self.consumers = (consumers.DISTURBANCE,)
        self.fault_consumers = tuple(consumers.FAULT_SLOT_0 + j for j in range(options.fault_slots))
        self.start_consumers = tuple(consumers.UNCERTAINTY_0 + j for j in range(N_NORMALS // PER_DRAW))
        self.states = Layout(engine=plant.N, disturbance=plant.N, faults=self.faults.states.size)
        self.constants = Layout(
            engine=plant.CONSTANTS.size,
            knots_s=plant.N * KNOTS,
            u=plant.N * KNOTS,
            sigma=0,
            faults=self.faults.constants.size,
        )
        self.bus = Bus(sample_s=options.sample_s, sites=sites, signals={"y": plant.N, "u": plant.N})

    def fault_rows(self, faults: Sequence[FaultSpecification], phases: Floats) -> Floats:
        """Data rows of the faults of a scenario, see `fddbench.interfaces.Loop.fault_rows`."""
        return self.faults.rows(faults, self.units, phases)

    def start(self, flights: Flights) -> Start:
        """Engines at rest, each with its own Δ; every one of them can run."""
        own = flights.parameters
        knots_s, u = inputs(flights.manoeuvres)
        n_cases = len(flights.manoeuvres)
        delta = own["delta_scale_ratio"] * self.draw(flights.normals)
        return Start(
            state=self.states.zeros(n_cases),
            constants=self.constants.pack(
                engine=plant.constants(delta, self.sample_s),
                knots_s=knots_s,
                u=own["input_scale_ratio"] * u,
                sigma=SIGMA * own["disturbance_scale_ratio"],
                faults=flights.faults,
            ),
            infeasible_reason=("",) * n_cases,
        )

    def step(
        self, state: Rows, constants: Rows, normals: Rows, sample: Any
    ) -> tuple[Rows, SimpleNamespace, Mapping[str, Rows], Rows]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        x, c = self.states.unpack(state), self.constants.unpack(constants)
        slots = [normals[PER_DRAW * (1 + j) : PER_DRAW * (2 + j)] for j in range(self.faults.slots)]
        f, faults = self.faults.step(np.zeros_like(x.engine), x.faults, c.faults, slots, sample)
        begins = sample - self.hold_samples * np.floor(sample / self.hold_samples) == 0.0
        d = np.where(begins, c.sigma * normals[: plant.N], x.disturbance)
        time_s, n = sample * self.sample_s, KNOTS
        u = np.stack(
            [interpolate(time_s, c.knots_s[i * n : (i + 1) * n], c.u[i * n : (i + 1) * n]) for i in range(plant.N)]
        )
        engine, y = plant.step(x.engine, plant.CONSTANTS.unpack(c.engine), np.concatenate([f, d, u]))
        truth = dict(zip(self.truth, [*f, *d], strict=True))
        after = self.states.pack(engine=engine, disturbance=d, faults=faults)
        return after, SimpleNamespace(y=y, u=u), truth, np.zeros_like(y[0]) > 1.0
