"""What the ideal test knows of a flight of the lateral model: its matrices, the noise of its sensors, its gust."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.linalg import expm

from fddbench.benchmarks.yaw_rate.sensors import Noise
from fddbench.flight.atmosphere import true_airspeed_m_s
from fddbench.flight.lateral_lpv import SCHEDULING, derivatives, lateral_lpv
from fddbench.flight.rotating_gust import RotatingGust
from fddbench.flight.turbulence import SCALE_LENGTH_M, LateralGust
from fddbench.interfaces import Floats, IdealModel
from fddbench.units import DEG_PER_RAD

__all__ = ["WALKS_DEG_S2", "ideal_models"]

WALKS_DEG_S2 = {"exact": 0.0, "walk 0.05": 0.05, "walk 0.5": 0.5}
"""By model, how fast an unknown yaw acceleration wanders [deg/s^2 per root second]: what the model of the yaw moment lacks."""

_PHI, _P, _R, _BIAS, _GUST = 0, 2, 3, 4, slice(5, 7)
_GROUPS = tuple(tuple(f"{signal}{unit}" for unit in (1, 2, 3)) for signal in ("r", "p", "phi"))
"""Fault sites that measure one quantity; roll rates and bank angles are sites of inertial units only."""
_GUST_OUTPUT = np.array([np.sqrt(3.0), 1.0 - np.sqrt(3.0)])
# stationary covariance of the two states of the Dryden filter for unit output variance, see flight.turbulence
_STATIONARY = np.array([[0.5, 0.25], [0.25, 0.25]])


def ideal_models(
    chosen: Mapping[str, Any], parameters: Mapping[str, Floats], sample_s: float
) -> dict[str, IdealModel] | str:
    """Models by name for flights with these parameters, or why there is none.

    States: bank angle, side velocity, roll and yaw rate, unknown yaw acceleration, two of the gust; outputs: what the sensors
    read [deg, deg/s], each unit by itself. The aircraft is known as it is, deltas of its coefficients included, surfaces are
    known, and so is what a flight draws once of sensor errors. A wind that is no Dryden gust is taken as known
    too, and so are the rotations of a gust and what of its yawing moment is off the model.
    """
    noise, wind = chosen["sensors"], chosen["wind"]
    if min(noise.r_deg_s, noise.beta_deg, noise.p_deg_s, noise.phi_deg) <= 0.0:
        return "sensors without noise find any fault at once"
    sigma = (
        np.asarray(wind.sigma_m_s if isinstance(wind, LateralGust | RotatingGust) else 0.0)
        * parameters["gust_scale_ratio"]
    )
    v_tas_m_s = true_airspeed_m_s(parameters["v_cas_kt"], parameters["altitude_ft"])
    A, gust_noise = _sampled(_matrix(parameters, v_tas_m_s), sigma, v_tas_m_s, sample_s)
    C, sigmas = _sensors(noise, sigma, v_tas_m_s)
    start = np.zeros_like(A)
    start[:, _GUST, _GUST] = _STATIONARY
    found = {}
    for name, walk_deg_s2 in WALKS_DEG_S2.items():
        Q = gust_noise.copy()
        Q[:, _BIAS, _BIAS] = (walk_deg_s2 / DEG_PER_RAD) ** 2 * sample_s
        found[name] = IdealModel(
            about=_about(noise, walk_deg_s2, gust=bool(np.any(sigma > 0.0))),
            A=A, C=C, Q=Q, R=np.broadcast_to(np.diag(sigmas**2), (len(C), len(sigmas), len(sigmas))), start=start,
            outputs={name: 1 + row for row, name in enumerate(n for group in _GROUPS for n in group)},
            together=_GROUPS,
        )  # fmt: skip
    return found


def _about(noise: Noise, walk_deg_s2: float, *, gust: bool) -> str:
    """What is supposed, in words."""
    sensors = "white sensor noise" if noise.errors is None else "white sensor noise, drawn errors known"
    moment = f"yaw acceleration off by a random walk of {walk_deg_s2:g} deg/s2 per root second"
    air = "Dryden gust" if gust else "gust known"
    return f"{sensors}, {air}, {moment if walk_deg_s2 else 'aircraft known'}"


def _sensors(noise: Noise, sigma: Floats, v_tas_m_s: Floats) -> tuple[Floats, Floats]:
    """Output matrices, (n_cases, n_y, 7), and one sigma of each output: sideslip, then yaw rates, roll rates, bank angles.

    Plain sensors give one roll rate and one bank angle, which stand in the first rows of their three with the others blind.
    """
    several = noise.errors is not None
    C = np.zeros((len(v_tas_m_s), 10, 7))
    C[:, 0, 1] = DEG_PER_RAD / v_tas_m_s
    C[:, 0, _GUST] = -(DEG_PER_RAD * sigma / v_tas_m_s)[:, np.newaxis] * _GUST_OUTPUT
    C[:, 1:4, _R] = DEG_PER_RAD
    C[:, 4 : 7 if several else 5, _P] = DEG_PER_RAD
    C[:, 7 : 10 if several else 8, _PHI] = DEG_PER_RAD
    return C, np.array([noise.beta_deg, *[noise.r_deg_s] * 3, *[noise.p_deg_s] * 3, *[noise.phi_deg] * 3])


def _matrix(parameters: Mapping[str, Floats], v_tas_m_s: Floats) -> Floats:
    """``xdot = M x`` of each flight with its own coefficients, (n_cases, 4, 4)."""
    model = lateral_lpv()
    rho = model.rho(*(parameters[name] for name in SCHEDULING))
    A, B = model.matrix("A", rho), model.matrix("B", rho)
    u0_m_s, w0_m_s = model.trim_speeds_m_s(rho, v_tas_m_s)
    d_y, d_l, d_n = (parameters[f"delta_c_{axis}_percent"] / 100.0 for axis in ("y", "l", "n"))
    still = np.zeros((B.shape[1], len(v_tas_m_s)))
    M, _ = derivatives(
        A, B, still, u0_m_s=u0_m_s, w0_m_s=w0_m_s, gust_m_s=np.zeros_like(v_tas_m_s), delta=(d_y, d_l, d_n)
    )
    found: Floats = M.transpose(2, 0, 1)
    return found


def _sampled(M: Floats, sigma: Floats, v_tas_m_s: Floats, sample_s: float) -> tuple[Floats, Floats]:
    """Transition of the seven states in a sample and covariance of the gust's noise, (n_cases, 7, 7) each; the gust is held."""
    n_cases = len(M)
    rates = np.zeros((n_cases, 7, 7))
    rates[:, :4, :4] = M
    rates[:, _R, _BIAS] = 1.0
    rates[:, :4, _GUST] = -M[:, :, 1:2] * (sigma[:, np.newaxis] * _GUST_OUTPUT)[:, np.newaxis]
    A = expm(rates * sample_s)
    turn = np.zeros((n_cases, 2, 2))
    turn[:, 0, 0] = turn[:, 1, 1] = -(v_tas_m_s / SCALE_LENGTH_M)
    turn[:, 1, 0] = v_tas_m_s / SCALE_LENGTH_M
    F = expm(turn * sample_s)
    A[:, _GUST, _GUST] = F
    Q = np.zeros_like(A)
    Q[:, _GUST, _GUST] = _STATIONARY - F @ _STATIONARY @ F.transpose(0, 2, 1)
    return A, Q
