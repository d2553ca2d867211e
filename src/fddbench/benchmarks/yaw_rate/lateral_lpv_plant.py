"""The aircraft of the yaw-rate benchmark: the published lateral model with heading and track beside it."""

from collections.abc import Mapping
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.functions import cos, sin
from fddbench.blocks.layout import Layout, Rows
from fddbench.blocks.linear import column, product
from fddbench.flight.actuators import Actuators
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.lateral_lpv import SCHEDULING, derivatives, lateral_lpv
from fddbench.interfaces import Floats

__all__ = ["CONSTANTS", "STATES", "actuators", "fly", "prepare", "rudder_travel_deg", "travel"]

STATES = Layout(phi_rad=0, v_y_m_s=0, p_rad_s=0, r_rad_s=0, psi_rad=0, y_m=0)
CONSTANTS = Layout(
    **dict.fromkeys(SCHEDULING, 0),
    v_tas_m_s=0, u0_m_s=0, w0_m_s=0, delta_c_y=0, delta_c_l=0, delta_c_n=0, rudder_travel_deg=0,
    mass_measured_kg=0, x_cg_measured_ratio=0, altitude_measured_ft=0, v_cas_measured_kt=0, v_tas_measured_m_s=0,
)  # fmt: skip
# our choice: ailerons +-25 deg, spoilers upward only, all 40 deg/s, first order at 14 rad/s
_RATE_DEG_S, _BANDWIDTH_RAD_S = 40.0, 14.0
_AILERON_DEG, _SPOILER_DEG = 25.0, 35.0
_RUDDER_FULL_DEG, _RUDDER_FULL_KT, _RUDDER_LEAST_DEG, _RUDDER_LEAST_KT = 30.0, 165.0, 5.0, 300.0


def actuators(sample_s: float) -> Actuators:
    """Actuators of the 13 surfaces."""
    return Actuators(bandwidth_rad_s=_BANDWIDTH_RAD_S, rate_deg_s=np.full((13, 1), _RATE_DEG_S), sample_s=sample_s)


def rudder_travel_deg(v_cas_kt: Rows) -> Rows:
    """Rudder travel [deg]: 30 up to 165 kt, then falling linearly in 1 / q (so in 1 / V_cas^2) to 5 at 300 kt and above.

    >>> rudder_travel_deg(np.array([120.0, 165.0, 300.0, 400.0]))
    array([30., 30.,  5.,  5.])
    """
    full, least = _RUDDER_FULL_KT**-2, _RUDDER_LEAST_KT**-2
    share = (1.0 / (v_cas_kt * v_cas_kt) - least) / (full - least)
    limited = np.minimum(np.maximum(share, 0.0), 1.0)
    return _RUDDER_LEAST_DEG + limited * (_RUDDER_FULL_DEG - _RUDDER_LEAST_DEG)


def travel(rudder_deg: Rows) -> tuple[Rows, Rows]:
    """Lowest and highest positions of the 13 surfaces [deg], (13, n_cases)."""
    ones = np.ones_like(rudder_deg)
    low = np.concatenate([-rudder_deg[np.newaxis], column([-_AILERON_DEG] * 4 + [0.0] * 8) * ones])
    high = np.concatenate([rudder_deg[np.newaxis], column([_AILERON_DEG] * 4 + [_SPOILER_DEG] * 8) * ones])
    return low, high


def prepare(parameters: Mapping[str, Floats]) -> tuple[dict[str, Floats], tuple[str, ...]]:
    """Constants of `CONSTANTS` by name, (n_cases,) each, and per case why it cannot fly ("": it can)."""
    values = {name: parameters[name] for name in SCHEDULING}
    values["v_tas_m_s"] = true_airspeed_m_s(values["v_cas_kt"], values["altitude_ft"])
    model = lateral_lpv()
    rho = model.rho(*(values[name] for name in SCHEDULING))
    values["u0_m_s"], values["w0_m_s"] = model.trim_speeds_m_s(rho, values["v_tas_m_s"])
    for axis in "yln":
        values[f"delta_c_{axis}"] = parameters[f"delta_c_{axis}_percent"] / 100.0
    values["rudder_travel_deg"] = rudder_travel_deg(values["v_cas_kt"])
    for name in SCHEDULING:
        quantity, unit = name.rsplit("_", 1)
        error = 1.0 + parameters[f"{quantity}_error_percent"] / 100.0
        values[f"{quantity}_measured_{unit}"] = values[name] * error
    values["v_tas_measured_m_s"] = true_airspeed_m_s(values["v_cas_measured_kt"], values["altitude_measured_ft"])
    return values, infeasible_reasons(values["mass_kg"], values["altitude_ft"], values["v_cas_kt"])


def fly(aircraft: Rows, surface_deg: Rows, gust_m_s: Rows, c: SimpleNamespace, sample_s: float, substeps: int) -> Rows:
    """Aircraft at the next sample, surfaces and gust held: Runge-Kutta 4 on ``xdot = M x + f`` in `substeps` steps.

    Parameters
    ----------
    aircraft : (6, n_cases) rows
        `STATES`.
    c : SimpleNamespace
        `CONSTANTS` by name.
    """
    model = lateral_lpv()
    rho = model.rho(c.mass_kg, c.x_cg_ratio, c.altitude_ft, c.v_cas_kt)
    A, B = model.matrices(rho)
    x = aircraft[:4]
    delta = (c.delta_c_y, c.delta_c_l, c.delta_c_n)
    M, f = derivatives(A, B, surface_deg, u0_m_s=c.u0_m_s, w0_m_s=c.w0_m_s, gust_m_s=gust_m_s, delta=delta)
    h = sample_s / substeps
    for _ in range(substeps):
        k1 = product(M, x) + f
        k2 = product(M, x + (0.5 * h) * k1) + f
        k3 = product(M, x + (0.5 * h) * k2) + f
        k4 = product(M, x + h * k3) + f
        x = x + (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    now = STATES.unpack(aircraft)
    psi = now.psi_rad + (0.5 * sample_s) * (now.r_rad_s + x[3])
    drift = c.v_tas_m_s * sin(now.psi_rad) + now.v_y_m_s * cos(now.psi_rad)
    return np.concatenate([x, psi[np.newaxis], (now.y_m + sample_s * drift)[np.newaxis]])
