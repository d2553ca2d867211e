"""One sample of the closed loop: gust, actuators, break, fly, sense, order."""

from typing import Any

import numpy as np

from fddbench.benchmarks.b747_longitudinal.actuators import Actuators, ActuatorState
from fddbench.benchmarks.b747_longitudinal.law import Law, Orders
from fddbench.benchmarks.b747_longitudinal.manoeuvres import KNOTS, Command, Commands, commanded, commands
from fddbench.benchmarks.b747_longitudinal.plant import LongitudinalPlant, Motion
from fddbench.benchmarks.b747_longitudinal.sensors import SIGNALS, Noise, SensorErrors, Sensors
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.faults.injection import SignalFaults, SignalFaultsState
from fddbench.flight.b747.airframe import DATA
from fddbench.flight.wind import AirMotion, Encounter, Wind
from fddbench.interfaces import Bus, Consequence, Flights, Options, Prepared, Sample, Site

__all__ = ["LongitudinalLoop"]

_SPAN_M = DATA["geometry"]["span_m"]


@record
class LoopState:
    """States of the parts."""

    plant: Part
    actuators: ActuatorState
    law: Part
    wind: Part
    elevator_faults: SignalFaultsState
    thrust_faults: SignalFaultsState


@record
class LoopConstants:
    """Constants of the parts; how thrust falls with airspeed, and where a loose elevator floats."""

    plant: Part
    law: Part
    wind: Part
    sensors: SensorErrors
    commands: Commands
    elevator_faults: Part
    thrust_faults: Part
    thrust_lapse_ratio: Row
    float_ratio: Row


@record
class LoopDraws:
    """Random numbers of the parts that draw any."""

    plant: Part
    law: Part
    wind: Part
    sensors: Part
    elevator_faults: Part
    thrust_faults: Part


class LongitudinalLoop:
    """Closed loop of the longitudinal benchmark, see `fddbench.interfaces.Loop`.

    The measured bus holds what the filters of the paper need and what the laws need: states, acceleration along the path, and
    outputs of the actuators *before* their faults. Thrust is what the engines would give at this airspeed.

    Parameters
    ----------
    plant : LongitudinalPlant
        What flies.
    sites : tuple of Site
        Fault sites on ``elevator_deg`` and ``thrust_n``.
    law, noise, wind : Law, Noise, Wind
        What was chosen.
    options : Options
        Clock and faults.
    """

    truth = (
        "alpha_true_deg",
        "q_true_deg_s",
        "v_tas_true_m_s",
        "theta_true_deg",
        "altitude_true_m",
        "gamma_true_deg",
        "gamma_command_deg",
        "v_command_m_s",
        "elevator_true_deg",
        "thrust_true_n",
        "u_gust_m_s",
        "w_gust_m_s",
    )
    consequences = (
        Consequence(name="speed_error_m_s", signal="v_tas_true_m_s", how="error", about="true airspeed"),
        Consequence(name="flight_path_error_deg", signal="gamma_true_deg", how="error", about="flight path angle"),
        Consequence(name="altitude_error_m", signal="altitude_true_m", how="error", about="altitude"),
    )

    def __init__(
        self, plant: LongitudinalPlant, sites: tuple[Site, ...], law: Law, noise: Noise, wind: Wind, options: Options
    ) -> None:
        self.plant, self.law, self.wind, self.sample_s = plant, law, wind, options.sample_s
        self.reconfigures: bool = getattr(law, "reconfigures", True)  # what is in trim all the time hands nothing over
        self.elevator_faults = SignalFaults(sites, "elevator_deg", options.faults, options.sample_s)
        self.thrust_faults = SignalFaults(sites, "thrust_n", options.faults, options.sample_s)
        self.sensors, self.actuators = Sensors(noise), Actuators(options.sample_s)
        self.states = Layout(
            LoopState(
                plant=plant.states.shape,
                actuators=self.actuators.states.shape,
                law=law.states.shape,
                wind=wind.states.shape,
                elevator_faults=self.elevator_faults.states.shape,
                thrust_faults=self.thrust_faults.states.shape,
            )
        )
        self.constants = Layout(
            LoopConstants(
                plant=plant.constants.shape,
                law=law.constants.shape,
                wind=wind.constants.shape,
                sensors=self.sensors.constants.shape,
                commands=Commands(
                    gamma_s=KNOTS, gamma_deg=KNOTS, speed_s=KNOTS, speed_m_s=KNOTS, elevator_s=KNOTS, elevator_deg=KNOTS
                ),
                elevator_faults=self.elevator_faults.constants.shape,
                thrust_faults=self.thrust_faults.constants.shape,
                thrust_lapse_ratio=ROW,
                float_ratio=ROW,
            )
        )
        self.draws: Draws[LoopDraws] = Draws(
            LoopDraws(
                plant=plant.draws.names,
                law=law.draws.names,
                wind=wind.draws.names,
                sensors=self.sensors.draws.names,
                elevator_faults=self.elevator_faults.draws.names,
                thrust_faults=self.thrust_faults.draws.names,
            )
        )
        self.before: Draws[Any] = wind.before
        self.bus = Bus(sample_s=options.sample_s, sites=sites, signals=dict.fromkeys(SIGNALS, 0))

    def prepare(self, flights: Flights) -> Prepared:
        """Constants of the parts, and which flights the plant refuses."""
        own = flights.parameters
        plant = self.plant.prepare(own, flights.manoeuvres)
        at = plant.constants.trim
        meets = Encounter(
            v_tas_m_s=at.v_tas_m_s, scale_ratio=own["gust_scale_ratio"], altitude_m=at.altitude_m, span_m=_SPAN_M
        )
        constants = LoopConstants(
            plant=plant.constants,
            law=self.law.prepare(at),
            wind=self.wind.prepare(flights.normals, meets, self.sample_s),
            sensors=self.sensors.prepare(own),
            commands=commands(flights.manoeuvres),
            elevator_faults=self.elevator_faults.prepare(flights.faults),
            thrust_faults=self.thrust_faults.prepare(flights.faults),
            thrust_lapse_ratio=own["thrust_lapse_ratio"],
            float_ratio=own["float_ratio"],
        )
        return Prepared(constants=constants, infeasible_reason=plant.infeasible_reason)

    def start(self, c: LoopConstants) -> LoopState:
        """In trim; the gust is stationary."""
        return LoopState(
            plant=self.plant.start(c.plant),
            actuators=self.actuators.start(c.plant.trim),
            law=self.law.start(c.law),
            wind=self.wind.start(c.wind),
            elevator_faults=self.elevator_faults.start(c.elevator_faults),
            thrust_faults=self.thrust_faults.start(c.thrust_faults),
        )

    def step(
        self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row, declared: Rows = None
    ) -> tuple[LoopState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        command = commanded(c.commands, sample * self.sample_s)
        wind, air = self.wind.step(x.wind, c.wind, n.wind, sample, like=x.actuators.position[0])
        motion = self.plant.motion(x.plant, c.plant, air)
        elevator_deg, stabiliser_deg, lever_n = x.actuators.position
        thrust_n = lever_n * _lapse(c, motion)
        elevator_faults, thrust_faults, elevator_true_deg, thrust_true_n = self._broken(
            x, c, n, elevator_deg, thrust_n, motion, sample
        )
        plant, acceleration_m_s2 = self.plant.step(
            x.plant, c.plant, n.plant, np.stack([elevator_true_deg, stabiliser_deg, thrust_true_n]), air
        )
        true = (
            motion.alpha_deg,
            motion.q_deg_s,
            motion.v_tas_m_s,
            motion.theta_deg,
            motion.altitude_m,
            motion.gamma_deg,
            acceleration_m_s2,
        )
        _, seen = self.sensors.step(
            Nothing(), c.sensors, n.sensors,
            dict(zip(SIGNALS, (*true, elevator_deg, stabiliser_deg, thrust_n), strict=True)),
        )  # fmt: skip
        law, orders = self.law.step(x.law, c.law, n.law, seen, command, self._elevator_declared(elevator_deg, declared))
        actuators, _ = self.actuators.step(x.actuators, c.plant.trim, Nothing(), _ordered(orders, command))
        after = LoopState(
            plant=plant,
            actuators=actuators,
            law=law,
            wind=wind,
            elevator_faults=elevator_faults,
            thrust_faults=thrust_faults,
        )
        return after, Sample(
            measured=seen,
            truth=self._truth(motion, c, command, elevator_true_deg, thrust_true_n, air),
            departed=motion.departed,
            added=self._added(elevator_true_deg - elevator_deg, thrust_true_n - thrust_n),
        )

    def _broken(
        self,
        x: LoopState,
        c: LoopConstants,
        n: LoopDraws,
        elevator_deg: Row,
        thrust_n: Row,
        motion: Motion,
        sample: Row,
    ) -> tuple[SignalFaultsState, SignalFaultsState, Row, Row]:
        """States of the faults, and elevator [deg] and thrust [N] as the air feels them; those without a site pass."""
        free = (c.float_ratio * motion.alpha_deg)[np.newaxis]
        elevator_faults, elevator = x.elevator_faults, elevator_deg[np.newaxis]
        if self.elevator_faults.rows:
            elevator_faults, elevator = self.elevator_faults.step(
                elevator_faults, c.elevator_faults, n.elevator_faults, elevator, sample, free=free
            )
        thrust_faults, thrust = x.thrust_faults, thrust_n[np.newaxis]
        if self.thrust_faults.rows:
            thrust_faults, thrust = self.thrust_faults.step(
                thrust_faults, c.thrust_faults, n.thrust_faults, thrust, sample
            )
        return elevator_faults, thrust_faults, elevator[0], thrust[0]

    def _elevator_declared(self, like: Row, declared: Rows) -> Row:
        """1 where the elevator is declared, (n_cases,)."""
        found = [j for j, site in enumerate(self.bus.sites) if site.signal == "elevator_deg"]
        return np.zeros_like(like) if declared is None or not found else declared[found[0]]

    def _added(self, elevator_deg: Row, thrust_n: Row) -> Rows:
        """What faults add on every site, (n_sites, n_cases)."""
        by_signal = {"elevator_deg": elevator_deg, "thrust_n": thrust_n}
        return np.stack([by_signal[site.signal] for site in self.bus.sites])

    def _truth(
        self, motion: Motion, c: LoopConstants, command: Command, elevator_deg: Row, thrust_n: Row, air: AirMotion
    ) -> dict[str, Rows]:
        values = (
            *(
                motion.alpha_deg,
                motion.q_deg_s,
                motion.v_tas_m_s,
                motion.theta_deg,
                motion.altitude_m,
                motion.gamma_deg,
            ),
            *(command.gamma_deg, c.plant.trim.v_tas_m_s + command.speed_m_s),
            *(elevator_deg, thrust_n, air.u_m_s, air.w_m_s),
        )
        return dict(zip(self.truth, values, strict=True))


def _lapse(c: LoopConstants, motion: Motion) -> Row:
    """Share of the lever's thrust that is left at this airspeed [-]."""
    rise = motion.v_tas_m_s / c.plant.trim.v_tas_m_s - 1.0
    return np.maximum(1.0 - c.thrust_lapse_ratio * rise, 0.0)


def _ordered(orders: Orders, command: Command) -> Rows:
    """Orders to the actuators, (3, n_cases), with what the manoeuvre adds to the elevator."""
    return np.stack([orders.elevator_deg + command.elevator_deg, orders.stabiliser_deg, orders.thrust_n])
