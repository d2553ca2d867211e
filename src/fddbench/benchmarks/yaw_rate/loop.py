"""One sample of the closed loop: fly, sense, break, vote, order, actuate."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.control_law import LateralLaw, LawState
from fddbench.benchmarks.yaw_rate.plant import LateralPlant, Motion
from fddbench.benchmarks.yaw_rate.sensors import Noise, Readings, Sensors
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.faults.injection import SignalFaults, SignalFaultsState
from fddbench.flight.actuators import ActuatorState
from fddbench.flight.atmosphere import FT_M
from fddbench.flight.wind import Encounter, Wind
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample, Site, Voter
from fddbench.voting.block import VoterBlock

__all__ = ["LateralLoop"]

N_SURFACES = 13


@record
class LoopState:
    """States of the parts."""

    plant: Part
    actuators: ActuatorState
    law: LawState
    gust: Part
    voter: Part
    rate_faults: SignalFaultsState
    surface_faults: SignalFaultsState


@record
class LoopConstants:
    """Constants of the parts that have any."""

    plant: Part
    gust: Part
    rate_faults: Part
    surface_faults: Part


@record
class LoopDraws:
    """Random numbers of the parts that draw any."""

    sensors: Part
    plant: Part
    gust: Part
    rate_faults: Part
    surface_faults: Part


class LateralLoop:
    """Closed loop of the yaw-rate benchmark, see `fddbench.interfaces.Loop`.

    The measured bus holds what a flight computer has: bank and sideslip angle, roll rate, the redundant yaw rates and the
    voted one, surface positions, airspeeds, mass, X_cg and altitude, all with their measurement errors.

    Parameters
    ----------
    plant : LateralPlant
        What flies.
    sites : tuple of Site
        Fault sites: one sensor a row of ``r_deg_s``, and any surfaces, rows of ``surface_deg``.
    voter, noise, gust : Voter, Noise, Wind
        What was chosen.
    options : Options
        Clock and faults.
    """

    truth = (
        "phi_true_deg",
        "beta_true_deg",
        "p_true_deg_s",
        "r_true_deg_s",
        "psi_deg",
        "y_m",
        "gust_m_s",
        "bank_command_deg",
    )

    def __init__(
        self, plant: LateralPlant, sites: tuple[Site, ...], voter: Voter, noise: Noise, gust: Wind, options: Options
    ) -> None:
        self.plant, self.voter, self.gust, self.sample_s = plant, VoterBlock(voter), gust, options.sample_s
        self.rate_faults = SignalFaults(sites, "r_deg_s", options.faults, options.sample_s)
        self.surface_faults = SignalFaults(sites, "surface_deg", options.faults, options.sample_s)
        self.sensors = Sensors(noise, len(self.rate_faults.sites))
        self.law, self.actuators = LateralLaw(options.sample_s), plant.actuators()
        self.states = Layout(
            LoopState(
                plant=plant.states.shape,
                actuators=self.actuators.states.shape,
                law=self.law.states.shape,
                gust=gust.states.shape,
                voter=self.voter.states.shape,
                rate_faults=self.rate_faults.states.shape,
                surface_faults=self.surface_faults.states.shape,
            )
        )
        self.constants = Layout(
            LoopConstants(
                plant=plant.constants.shape,
                gust=gust.constants.shape,
                rate_faults=self.rate_faults.constants.shape,
                surface_faults=self.surface_faults.constants.shape,
            )
        )
        self.draws: Draws[LoopDraws] = Draws(
            LoopDraws(
                sensors=self.sensors.draws.names,
                plant=plant.draws.names,
                gust=gust.draws.names,
                rate_faults=self.rate_faults.draws.names,
                surface_faults=self.surface_faults.draws.names,
            )
        )
        self.before: Draws[Any] = gust.before
        single = ("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "v_tas_m_s")
        known = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
        rows = {"r_deg_s": self.sensors.n_rates, "surface_deg": N_SURFACES}
        signals = dict.fromkeys(single, 0) | rows | dict.fromkeys(known, 0)
        self.bus = Bus(sample_s=options.sample_s, sites=sites, signals=signals)

    def prepare(self, flights: Flights) -> Prepared:
        """Constants of the parts, and which flights the plant refuses."""
        plant = self.plant.prepare(flights.parameters, flights.manoeuvres)
        meets = Encounter(
            v_tas_m_s=plant.constants.v_tas_m_s,
            scale_ratio=flights.parameters["gust_scale_ratio"],
            altitude_m=flights.parameters["altitude_ft"] * FT_M,
        )
        gust = self.gust.prepare(flights.normals, meets, self.sample_s)
        constants = LoopConstants(
            plant=plant.constants,
            gust=gust,
            rate_faults=self.rate_faults.prepare(flights.faults),
            surface_faults=self.surface_faults.prepare(flights.faults),
        )
        return Prepared(constants=constants, infeasible_reason=plant.infeasible_reason)

    def start(self, c: LoopConstants) -> LoopState:
        """In trim; the gust is stationary."""
        return LoopState(
            plant=self.plant.start(c.plant),
            actuators=self.actuators.start(Nothing()),
            law=self.law.start(Nothing()),
            gust=self.gust.start(c.gust),
            voter=self.voter.start(Nothing()),
            rate_faults=self.rate_faults.start(c.rate_faults),
            surface_faults=self.surface_faults.start(c.surface_faults),
        )

    def step(self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row) -> tuple[LoopState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        gust, air = self.gust.step(x.gust, c.gust, n.gust, sample, like=x.actuators.position_deg[0])
        gust_m_s = air.v_m_s
        surface_faults, surface_deg = self._surfaces(x, c, n, sample)
        plant, motion = self.plant.step(x.plant, c.plant, n.plant, surface_deg, gust_m_s, sample)
        _, readings = self.sensors.step(
            Nothing(), Nothing(), n.sensors,
            r_deg_s=motion.r_deg_s, beta_deg=motion.beta_deg, p_deg_s=motion.p_deg_s, phi_deg=motion.phi_deg,
        )  # fmt: skip
        rate_faults, r_deg_s = self.rate_faults.step(
            x.rate_faults, c.rate_faults, n.rate_faults, readings.r_deg_s, sample
        )
        voter, voted_deg_s = self.voter.step(x.voter, Nothing(), Nothing(), r_deg_s)
        measured = _measured(motion, readings, r_deg_s, voted_deg_s, surface_deg)
        law, orders_deg = self.law.step(x.law, Nothing(), Nothing(), measured, motion.bank_command_deg)
        actuators, _ = self.actuators.step(x.actuators, Nothing(), Nothing(), orders_deg, *self.plant.travel(c.plant))
        after = LoopState(
            plant=plant,
            actuators=actuators,
            law=law,
            gust=gust,
            voter=voter,
            rate_faults=rate_faults,
            surface_faults=surface_faults,
        )
        seen = Sample(
            measured=measured,
            truth=self._truth(motion, gust_m_s),
            departed=motion.departed,
            added=self._added(r_deg_s - readings.r_deg_s, surface_deg - x.actuators.position_deg),
            voted={"r_voted_deg_s": voted_deg_s - motion.r_deg_s},
        )
        return after, seen

    def _added(self, rates_deg_s: Rows, surfaces_deg: Rows) -> Rows:
        """What faults add on every site, (n_sites, n_cases), of what they add to the sensors and to all surfaces."""
        by_signal = {"r_deg_s": rates_deg_s, "surface_deg": surfaces_deg}
        return np.stack([by_signal[site.signal][site.row] for site in self.bus.sites])

    def _surfaces(self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row) -> tuple[SignalFaultsState, Rows]:
        """Positions of the surfaces with their faults [deg]; those without a site pass."""
        position_deg, rows = x.actuators.position_deg, self.surface_faults.rows
        if not rows:
            return x.surface_faults, position_deg
        healthy = np.stack([position_deg[row] for row in rows])
        after, broken = self.surface_faults.step(x.surface_faults, c.surface_faults, n.surface_faults, healthy, sample)
        shown = list(position_deg)
        for row, value in zip(rows, broken, strict=True):
            shown[row] = value
        return after, np.stack(shown)

    def _truth(self, motion: Motion, gust_m_s: Row) -> dict[str, Rows]:
        values = (motion.phi_deg, motion.beta_deg, motion.p_deg_s, motion.r_deg_s, motion.psi_deg, motion.y_m)
        return dict(zip(self.truth, (*values, gust_m_s, motion.bank_command_deg), strict=True))


def _measured(motion: Motion, readings: Readings, r_deg_s: Rows, voted: Row, surface_deg: Rows) -> SimpleNamespace:
    """The bus at this sample."""
    return SimpleNamespace(
        phi_deg=readings.phi_deg,
        beta_deg=readings.beta_deg,
        p_deg_s=readings.p_deg_s,
        r_deg_s=r_deg_s,
        r_voted_deg_s=voted,
        surface_deg=surface_deg,
        v_tas_m_s=motion.v_tas_measured_m_s,
        mass_kg=motion.mass_measured_kg,
        x_cg_ratio=motion.x_cg_measured_ratio,
        altitude_ft=motion.altitude_measured_ft,
        v_cas_kt=motion.v_cas_measured_kt,
    )
