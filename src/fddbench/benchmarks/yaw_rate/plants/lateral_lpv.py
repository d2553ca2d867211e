"""The published lateral model with heading and track beside it, its surfaces, parameters and manoeuvres."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.ideal import ideal_models
from fddbench.benchmarks.yaw_rate.loop import LateralLoop
from fddbench.benchmarks.yaw_rate.manoeuvres import DURATIONS_S, KNOTS, bank_commands
from fddbench.benchmarks.yaw_rate.parameters import PARAMETERS, REFUSED
from fddbench.benchmarks.yaw_rate.plant import SITES, Motion
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.functions import asin, cos, interpolate, sin
from fddbench.blocks.integrate import rk4
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, product
from fddbench.flight.actuators import Actuators
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.lateral_lpv import SCHEDULING, derivatives, lateral_lpv
from fddbench.flight.wind import AirMotion, rotating
from fddbench.interfaces import Floats, IdealModel, Options, Parameter, Prepared, Site
from fddbench.units import DEG_PER_RAD

__all__ = ["LateralLpvPlant", "rudder_travel_deg"]

_DEPARTED_RAD = np.pi / 2.0
"""Beyond this bank angle the lateral model means nothing and the flight has departed."""
# our choice: ailerons +-25 deg, spoilers upward only, all 40 deg/s, first order at 14 rad/s
_RATE_DEG_S, _BANDWIDTH_RAD_S = 40.0, 14.0
_AILERON_DEG, _SPOILER_DEG = 25.0, 35.0
_RUDDER_FULL_DEG, _RUDDER_FULL_KT, _RUDDER_LEAST_DEG, _RUDDER_LEAST_KT = 30.0, 165.0, 5.0, 300.0


@record
class LateralState:
    """Bank angle, side velocity, roll and yaw rate; heading and lateral position."""

    phi_rad: Row
    v_y_m_s: Row
    p_rad_s: Row
    r_rad_s: Row
    psi_rad: Row
    y_m: Row


@record
class LateralConstants:
    """The flight condition, its trim, what is measured of it, deltas of the coefficients, the gust, travel, bank command."""

    mass_kg: Row
    x_cg_ratio: Row
    altitude_ft: Row
    v_cas_kt: Row
    v_tas_m_s: Row
    u0_m_s: Row
    w0_m_s: Row
    delta_c_y: Row
    delta_c_l: Row
    delta_c_n: Row
    gust_rotation_ratio: Row
    gust_yaw: Row
    rudder_travel_deg: Row
    mass_measured_kg: Row
    x_cg_measured_ratio: Row
    altitude_measured_ft: Row
    v_cas_measured_kt: Row
    v_tas_measured_m_s: Row
    knots_s: Rows
    bank_deg: Rows


def rudder_travel_deg(v_cas_kt: Row) -> Row:
    """Rudder travel [deg]: 30 up to 165 kt, then falling linearly in 1 / q (so in 1 / V_cas^2) to 5 at 300 kt and above.

    >>> rudder_travel_deg(np.array([120.0, 165.0, 300.0, 400.0]))
    array([30., 30.,  5.,  5.])
    """
    full, least = _RUDDER_FULL_KT**-2, _RUDDER_LEAST_KT**-2
    share = (1.0 / (v_cas_kt * v_cas_kt) - least) / (full - least)
    limited = np.minimum(np.maximum(share, 0.0), 1.0)
    return _RUDDER_LEAST_DEG + limited * (_RUDDER_FULL_DEG - _RUDDER_LEAST_DEG)


class LateralLpvPlant:
    """The published lateral LPV model, see `fddbench.benchmarks.yaw_rate.plant.LateralPlant`."""

    about = "published lateral LPV model with 13 surfaces"
    sites: tuple[Site, ...] = SITES
    parameters: tuple[Parameter, ...] = PARAMETERS
    refused_parameters: Mapping[str, str] = REFUSED
    manoeuvres: Mapping[str, float] = DURATIONS_S
    states = Layout(LateralState(phi_rad=ROW, v_y_m_s=ROW, p_rad_s=ROW, r_rad_s=ROW, psi_rad=ROW, y_m=ROW))
    constants = Layout(
        LateralConstants(
            mass_kg=ROW, x_cg_ratio=ROW, altitude_ft=ROW, v_cas_kt=ROW, v_tas_m_s=ROW, u0_m_s=ROW, w0_m_s=ROW,
            delta_c_y=ROW, delta_c_l=ROW, delta_c_n=ROW, gust_rotation_ratio=ROW, gust_yaw=ROW,
            rudder_travel_deg=ROW, mass_measured_kg=ROW,
            x_cg_measured_ratio=ROW, altitude_measured_ft=ROW, v_cas_measured_kt=ROW, v_tas_measured_m_s=ROW,
            knots_s=KNOTS, bank_deg=KNOTS,
        )
    )  # fmt: skip
    draws = NO_DRAWS

    def __init__(self, sample_s: float, substeps: int) -> None:
        self.sample_s, self.substeps = sample_s, substeps

    @classmethod
    def loop(cls, options: Options) -> LateralLoop:
        """The loop it flies in."""
        chosen, plant = options.chosen, cls(options.sample_s, options.substeps)
        return LateralLoop(plant, plant.sites, chosen["voter"], chosen["sensors"], chosen["wind"], options)

    @classmethod
    def ideal(
        cls, chosen: Mapping[str, Any], parameters: Mapping[str, Floats], sample_s: float
    ) -> Mapping[str, IdealModel] | str:
        """What the ideal test knows of flights, see `fddbench.benchmarks.yaw_rate.ideal`."""
        return ideal_models(chosen, parameters, sample_s)

    def actuators(self) -> Actuators:
        """Actuators of the 13 surfaces."""
        rate_deg_s = np.full((13, 1), _RATE_DEG_S)
        return Actuators(bandwidth_rad_s=_BANDWIDTH_RAD_S, rate_deg_s=rate_deg_s, sample_s=self.sample_s)

    def travel(self, c: LateralConstants) -> tuple[Rows, Rows]:
        """Lowest and highest positions of the 13 surfaces [deg], (13, n_cases)."""
        rudder, ones = c.rudder_travel_deg, np.ones_like(c.rudder_travel_deg)
        low = np.concatenate([-rudder[np.newaxis], column([-_AILERON_DEG] * 4 + [0.0] * 8) * ones])
        high = np.concatenate([rudder[np.newaxis], column([_AILERON_DEG] * 4 + [_SPOILER_DEG] * 8) * ones])
        return low, high

    def prepare(self, parameters: Mapping[str, Floats], manoeuvres: Sequence[str]) -> Prepared:
        """Trim speeds, measured values and bank commands of flights."""
        values = {name: parameters[name] for name in SCHEDULING}
        v_tas_m_s = true_airspeed_m_s(values["v_cas_kt"], values["altitude_ft"])
        model = lateral_lpv()
        u0_m_s, w0_m_s = model.trim_speeds_m_s(model.rho(*values.values()), v_tas_m_s)
        measured = _measured(parameters)
        knots_s, bank_deg = bank_commands(manoeuvres, v_tas_m_s)
        constants = LateralConstants(
            **values,
            **measured,
            v_tas_m_s=v_tas_m_s,
            u0_m_s=u0_m_s,
            w0_m_s=w0_m_s,
            delta_c_y=parameters["delta_c_y_percent"] / 100.0,
            delta_c_l=parameters["delta_c_l_percent"] / 100.0,
            delta_c_n=parameters["delta_c_n_percent"] / 100.0,
            gust_rotation_ratio=parameters["gust_rotation_ratio"],
            gust_yaw=parameters["gust_yaw_moment_percent"] / 100.0,
            rudder_travel_deg=rudder_travel_deg(values["v_cas_kt"]),
            v_tas_measured_m_s=true_airspeed_m_s(measured["v_cas_measured_kt"], measured["altitude_measured_ft"]),
            knots_s=knots_s,
            bank_deg=bank_deg,
        )
        reasons = infeasible_reasons(values["mass_kg"], values["altitude_ft"], values["v_cas_kt"])
        return Prepared(constants=constants, infeasible_reason=reasons)

    def start(self, c: LateralConstants) -> LateralState:
        """Wings level in trim: all lateral states are zero."""
        del c
        return LateralState(phi_rad=0.0, v_y_m_s=0.0, p_rad_s=0.0, r_rad_s=0.0, psi_rad=0.0, y_m=0.0)

    def step(
        self, x: LateralState, c: LateralConstants, n: Nothing, surface_deg: Rows, air: AirMotion, sample: Row
    ) -> tuple[LateralState, Motion]:
        """State at the next sample, surfaces and air held, and the motion at this one."""
        del n
        model = lateral_lpv()
        A, B = model.matrices(model.rho(c.mass_kg, c.x_cg_ratio, c.altitude_ft, c.v_cas_kt))
        delta = (c.delta_c_y, c.delta_c_l, c.delta_c_n)
        air = rotating(air, c.gust_rotation_ratio)
        M, f = derivatives(
            A, B, surface_deg, u0_m_s=c.u0_m_s, w0_m_s=c.w0_m_s, gust_m_s=air.v_m_s, delta=delta, gust_yaw=c.gust_yaw,
            rotation_rad_s=(air.p_rad_s, air.r_rad_s),
        )  # fmt: skip
        begun = np.stack([x.phi_rad, x.v_y_m_s, x.p_rad_s, x.r_rad_s])
        flown = rk4(_derivative, begun, M, f, step_s=self.sample_s, substeps=self.substeps)
        drift = c.v_tas_m_s * sin(x.psi_rad) + x.v_y_m_s * cos(x.psi_rad)
        after = LateralState(
            phi_rad=flown[0],
            v_y_m_s=flown[1],
            p_rad_s=flown[2],
            r_rad_s=flown[3],
            psi_rad=x.psi_rad + (0.5 * self.sample_s) * (x.r_rad_s + flown[3]),
            y_m=x.y_m + self.sample_s * drift,
        )
        return after, self._motion(x, c, air.v_m_s, sample)

    def _motion(self, x: LateralState, c: LateralConstants, gust_m_s: Row, sample: Row) -> Motion:
        """What there is to measure and to show of this sample."""
        return Motion(
            phi_deg=DEG_PER_RAD * x.phi_rad,
            beta_deg=DEG_PER_RAD * asin((x.v_y_m_s - gust_m_s) / c.v_tas_m_s),
            p_deg_s=DEG_PER_RAD * x.p_rad_s,
            r_deg_s=DEG_PER_RAD * x.r_rad_s,
            psi_deg=DEG_PER_RAD * x.psi_rad,
            y_m=x.y_m,
            v_tas_measured_m_s=c.v_tas_measured_m_s,
            mass_measured_kg=c.mass_measured_kg,
            x_cg_measured_ratio=c.x_cg_measured_ratio,
            altitude_measured_ft=c.altitude_measured_ft,
            v_cas_measured_kt=c.v_cas_measured_kt,
            bank_command_deg=interpolate(sample * self.sample_s, c.knots_s, c.bank_deg),
            departed=~(np.abs(x.phi_rad) <= _DEPARTED_RAD),
        )


def _derivative(x: Rows, M: Rows, f: Rows) -> Rows:
    """``xdot = M x + f``, (4, n_cases)."""
    return product(M, x) + f


def _measured(parameters: Mapping[str, Floats]) -> dict[str, Floats]:
    """Scheduling parameters as measured: true (1 + error)."""
    found = {}
    for name in SCHEDULING:
        quantity, unit = name.rsplit("_", 1)
        error = 1.0 + parameters[f"{quantity}_error_percent"] / 100.0
        found[f"{quantity}_measured_{unit}"] = parameters[name] * error
    return found
