"""One sample of the closed loop: fly, sense, break, vote, order, actuate."""

from collections.abc import Mapping
from types import SimpleNamespace

from fddbench.benchmarks.yaw_rate.breaking import Breaking, Broken
from fddbench.benchmarks.yaw_rate.consequences import LATERAL_CONSEQUENCES
from fddbench.benchmarks.yaw_rate.control_law import LateralLaw, LawState
from fddbench.benchmarks.yaw_rate.plant import LateralPlant, Motion
from fddbench.benchmarks.yaw_rate.sensors import Noise, Readings
from fddbench.benchmarks.yaw_rate.unit_sensors import sensors_of
from fddbench.benchmarks.yaw_rate.unit_sites import P_UNITS, PHI_UNITS
from fddbench.benchmarks.yaw_rate.voters import Voted, Voters
from fddbench.blocks.block import Part
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.flight.actuators import ActuatorState
from fddbench.flight.atmosphere import FT_M
from fddbench.flight.wind import Encounter, Wind
from fddbench.interfaces import Bus, Flights, Options, Prepared, Sample, Site, Voter

__all__ = ["LateralLoop"]

N_SURFACES = 13


@record
class LoopState:
    """States of the parts."""

    plant: Part
    actuators: ActuatorState
    law: LawState
    gust: Part
    sensors: Part
    voters: Voted
    faults: Broken


@record
class LoopConstants:
    """Constants of the parts that have any, and the error of the measured sideslip."""

    plant: Part
    gust: Part
    sensors: Part
    faults: Broken
    beta_error_deg: Row


@record
class LoopDraws:
    """Random numbers of the parts that draw any."""

    sensors: Part
    plant: Part
    gust: Part
    faults: Broken


@record
class LoopNormals:
    """Random numbers of the parts that draw any before the first sample."""

    gust: Part
    sensors: Part


class LateralLoop:
    """Closed loop of the yaw-rate benchmark, see `fddbench.interfaces.Loop`.

    The measured bus holds what a flight computer has: bank and sideslip angle, roll rate, the redundant yaw rates and the
    voted one, surface positions, airspeeds, mass, X_cg and altitude, all with their measurement errors. Of inertial units bank
    angle and roll rate are voted, and those of the units are on the bus too. Sensors that are declared leave their vote.

    Parameters
    ----------
    plant : LateralPlant
        What flies.
    sites : tuple of Site
        Fault sites: one sensor a row of ``r_deg_s``, what inertial units have besides, any surfaces, rows of ``surface_deg``.
    voter, noise, gust : class of a Voter, Noise, Wind
        What was chosen.
    options : Options
        Clock and faults.
    """

    reconfigures = True
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
    consequences = LATERAL_CONSEQUENCES

    def __init__(
        self,
        plant: LateralPlant,
        sites: tuple[Site, ...],
        voter: type[Voter],
        noise: Noise,
        gust: Wind,
        options: Options,
    ) -> None:
        self.plant, self.gust, self.sample_s = plant, gust, options.sample_s
        self.breaking = Breaking(
            sites, ("r_deg_s", P_UNITS, PHI_UNITS, "surface_deg"), options.faults, options.sample_s
        )
        self.sensors = sensors_of(noise, self.breaking.n_sites("r_deg_s"), options.sample_s)
        self.of_units = (P_UNITS, PHI_UNITS) if self.sensors.n_units else ()
        voted = dict.fromkeys(("r_deg_s", *self.of_units), self.sensors.n_rates)
        self.voters = Voters(voter, voted, sites, options.sample_s)
        self.law, self.actuators = LateralLaw(options.sample_s), plant.actuators()
        self.states = Layout(
            LoopState(
                plant=plant.states.shape,
                actuators=self.actuators.states.shape,
                law=self.law.states.shape,
                gust=gust.states.shape,
                sensors=self.sensors.states.shape,
                voters=self.voters.states.shape,
                faults=self.breaking.states.shape,
            )
        )
        self.constants = Layout(
            LoopConstants(
                plant=plant.constants.shape,
                gust=gust.constants.shape,
                sensors=self.sensors.constants.shape,
                faults=self.breaking.constants.shape,
                beta_error_deg=ROW,
            )
        )
        self.draws: Draws[LoopDraws] = Draws(
            LoopDraws(
                sensors=self.sensors.draws.names,
                plant=plant.draws.names,
                gust=gust.draws.names,
                faults=self.breaking.draws.names,
            )
        )
        self.before: Draws[LoopNormals] = Draws(LoopNormals(gust=gust.before.names, sensors=self.sensors.before.names))
        single = ("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "v_tas_m_s")
        known = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
        rows = {"r_deg_s": self.sensors.n_rates, "surface_deg": N_SURFACES}
        rows |= dict.fromkeys(self.of_units, self.sensors.n_units)
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
        gust = self.gust.prepare(flights.normals.gust, meets, self.sample_s)
        constants = LoopConstants(
            plant=plant.constants,
            gust=gust,
            sensors=self.sensors.prepare(flights.normals.sensors),
            faults=self.breaking.prepare(flights.faults),
            beta_error_deg=flights.parameters["beta_error_deg"],
        )
        return Prepared(constants=constants, infeasible_reason=plant.infeasible_reason)

    def start(self, c: LoopConstants) -> LoopState:
        """In trim; the gust is stationary."""
        return LoopState(
            plant=self.plant.start(c.plant),
            actuators=self.actuators.start(Nothing()),
            law=self.law.start(Nothing()),
            gust=self.gust.start(c.gust),
            sensors=self.sensors.start(c.sensors),
            voters=self.voters.start(),
            faults=self.breaking.start(c.faults),
        )

    def step(
        self, x: LoopState, c: LoopConstants, n: LoopDraws, sample: Row, declared: Rows = None
    ) -> tuple[LoopState, Sample]:
        """One sample, see `fddbench.interfaces.Loop.step`."""
        gust, air = self.gust.step(x.gust, c.gust, n.gust, sample, like=x.actuators.position_deg[0])
        breaking = self.breaking.begin(x.faults, c.faults, n.faults, sample)
        surface_deg = breaking.broken("surface_deg", x.actuators.position_deg)
        plant, motion = self.plant.step(x.plant, c.plant, n.plant, surface_deg, air, sample)
        sensors, readings = self.sensors.step(
            x.sensors, c.sensors, n.sensors, sample,
            r_deg_s=motion.r_deg_s, beta_deg=motion.beta_deg, p_deg_s=motion.p_deg_s, phi_deg=motion.phi_deg,
        )  # fmt: skip
        healthy = {"r_deg_s": readings.r_deg_s, P_UNITS: readings.p_deg_s, PHI_UNITS: readings.phi_deg}
        units = {name: breaking.broken(name, healthy[name]) for name in ("r_deg_s", *self.of_units)}
        voters, voted = self.voters.step(x.voters, units, declared)
        measured = _measured(motion, c, readings, units, voted, surface_deg)
        law, orders_deg = self.law.step(x.law, Nothing(), Nothing(), measured, motion.bank_command_deg)
        actuators, _ = self.actuators.step(x.actuators, Nothing(), Nothing(), orders_deg, *self.plant.travel(c.plant))
        after = LoopState(
            plant=plant,
            actuators=actuators,
            law=law,
            gust=gust,
            sensors=sensors,
            voters=voters,
            faults=breaking.after(),
        )
        seen = Sample(
            measured=measured,
            truth=self._truth(motion, air.v_m_s),
            departed=motion.departed,
            added=breaking.added(),
            voted={"r_voted_deg_s": voted["r_deg_s"] - motion.r_deg_s},
        )
        return after, seen

    def _truth(self, motion: Motion, gust_m_s: Row) -> dict[str, Rows]:
        values = (motion.phi_deg, motion.beta_deg, motion.p_deg_s, motion.r_deg_s, motion.psi_deg, motion.y_m)
        return dict(zip(self.truth, (*values, gust_m_s, motion.bank_command_deg), strict=True))


def _measured(
    motion: Motion,
    c: LoopConstants,
    readings: Readings,
    units: Mapping[str, Rows],
    voted: Mapping[str, Row],
    surface_deg: Rows,
) -> SimpleNamespace:
    """The bus at this sample; `units` are redundant signals with their faults."""
    return SimpleNamespace(
        phi_deg=voted.get(PHI_UNITS, readings.phi_deg),
        beta_deg=readings.beta_deg + c.beta_error_deg,
        p_deg_s=voted.get(P_UNITS, readings.p_deg_s),
        r_voted_deg_s=voted["r_deg_s"],
        surface_deg=surface_deg,
        v_tas_m_s=motion.v_tas_measured_m_s + readings.v_tas_error_m_s,
        mass_kg=motion.mass_measured_kg,
        x_cg_ratio=motion.x_cg_measured_ratio,
        altitude_ft=motion.altitude_measured_ft,
        v_cas_kt=motion.v_cas_measured_kt,
        **units,
    )
