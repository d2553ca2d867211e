"""What the nonlinear and the affine aircraft have in common: states, parameters, trim, what is seen of their motion."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fddbench.benchmarks.b747_longitudinal.conditions import (
    flown_aircraft,
    flown_condition,
    infeasible_reasons,
    trim_point,
)
from fddbench.benchmarks.b747_longitudinal.manoeuvres import DURATIONS_S
from fddbench.benchmarks.b747_longitudinal.parameters import PARAMETERS, REFUSED
from fddbench.benchmarks.b747_longitudinal.plant import SITES, TRIM_POINT, Motion, TrimPoint
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.b747.airframe import AIRCRAFT, Aircraft
from fddbench.flight.b747.dynamics import airflow
from fddbench.flight.b747.trim import Condition, Trim
from fddbench.flight.wind import AirMotion
from fddbench.interfaces import Floats, Parameter, Prepared, Site
from fddbench.units import DEG_PER_RAD

__all__ = ["Longitudinal", "LongitudinalConstants", "LongitudinalState", "after", "rows_of", "wind_of"]

# where the model means nothing any more; Table B1 ends at -2 and 10 deg, 150 and 280 m/s, 1 and 11 km
_ALPHA_DEG, _SPEED_M_S, _ALTITUDE_M, _THETA_DEG = (-10.0, 18.0), (100.0, 330.0), (0.0, 14e3), 45.0


@record
class LongitudinalState:
    """Angle of attack, pitch rate, airspeed, pitch angle, altitude; over ground where there is wind."""

    alpha_rad: Row
    q_rad_s: Row
    v_m_s: Row
    theta_rad: Row
    altitude_m: Row


@record
class LongitudinalConstants:
    """The aircraft and its trim."""

    aircraft: Aircraft
    trim: TrimPoint


def rows_of(x: LongitudinalState) -> Rows:
    """States in the order of `fddbench.flight.b747.dynamics.STATES`, (5, n_cases)."""
    return np.stack([x.alpha_rad, x.q_rad_s, x.v_m_s, x.theta_rad, x.altitude_m])


def after(flown: Rows) -> LongitudinalState:
    """State of rows in that order."""
    return LongitudinalState(
        alpha_rad=flown[0], q_rad_s=flown[1], v_m_s=flown[2], theta_rad=flown[3], altitude_m=flown[4]
    )


def wind_of(air: AirMotion) -> Rows:
    """Wind in the plane of symmetry as `fddbench.flight.b747.dynamics.airflow` takes it, (3, n_cases)."""
    return np.stack([air.u_m_s, air.w_m_s, air.q_rad_s])


class Longitudinal:
    """Base of the plants, see `fddbench.benchmarks.b747_longitudinal.plant.LongitudinalPlant`; they add trim and step."""

    sites: tuple[Site, ...] = SITES
    parameters: tuple[Parameter, ...] = PARAMETERS
    refused_parameters: Mapping[str, str] = REFUSED
    manoeuvres: Mapping[str, float] = DURATIONS_S
    states = Layout(LongitudinalState(alpha_rad=ROW, q_rad_s=ROW, v_m_s=ROW, theta_rad=ROW, altitude_m=ROW))
    constants = Layout(LongitudinalConstants(aircraft=AIRCRAFT.shape, trim=TRIM_POINT))
    draws: Any = NO_DRAWS

    def __init__(self, sample_s: float, substeps: int) -> None:
        self.sample_s, self.substeps = sample_s, substeps

    def found(self, aircraft: Aircraft, at: Condition) -> Trim:
        """Trim of this model in calm air."""
        raise NotImplementedError

    def trimmed(self, parameters: Mapping[str, Floats]) -> TrimPoint:
        """Trim of flights with these parameters; not-a-number where there is none."""
        at = flown_condition(parameters)
        return trim_point(at, self.found(flown_aircraft(parameters), at))

    def prepare(self, parameters: Mapping[str, Floats], manoeuvres: Sequence[str]) -> Prepared:
        """Aircraft and trim of flights."""
        del manoeuvres
        at = self.trimmed(parameters)
        constants = LongitudinalConstants(aircraft=flown_aircraft(parameters), trim=at)
        return Prepared(constants=constants, infeasible_reason=infeasible_reasons(at))

    def start(self, c: LongitudinalConstants) -> LongitudinalState:
        """Level, in trim; in wind, over ground as in calm air."""
        at = c.trim
        return LongitudinalState(
            alpha_rad=at.alpha_rad, q_rad_s=0.0, v_m_s=at.v_tas_m_s, theta_rad=at.alpha_rad, altitude_m=at.altitude_m
        )

    def motion(self, x: LongitudinalState, c: LongitudinalConstants, air: AirMotion) -> Motion:
        """What there is to measure and to show of this sample."""
        del c
        flow = airflow(rows_of(x), wind_of(air))
        alpha_deg, theta_deg = DEG_PER_RAD * flow.alpha_rad, DEG_PER_RAD * x.theta_rad
        inside = (alpha_deg >= _ALPHA_DEG[0]) & (alpha_deg <= _ALPHA_DEG[1]) & (np.abs(theta_deg) <= _THETA_DEG)
        inside = inside & (x.v_m_s >= _SPEED_M_S[0]) & (x.v_m_s <= _SPEED_M_S[1])
        inside = inside & (x.altitude_m >= _ALTITUDE_M[0]) & (x.altitude_m <= _ALTITUDE_M[1])
        return Motion(
            alpha_deg=alpha_deg,
            q_deg_s=DEG_PER_RAD * x.q_rad_s,
            v_tas_m_s=flow.v_tas_m_s,
            theta_deg=theta_deg,
            altitude_m=x.altitude_m,
            gamma_deg=DEG_PER_RAD * (x.theta_rad - x.alpha_rad),
            departed=~inside,
        )
