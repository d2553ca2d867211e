"""One sample with six degrees of freedom: fly, sense, break, vote, order, actuate."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.breaking import Breaking, Broken
from fddbench.benchmarks.yaw_rate.transport.law import LawState, Orders, TransportLaw
from fddbench.benchmarks.yaw_rate.transport.plant import PlantConstants, TransportPlant, controls_of
from fddbench.benchmarks.yaw_rate.transport.seeing import (
    TRUTH,
    VOTED,
    Voted,
    departed,
    measured,
    sensed,
    signals,
    truth,
)
from fddbench.benchmarks.yaw_rate.transport.sensors import N_VOTED, TransportSensors
from fddbench.benchmarks.yaw_rate.transport.winds import in_six_components
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, record
from fddbench.flight.actuators import Actuators, ActuatorState
from fddbench.flight.atmosphere import FT_M
from fddbench.flight.transport.engines import spooled
from fddbench.flight.transport.travel import rates_deg_s, travel_deg
from fddbench.flight.wind import Encounter
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample
from fddbench.units import DEG_PER_RAD
from fddbench.voting.block import VoterBlock

__all__ = ["TransportLoop"]


@record
class LoopState:
    """States of the parts."""

    plant: Part
    actuators: ActuatorState
    thrust_ratio: Row
    law: LawState
    wind: Part
    voters: Voted
    faults: Broken


@record
class LoopConstants:
    """Constants of the parts that have any."""

    plant: PlantConstants
    wind: Part
    faults: Broken


@record
class LoopDraws:
    """Random numbers of the parts that draw any."""

    sensors: Part
    wind: Part
    faults: Broken


class TransportLoop:
    """Closed loop of the aircraft with six degrees of freedom, see `fddbench.interfaces.Loop`.

    The bus holds what the lateral model has there, under the same names, and besides incidence and load factor, three of
    each and the voted ones, pitch angle and rate, both elevators, the stabiliser and the share of the thrust. Airspeeds, mass,
    X_cg and altitude carry their measurement errors.
    """

    truth = TRUTH

    def __init__(self, plant: TransportPlant, options: Options) -> None:
        chosen = options.chosen
        self.plant, self.sample_s = plant, options.sample_s
        self.wind = in_six_components(chosen["wind"])
        self.breaking = Breaking(plant.sites, options.faults, options.sample_s)
        rates = self.breaking.n_sites("r_deg_s")
        self.sensors = TransportSensors(chosen["sensors"], rates)
        self.voters = {name: VoterBlock(chosen["voter"]()) for name in VOTED}
        self.law = TransportLaw(plant.aircraft, plant.gains, options.sample_s)
        actuators = plant.aircraft.actuators
        self.actuators = Actuators(
            bandwidth_rad_s=actuators.bandwidth_rad_s, rate_deg_s=rates_deg_s(actuators), sample_s=options.sample_s
        )
        voters = Voted(**{name: voter.states.shape for name, voter in self.voters.items()})
        self.states = Layout(
            LoopState(
                plant=plant.states.shape, actuators=self.actuators.states.shape, thrust_ratio=ROW, law=self.law.states.shape,
                wind=self.wind.states.shape, voters=voters, faults=self.breaking.states.shape,
            )
        )  # fmt: skip
        self.constants = Layout(
            LoopConstants(
                plant=plant.constants.shape, wind=self.wind.constants.shape, faults=self.breaking.constants.shape
            )
        )
        self.draws: Draws[LoopDraws] = Draws(
            LoopDraws(sensors=self.sensors.draws.names, wind=self.wind.draws.names, faults=self.breaking.draws.names)
        )
        self.before: Draws[Any] = self.wind.before
        self.bus = Bus(sample_s=options.sample_s, sites=plant.sites, signals=signals(rates, N_VOTED))

    def prepare(self, flights: Flights) -> Prepared:
        """Constants of the parts, and which flights the plant refuses."""
        plant = self.plant.prepare(flights.parameters, flights.manoeuvres)
        meets = Encounter(
            v_tas_m_s=plant.constants.v_tas_m_s,
            scale_ratio=flights.parameters["gust_scale_ratio"],
            altitude_m=flights.parameters["altitude_ft"] * FT_M,
            gradient_m=flights.parameters["gust_gradient_m"],
            span_m=self.plant.aircraft.geometry.span_m,
        )
        wind = self.wind.prepare(flights.normals, meets, self.sample_s)
        constants = LoopConstants(plant=plant.constants, wind=wind, faults=self.breaking.prepare(flights.faults))
        return Prepared(constants=constants, infeasible_reason=plant.infeasible_reason)

    def start(self, c: LoopConstants) -> LoopState:
        """In trim; turbulence is stationary."""
        law = c.plant.law
        zero = np.zeros_like(law.stabiliser_deg)
        return LoopState(
            plant=self.plant.start(c.plant),
            actuators=ActuatorState(position_deg=np.stack([*(zero,) * 15, law.stabiliser_deg])),
            thrust_ratio=law.thrust_ratio,
            law=self.law.start(law),
            wind=self.wind.start(c.wind),
            voters=Voted(**{name: voter.start(Nothing()) for name, voter in self.voters.items()}),
            faults=self.breaking.start(c.faults),
        )

    def step(self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row) -> tuple[LoopState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        positions = x.actuators.position_deg
        wind, air = self.wind.step(x.wind, c.wind, n.wind, sample, like=x.thrust_ratio)
        surfaces = {"surface_deg": positions[:13], "elevator_deg": positions[13:15], "stabiliser_deg": positions[15:]}
        breaking = self.breaking.begin(x.faults, c.faults, n.faults, sample)
        s = {name: breaking.broken(name, rows) for name, rows in surfaces.items()}
        controls = controls_of(s["surface_deg"], s["elevator_deg"], s["stabiliser_deg"][0])
        plant, motion = self.plant.step(x.plant, c.plant, Nothing(), controls, air, x.thrust_ratio)
        _, readings = self.sensors.step(Nothing(), Nothing(), n.sensors, motion)
        s |= {name: breaking.broken(name, getattr(readings, name)) for name in ("r_deg_s", "alpha_deg", "n_z_g")}
        kept, voted = self._voted(x.voters, Voted(r=s["r_deg_s"], alpha=s["alpha_deg"], n_z=s["n_z_g"]))
        seen = measured(c.plant, motion, readings, s, voted, x.thrust_ratio)
        law, orders = self.law.step(x.law, c.plant.law, Nothing(), sensed(seen, motion, c.plant), sample)
        after = LoopState(
            plant=plant, law=law, wind=wind, voters=kept, faults=breaking.after(), **self._actuated(x, orders, motion.v_cas_kt)
        )  # fmt: skip
        return after, self._sample(seen, motion, air.v_m_s, orders, breaking.added(), voted)

    def _voted(self, x: Voted, readings: Voted) -> tuple[Voted, Voted]:
        """States of the voters and what they say."""
        found = {
            name: voter.step(getattr(x, name), Nothing(), Nothing(), getattr(readings, name))
            for name, voter in self.voters.items()
        }
        after, values = ({name: pair[j] for name, pair in found.items()} for j in (0, 1))
        return Voted(**after), Voted(**values)

    def _actuated(self, x: LoopState, orders: Orders, v_cas_kt: Row) -> dict[str, Any]:
        """Surfaces and engines at the next sample."""
        aircraft = self.plant.aircraft
        low, high = travel_deg(aircraft.actuators, v_cas_kt)
        actuators, _ = self.actuators.step(x.actuators, Nothing(), Nothing(), orders.surface_deg, low, high)
        thrust = spooled(aircraft.thrust, x.thrust_ratio, orders.thrust_ratio, self.sample_s)
        return {"actuators": actuators, "thrust_ratio": thrust}

    def _sample(
        self, seen: SimpleNamespace, motion: Any, gust_m_s: Row, orders: Orders, added: Any, voted: Voted
    ) -> Sample:
        """What there is to see."""
        errors = {
            "r_voted_deg_s": voted.r - DEG_PER_RAD * motion.r_rad_s,
            "alpha_voted_deg": voted.alpha - DEG_PER_RAD * motion.alpha_rad,
            "n_z_voted_g": voted.n_z - motion.n_z_g,
        }
        return Sample(
            measured=seen,
            truth=truth(motion, gust_m_s, orders.guidance),
            departed=departed(self.plant.aircraft, motion),
            added=added,
            voted=errors,
        )
