"""The public twin-jet with six degrees of freedom, for the whole envelope."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fddbench.benchmarks.yaw_rate.plant import SITES
from fddbench.benchmarks.yaw_rate.transport.gains import Schedule, shipped_law
from fddbench.benchmarks.yaw_rate.transport.law import LawConstants, TransportLaw
from fddbench.benchmarks.yaw_rate.transport.loop import TransportLoop
from fddbench.benchmarks.yaw_rate.transport.needs import reasons, sizes
from fddbench.benchmarks.yaw_rate.transport.parameters import PARAMETERS
from fddbench.benchmarks.yaw_rate.transport.plant import BODY, PlantConstants, PlantState
from fddbench.benchmarks.yaw_rate.transport.profiles import DURATIONS_S, number_of
from fddbench.benchmarks.yaw_rate.transport.seeing import RESPONSES
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.functions import atan2, cos
from fddbench.blocks.integrate import rk4
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows
from fddbench.flight.atmosphere import FT_M, KT_M_S, true_airspeed_m_s
from fddbench.flight.transport.aerodynamics import Controls
from fddbench.flight.transport.air import air_around
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.body import AXES, body_of
from fddbench.flight.transport.equations import ROWS, State, derivative, forces, normalised
from fddbench.flight.transport.motion import Motion, motion_of
from fddbench.flight.transport.reading import read_aircraft, read_data, twin_jet
from fddbench.flight.transport.trim import trim
from fddbench.flight.wind import AirMotion
from fddbench.interfaces import Floats, Options, Parameter, Prepared, Response, Site
from fddbench.units import DEG_PER_RAD

__all__ = ["Transport6Dof"]


class Transport6Dof:
    """The twin-jet in closed loop.

    A campaign flies an aircraft of one's own with ``plant: mine.yaml``, a changed copy of `data/twin_jet.yaml` beside it, which
    may have gains of its own as ``law``. A subclass may add fault sites on yaw rate, incidence, load factor, surfaces,
    elevators and the stabiliser.
    """

    about = "public twin-jet with 6 degrees of freedom for the whole envelope, 16 surfaces, engines, protections"
    sites: tuple[Site, ...] = SITES
    parameters: tuple[Parameter, ...] = PARAMETERS
    refused_parameters: Mapping[str, str] = {}
    manoeuvres: Mapping[str, float] = DURATIONS_S
    responses: tuple[Response, ...] = RESPONSES
    aircraft: Aircraft = twin_jet()
    gains: Schedule = shipped_law()
    states = Layout(PlantState(rigid=ROWS, psi_rad=ROW, turns=ROW))
    constants = Layout(
        PlantConstants(
            body=BODY, begun=ROWS, v_tas_m_s=ROW, wind_north_m_s=ROW, wind_east_m_s=ROW, track_rad=ROW,
            mass_measured_kg=ROW, x_cg_measured_ratio=ROW, one_altitude=ROW, one_v_cas=ROW, beta_error_deg=ROW,
            law=TransportLaw.constants.shape,
        )
    )  # fmt: skip
    draws = NO_DRAWS

    def __init__(self, sample_s: float, substeps: int) -> None:
        self.sample_s, self.substeps = sample_s, substeps

    @classmethod
    def loop(cls, options: Options) -> TransportLoop:
        """The loop it flies in."""
        return TransportLoop(cls(options.sample_s, options.substeps), options)

    @classmethod
    def of_file(cls, path: Path) -> type["Transport6Dof"]:
        """The plant of an aircraft's file, flown with its own gains where it has any.

        Raises
        ------
        FddbenchError
            What is wrong in the file.
        """
        aircraft, law = read_aircraft(path), read_data(path).get("law")
        gains = cls.gains if law is None else Schedule(law)
        own = {"aircraft": aircraft, "gains": gains, "about": aircraft.about, "__doc__": aircraft.about}
        return type(path.stem, (cls,), own)

    def prepare(self, parameters: Mapping[str, Floats], manoeuvres: Sequence[str]) -> Prepared:
        """Level trim, what is measured, and what the manoeuvre needs of each flight."""
        aircraft = self.aircraft
        mass, x_cg = parameters["mass_kg"], parameters["x_cg_ratio"]
        altitude, v_cas = parameters["altitude_ft"], parameters["v_cas_kt"]
        deltas = {axis: parameters[f"delta_c_{axis}_percent"] / 100.0 for axis in AXES}
        body = body_of(aircraft, mass, x_cg, deltas, gust_yaw=parameters["gust_yaw_moment_percent"] / 100.0)
        v_tas = true_airspeed_m_s(v_cas, altitude)
        at = trim(aircraft, body, v_tas, altitude * FT_M)
        one = {
            name: 1.0 + parameters[f"{name}_error_percent"] / 100.0 for name in ("mass", "x_cg", "altitude", "v_cas")
        }
        law = LawConstants(
            manoeuvre=np.array([number_of(name) for name in manoeuvres]),
            alpha_rad=at.alpha_rad,
            cos_theta=cos(at.alpha_rad),
            stabiliser_deg=DEG_PER_RAD * at.stabiliser_rad,
            thrust_ratio=at.thrust_ratio,
            altitude_m=at.altitude_m,
            v_cas_kt=v_cas,
            **sizes(aircraft, manoeuvres, mass, altitude, v_cas),
        )
        north, east = (KT_M_S * parameters[name] for name in ("tail_wind_kt", "cross_wind_kt"))
        constants = PlantConstants(
            body=body, begun=at.rows(), v_tas_m_s=v_tas, wind_north_m_s=north, wind_east_m_s=east,
            track_rad=atan2(east, v_tas + north), mass_measured_kg=mass * one["mass"],
            x_cg_measured_ratio=x_cg * one["x_cg"], one_altitude=one["altitude"], one_v_cas=one["v_cas"],
            beta_error_deg=parameters["beta_error_deg"], law=law,
        )  # fmt: skip
        return Prepared(constants=constants, infeasible_reason=reasons(aircraft, manoeuvres, mass, altitude, v_cas))

    def start(self, c: PlantConstants) -> PlantState:
        """In trim, northbound."""
        return PlantState(rigid=c.begun, psi_rad=0.0, turns=0.0)

    def step(
        self, x: PlantState, c: PlantConstants, n: Nothing, controls: Controls, moving: AirMotion, thrust_ratio: Row
    ) -> tuple[PlantState, Motion]:
        """State at the next sample, surfaces, air and engines held, and the motion at this one."""
        del n
        aircraft = self.aircraft
        begun = State(*x.rigid)
        air = air_around(begun.altitude)

        def rate(rows: Rows) -> Rows:
            return derivative(aircraft, c.body, air, rows, controls, moving, thrust_ratio)

        flown = rk4(rate, x.rigid, step_s=self.sample_s, substeps=self.substeps)
        felt = forces(aircraft, c.body, air, begun, controls, moving, thrust_ratio)
        motion = motion_of(begun, air, felt, c.wind_north_m_s, c.wind_east_m_s, mass_kg=c.body.mass_kg)
        # a heading that goes on beyond half a turn
        moved = motion.psi_rad - x.psi_rad
        turns = x.turns + np.where(moved < -np.pi, 1.0, 0.0) - np.where(moved > np.pi, 1.0, 0.0)
        # velocities are those through the air; a steady wind carries air and aircraft along
        carried = self.sample_s * c.wind_north_m_s, self.sample_s * c.wind_east_m_s
        moved_on = np.stack([*flown[:10], flown[10] + carried[0], flown[11] + carried[1], flown[12]])
        after = PlantState(rigid=normalised(moved_on), psi_rad=motion.psi_rad, turns=turns)
        return after, replace(motion, psi_rad=motion.psi_rad + 2.0 * np.pi * turns)
