"""What is to be seen of a sample: by detectors on the bus, by the law, and what nobody measures."""

from collections.abc import Mapping
from types import SimpleNamespace

import numpy as np

from fddbench.benchmarks.yaw_rate.transport.law import GUIDANCE
from fddbench.benchmarks.yaw_rate.transport.plant import PlantConstants
from fddbench.benchmarks.yaw_rate.transport.sensed import Sensed
from fddbench.benchmarks.yaw_rate.transport.sensors import Readings
from fddbench.benchmarks.yaw_rate.unit_sites import P_UNITS, PHI_UNITS
from fddbench.blocks.layout import Row, Rows
from fddbench.flight.atmosphere import FT_M, dynamic_pressure_pa, true_airspeed_m_s
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.limits import highest_alpha_rad
from fddbench.flight.transport.motion import Motion
from fddbench.interfaces import Response
from fddbench.units import DEG_PER_RAD, RAD_PER_DEG

__all__ = ["RESPONSES", "TRUTH", "departed", "measured", "sensed", "signals", "truth"]

TRUTH = (
    *(
        "phi_true_deg",
        "beta_true_deg",
        "p_true_deg_s",
        "r_true_deg_s",
        "psi_deg",
        "y_m",
        "gust_m_s",
    ),
    *(
        "theta_true_deg",
        "alpha_true_deg",
        "q_true_deg_s",
        "n_z_true_g",
        "altitude_true_ft",
        "v_cas_true_kt",
        "mach",
        "drag_n",
    ),
    *GUIDANCE,
)
RESPONSES = (
    Response(signal="p_true_deg_s"),
    Response(signal="r_true_deg_s"),
    Response(signal="beta_true_deg", command="sideslip_command_deg"),
    Response(signal="phi_true_deg", command="bank_command_deg"),
    Response(signal="psi_deg", command="track_command_deg"),
    Response(signal="y_m"),
    Response(signal="theta_true_deg", limits=("theta_limit_deg",)),
    Response(signal="n_z_true_g", command="n_z_command_g", limits=("n_z_least_g", "n_z_most_g")),
    Response(signal="alpha_true_deg", limits=("alpha_limit_deg",)),
    Response(signal="v_cas_true_kt", command="v_cas_command_kt", limits=("v_cas_limit_kt",)),
    Response(signal="altitude_true_ft"),
    Response(signal="thrust_ratio"),
)
"""What a pilot looks at: first the six lateral signals of Figures 9 and 10 of the paper, then the longitudinal ones."""
_MOST_BANK, _MOST_PITCH, _MOST_SIDESLIP = (RAD_PER_DEG * each for each in (90.0, 60.0, 20.0))
_BEYOND_BUFFET, _BELOW_ZERO_LIFT = RAD_PER_DEG * 8.0, RAD_PER_DEG * 12.0


def signals(n_rates: int, n_voted: int) -> Mapping[str, int]:
    """Signals of the bus and their rows; the first are those of the lateral model."""
    single = ("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "v_tas_m_s")
    known = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
    more = ("theta_deg", "q_deg_s", "alpha_voted_deg", "n_z_voted_g", "stabiliser_deg", "thrust_ratio")
    rows = {"r_deg_s": n_rates, "surface_deg": 13}
    beside = {"alpha_deg": n_voted, "n_z_g": n_voted, "elevator_deg": 2}
    return dict.fromkeys(single, 0) | rows | dict.fromkeys(known, 0) | dict.fromkeys(more, 0) | beside


def measured(
    c: PlantConstants,
    motion: Motion,
    readings: Readings,
    s: Mapping[str, Rows],
    voted: Mapping[str, Row],
    thrust_ratio: Row,
) -> SimpleNamespace:
    """The bus at this sample; `s` are the signals with their faults."""
    altitude_ft = c.one_altitude * (motion.altitude_m * (1.0 / FT_M))
    v_cas_kt = c.one_v_cas * motion.v_cas_kt
    units = {name: s[name] for name in (P_UNITS, PHI_UNITS) if name in s}
    return SimpleNamespace(
        phi_deg=voted.get(PHI_UNITS, readings.phi_deg),
        theta_deg=readings.theta_deg,
        beta_deg=readings.beta_deg + c.beta_error_deg,
        p_deg_s=voted.get(P_UNITS, readings.p_deg_s),
        q_deg_s=readings.q_deg_s,
        r_deg_s=s["r_deg_s"],
        r_voted_deg_s=voted["r_deg_s"],
        alpha_deg=s["alpha_deg"],
        alpha_voted_deg=voted["alpha_deg"],
        n_z_g=s["n_z_g"],
        n_z_voted_g=voted["n_z_g"],
        surface_deg=s["surface_deg"],
        elevator_deg=s["elevator_deg"],
        stabiliser_deg=s["stabiliser_deg"][0],
        thrust_ratio=thrust_ratio,
        v_tas_m_s=true_airspeed_m_s(v_cas_kt, altitude_ft) + readings.v_tas_error_m_s,
        mass_kg=c.mass_measured_kg,
        x_cg_ratio=c.x_cg_measured_ratio,
        altitude_ft=altitude_ft,
        v_cas_kt=v_cas_kt,
        **units,
    )


def sensed(bus: SimpleNamespace, motion: Motion, c: PlantConstants) -> Sensed:
    """What the law knows: voted sensors, errors of what is known in its schedule, true air data, the change of the track."""
    return Sensed(
        phi_rad=RAD_PER_DEG * bus.phi_deg,
        theta_rad=RAD_PER_DEG * bus.theta_deg,
        alpha_rad=RAD_PER_DEG * bus.alpha_voted_deg,
        beta_rad=RAD_PER_DEG * bus.beta_deg,
        p_rad_s=RAD_PER_DEG * bus.p_deg_s,
        q_rad_s=RAD_PER_DEG * bus.q_deg_s,
        r_rad_s=RAD_PER_DEG * bus.r_voted_deg_s,
        n_z_g=bus.n_z_voted_g,
        scheduled_pa=dynamic_pressure_pa(bus.v_cas_kt, bus.altitude_ft),
        mass_kg=bus.mass_kg,
        track_rad=motion.track_rad - c.track_rad,
        altitude_m=motion.altitude_m,
        climb_m_s=motion.climb_m_s,
        v_tas_m_s=motion.v_tas_m_s,
        v_cas_kt=motion.v_cas_kt,
        v_cas_dot_kt_s=motion.v_cas_dot_kt_s,
        mach=motion.mach,
        pressure_pa=motion.pressure_pa,
        density_kg_m3=motion.density_kg_m3,
    )


def truth(motion: Motion, gust_m_s: Row, guidance: Mapping[str, Row]) -> dict[str, Rows]:
    """What nobody measures, by the names of `TRUTH`; `guidance` is what the law follows."""
    m = motion
    degrees = (m.phi_rad, m.beta_rad, m.p_rad_s, m.r_rad_s, m.psi_rad)
    first = (*(DEG_PER_RAD * each for each in degrees), m.east_m, gust_m_s)
    pitch = tuple(DEG_PER_RAD * each for each in (m.theta_rad, m.alpha_rad, m.q_rad_s))
    own = (*first, *pitch, m.n_z_g, m.altitude_m / FT_M, m.v_cas_kt, m.mach, m.drag_n)
    return dict(zip(TRUTH, own, strict=False)) | dict(guidance)


def departed(aircraft: Aircraft, m: Motion) -> Row:
    """Whether a flight has left what the coefficients describe: 90 deg of bank, 60 of pitch, 20 of sideslip, deep in buffet."""
    most = highest_alpha_rad(aircraft, m.mach) + _BEYOND_BUFFET
    least = aircraft.lift.alpha_zero_deg * RAD_PER_DEG - _BELOW_ZERO_LIFT
    inside = (
        (np.abs(m.phi_rad) <= _MOST_BANK)
        & (np.abs(m.theta_rad) <= _MOST_PITCH)
        & (np.abs(m.beta_rad) <= _MOST_SIDESLIP)
        & (m.alpha_rad <= most)
        & (m.alpha_rad >= least)
    )
    return ~inside
