"""One sample with six degrees of freedom: fly, sense, break, vote, order, actuate."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.breaking import Breaking, Broken
from fddbench.benchmarks.yaw_rate.consequences import CONSEQUENCES
from fddbench.benchmarks.yaw_rate.transport.law import LawState, Orders, TransportLaw
from fddbench.benchmarks.yaw_rate.transport.plant import PlantConstants, TransportPlant, controls_of
from fddbench.benchmarks.yaw_rate.transport.seeing import TRUTH, departed, measured, sensed, signals, truth
from fddbench.benchmarks.yaw_rate.transport.sensors import N_VOTED, TransportSensors
from fddbench.benchmarks.yaw_rate.transport.winds import in_six_components
from fddbench.benchmarks.yaw_rate.unit_sites import P_UNITS, PHI_UNITS
from fddbench.benchmarks.yaw_rate.voters import Voted, Voters
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.flight.actuators import Actuators, ActuatorState
from fddbench.flight.atmosphere import FT_M
from fddbench.flight.transport.engines import spooled
from fddbench.flight.transport.travel import rates_deg_s, travel_deg
from fddbench.flight.wind import Encounter, rotating
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample
from fddbench.units import DEG_PER_RAD

__all__ = ["TransportLoop"]

_SURFACES = ("surface_deg", "elevator_deg", "stabiliser_deg")


@record
class LoopState:
    """States of the parts."""

    plant: Part
    actuators: ActuatorState
    thrust_ratio: Row
    law: LawState
    wind: Part
    sensors: Part
    voters: Voted
    faults: Broken


@record
class LoopConstants:
    """Constants of the parts that have any, and the share of the rotations of the air that the aircraft feels."""

    plant: PlantConstants
    wind: Part
    sensors: Part
    faults: Broken
    gust_rotation_ratio: Row


@record
class LoopDraws:
    """Random numbers of the parts that draw any."""

    sensors: Part
    wind: Part
    faults: Broken


@record
class LoopNormals:
    """Random numbers of the parts that draw any before the first sample."""

    wind: Part
    sensors: Part


class TransportLoop:
    """Closed loop of the aircraft with six degrees of freedom, see `fddbench.interfaces.Loop`.

    The bus holds what the lateral model has there, under the same names, and besides incidence and load factor, three of
    each and the voted ones, pitch angle and rate, both elevators, the stabiliser and the share of the thrust. Airspeeds, mass,
    X_cg and altitude carry their measurement errors. Sensors that are declared leave their vote.
    """

    reconfigures = True
    truth = TRUTH
    consequences = CONSEQUENCES

    def __init__(self, plant: TransportPlant, options: Options) -> None:
        chosen = options.chosen
        self.plant, self.sample_s = plant, options.sample_s
        self.wind = in_six_components(chosen["wind"])
        may_break = ("r_deg_s", "alpha_deg", "n_z_g", *_SURFACES, P_UNITS, PHI_UNITS)
        self.breaking = Breaking(plant.sites, may_break, options.faults, options.sample_s)
        rates = self.breaking.n_sites("r_deg_s")
        self.sensors = TransportSensors(chosen["sensors"], rates, options.sample_s)
        of_units = (P_UNITS, PHI_UNITS) if self.sensors.n_units else ()
        voted = {"r_deg_s": rates, "alpha_deg": N_VOTED, "n_z_g": N_VOTED, **dict.fromkeys(of_units, rates)}
        self.voters = Voters(chosen["voter"], voted, plant.sites, options.sample_s)
        self.law = TransportLaw(plant.aircraft, plant.gains, options.sample_s)
        actuators = plant.aircraft.actuators
        self.actuators = Actuators(
            bandwidth_rad_s=actuators.bandwidth_rad_s, rate_deg_s=rates_deg_s(actuators), sample_s=options.sample_s
        )
        self.states = Layout(
            LoopState(
                plant=plant.states.shape, actuators=self.actuators.states.shape, thrust_ratio=ROW, law=self.law.states.shape,
                wind=self.wind.states.shape, sensors=self.sensors.states.shape, voters=self.voters.states.shape,
                faults=self.breaking.states.shape,
            )
        )  # fmt: skip
        self.constants = Layout(
            LoopConstants(
                plant=plant.constants.shape, wind=self.wind.constants.shape, sensors=self.sensors.constants.shape,
                faults=self.breaking.constants.shape,
                gust_rotation_ratio=ROW,
            )
        )  # fmt: skip
        self.draws: Draws[LoopDraws] = Draws(
            LoopDraws(sensors=self.sensors.draws.names, wind=self.wind.draws.names, faults=self.breaking.draws.names)
        )
        self.before: Draws[LoopNormals] = Draws(
            LoopNormals(wind=self.wind.before.names, sensors=self.sensors.before.names)
        )
        seen = {**signals(rates, N_VOTED), **dict.fromkeys(of_units, self.sensors.n_units)}
        self.bus = Bus(sample_s=options.sample_s, sites=plant.sites, signals=seen)

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
        constants = LoopConstants(
            plant=plant.constants,
            wind=self.wind.prepare(flights.normals.wind, meets, self.sample_s),
            sensors=self.sensors.prepare(flights.normals.sensors),
            faults=self.breaking.prepare(flights.faults),
            gust_rotation_ratio=flights.parameters["gust_rotation_ratio"],
        )
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
            sensors=self.sensors.start(c.sensors),
            voters=self.voters.start(),
            faults=self.breaking.start(c.faults),
        )

    def step(
        self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row, declared: Rows = None
    ) -> tuple[LoopState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        positions = x.actuators.position_deg
        wind, air = self.wind.step(x.wind, c.wind, n.wind, sample, like=x.thrust_ratio)
        air = rotating(air, c.gust_rotation_ratio)
        surfaces = {"surface_deg": positions[:13], "elevator_deg": positions[13:15], "stabiliser_deg": positions[15:]}
        breaking = self.breaking.begin(x.faults, c.faults, n.faults, sample)
        s = {name: breaking.broken(name, rows) for name, rows in surfaces.items()}
        controls = controls_of(s["surface_deg"], s["elevator_deg"], s["stabiliser_deg"][0])
        plant, motion = self.plant.step(x.plant, c.plant, Nothing(), controls, air, x.thrust_ratio)
        sensors, readings = self.sensors.step(x.sensors, c.sensors, n.sensors, sample, motion)
        healthy = {
            "r_deg_s": readings.r_deg_s, "alpha_deg": readings.alpha_deg, "n_z_g": readings.n_z_g,
            P_UNITS: readings.p_deg_s, PHI_UNITS: readings.phi_deg,
        }  # fmt: skip
        s |= {name: breaking.broken(name, healthy[name]) for name in self.voters.parts}
        kept, voted = self.voters.step(x.voters, s, declared)
        seen = measured(c.plant, motion, readings, s, voted, x.thrust_ratio)
        law, orders = self.law.step(x.law, c.plant.law, Nothing(), sensed(seen, motion, c.plant), sample)
        after = LoopState(
            plant=plant, law=law, wind=wind, sensors=sensors, voters=kept, faults=breaking.after(),
            **self._actuated(x, orders, motion.v_cas_kt),
        )  # fmt: skip
        return after, self._sample(seen, motion, air.v_m_s, orders, breaking.added(), voted)

    def _actuated(self, x: LoopState, orders: Orders, v_cas_kt: Row) -> dict[str, Any]:
        """Surfaces and engines at the next sample."""
        aircraft = self.plant.aircraft
        low, high = travel_deg(aircraft.actuators, v_cas_kt)
        actuators, _ = self.actuators.step(x.actuators, Nothing(), Nothing(), orders.surface_deg, low, high)
        thrust = spooled(aircraft.thrust, x.thrust_ratio, orders.thrust_ratio, self.sample_s)
        return {"actuators": actuators, "thrust_ratio": thrust}

    def _sample(
        self, seen: SimpleNamespace, motion: Any, gust_m_s: Row, orders: Orders, added: Any, voted: Mapping[str, Row]
    ) -> Sample:
        """What there is to see."""
        errors = {
            "r_voted_deg_s": voted["r_deg_s"] - DEG_PER_RAD * motion.r_rad_s,
            "alpha_voted_deg": voted["alpha_deg"] - DEG_PER_RAD * motion.alpha_rad,
            "n_z_voted_g": voted["n_z_g"] - motion.n_z_g,
        }
        return Sample(
            measured=seen,
            truth=truth(motion, gust_m_s, orders.guidance),
            departed=departed(self.plant.aircraft, motion),
            added=added,
            voted=errors,
        )
