"""One sample of the jet engine: break, disturb, order, run."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.jet_engine import plant
from fddbench.benchmarks.jet_engine.manoeuvres import KNOTS, inputs
from fddbench.benchmarks.jet_engine.uncertainty import N_NORMALS
from fddbench.blocks import consumers
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import interpolate
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.philox import PER_DRAW
from fddbench.errors import FddbenchError
from fddbench.faults.injection import SignalFaults, SignalFaultsState
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample, Site

__all__ = ["HOLD_S", "SIGMA", "JetEngineLoop"]

HOLD_S, SIGMA = 0.1, 2.0
"""Band-limited white noise of the disturbances: how long a value is held [s], and its standard deviation [-]."""


@record
class EngineState:
    """States of the engine [-], the disturbances that are held [-], and the faults."""

    engine: Rows
    disturbance: Rows
    faults: SignalFaultsState


@record
class EngineLoopConstants:
    """Matrices; breakpoints of the inputs ([s], [-]), input after input; sigma of the disturbances [-]; the faults."""

    engine: plant.EngineConstants
    knots_s: Rows
    u: Rows
    sigma: Row
    faults: Part


@record
class EngineDraws:
    """New disturbances, and the faults."""

    disturbance: Rows
    faults: Part


class JetEngineLoop:
    """The engine with faults and disturbances; open loop, since its input histories are given.

    The measured bus holds outputs and inputs. A disturbance is drawn at the sample at which its hold begins.
    """

    truth = ("f_true_1", "f_true_2", "f_true_3", "d_true_1", "d_true_2", "d_true_3")
    before: Draws[Any] = Draws(
        tuple(Draw(consumers.UNCERTAINTY_0 + j, rows=PER_DRAW) for j in range(N_NORMALS // PER_DRAW))
    )

    def __init__(self, options: Options, sites: tuple[Site, ...]) -> None:
        self.sample_s, self.draw = options.sample_s, options.chosen["plant"]
        self.hold_samples = float(round(HOLD_S / options.sample_s))
        if abs(self.hold_samples * options.sample_s - HOLD_S) > 1e-9 * HOLD_S:
            raise FddbenchError(
                f"sample_s = {options.sample_s:g} does not divide the {HOLD_S:g} s for which jet_engine holds its "
                "disturbances; use 0.1, 0.05, 0.02 or 0.01"
            )
        self.faults = SignalFaults(sites, "f", options.faults, options.sample_s)
        self.states = Layout(EngineState(engine=plant.N, disturbance=plant.N, faults=self.faults.states.shape))
        self.constants = Layout(
            EngineLoopConstants(
                engine=plant.CONSTANTS.shape,
                knots_s=plant.N * KNOTS,
                u=plant.N * KNOTS,
                sigma=ROW,
                faults=self.faults.constants.shape,
            )
        )
        disturbance = Draw(consumers.DISTURBANCE, rows=plant.N)
        self.draws: Draws[EngineDraws] = Draws(EngineDraws(disturbance=disturbance, faults=self.faults.draws.names))
        self.bus = Bus(sample_s=options.sample_s, sites=sites, signals={"y": plant.N, "u": plant.N})

    def prepare(self, flights: Flights) -> Prepared:
        """Engines with their own Δ; every one of them can run."""
        own = flights.parameters
        knots_s, u = inputs(flights.manoeuvres)
        delta = own["delta_scale_ratio"] * self.draw(np.concatenate(flights.normals))
        constants = EngineLoopConstants(
            engine=plant.constants(delta, self.sample_s),
            knots_s=knots_s,
            u=own["input_scale_ratio"] * u,
            sigma=SIGMA * own["disturbance_scale_ratio"],
            faults=self.faults.prepare(flights.faults),
        )
        return Prepared(constants=constants, infeasible_reason=("",) * flights.n_cases)

    def start(self, c: EngineLoopConstants) -> EngineState:
        """At rest."""
        return EngineState(engine=0.0, disturbance=0.0, faults=self.faults.start(c.faults))

    def step(self, x: EngineState, c: EngineLoopConstants, n: EngineDraws, sample: Row) -> tuple[EngineState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        faults, f = self.faults.step(x.faults, c.faults, n.faults, np.zeros_like(x.engine), sample)
        begins = sample - self.hold_samples * np.floor(sample / self.hold_samples) == 0.0
        d = np.where(begins, c.sigma * n.disturbance, x.disturbance)
        time_s = sample * self.sample_s
        u = np.stack([interpolate(time_s, _of_input(c.knots_s, i), _of_input(c.u, i)) for i in range(plant.N)])
        engine, y = plant.engine(c.engine, self.sample_s).step(x.engine, np.concatenate([f, d, u]))
        after = EngineState(engine=engine, disturbance=d, faults=faults)
        truth = dict(zip(self.truth, [*f, *d], strict=True))
        departed = np.zeros_like(y[0]) > 1.0
        return after, Sample(measured=SimpleNamespace(y=y, u=u), truth=truth, departed=departed, added=f)


def _of_input(rows: Rows, i: int) -> Rows:
    """Breakpoints of one input, (KNOTS, n_cases)."""
    return rows[i * KNOTS : (i + 1) * KNOTS]
