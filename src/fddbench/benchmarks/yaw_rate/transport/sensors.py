"""Sensors of the aircraft with six degrees of freedom: three of yaw rate, incidence and load factor, one of the others."""

from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.sensors import Noise
from fddbench.benchmarks.yaw_rate.unit_sensors import sensors_of
from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.flight.transport.motion import Motion
from fddbench.units import DEG_PER_RAD

__all__ = ["N_VOTED", "Readings", "TransportSensors"]

N_VOTED = 3
"""Sensors of incidence and of load factor."""


@record
class SensorDraws:
    """Numbers of the sensors that the lateral model has too, the same there; one for each of the others."""

    lateral: Any
    q: Row
    theta: Row
    alpha: Rows
    n_z_first: Row
    n_z_others: Rows


@record
class Readings:
    """Redundant readings, (n_sensors, n_cases): yaw rate [deg/s], incidence [deg], load factor [g]; others, (n_cases,).

    Of inertial units roll rates and bank angles are (n_sensors, n_cases). `v_tas_error_m_s` is to be added to the airspeed.
    """

    r_deg_s: Rows
    alpha_deg: Rows
    n_z_g: Rows
    beta_deg: Row
    p_deg_s: Any
    q_deg_s: Row
    phi_deg: Any
    theta_deg: Row
    v_tas_error_m_s: Row


class TransportSensors:
    """Sensors as a block: those of the lateral model, and incidence, load factor, pitch angle and rate, which keep nothing.

    Parameters
    ----------
    noise : Noise
        How noisy they are.
    n_rates : int
        Yaw-rate sensors.
    sample_s : float
        Sample time [s].
    """

    def __init__(self, noise: Noise, n_rates: int, sample_s: float) -> None:
        self.noise, self.n_rates = noise, n_rates
        self.lateral: Any = sensors_of(noise, n_rates, sample_s)
        self.n_units: int = self.lateral.n_units
        self.states: Layout[Any] = self.lateral.states
        self.constants: Layout[Any] = self.lateral.constants
        self.before: Draws[Any] = self.lateral.before
        self.draws: Draws[SensorDraws] = Draws(
            SensorDraws(
                lateral=self.lateral.draws.names,
                q=Draw(consumers.SENSORS_B, 2),
                theta=Draw(consumers.SENSORS_B, 3),
                alpha=Draw(consumers.SENSORS_C, 0, rows=3),
                n_z_first=Draw(consumers.SENSORS_C, 3),
                n_z_others=Draw(consumers.SENSORS_D, 0, rows=2),
            )
        )

    def prepare(self, normals: Any) -> Any:
        """Errors of flights."""
        return self.lateral.prepare(normals)

    def start(self, c: Any) -> Any:
        """Level flight before sample 0."""
        return self.lateral.start(c)

    def step(self, x: Any, c: Any, n: SensorDraws, sample: Row, motion: Motion) -> tuple[Any, Readings]:
        """What is kept, and what they read of the true motion."""
        noise = self.noise
        after, lateral = self.lateral.step(
            x, c, n.lateral, sample,
            r_deg_s=DEG_PER_RAD * motion.r_rad_s, beta_deg=DEG_PER_RAD * motion.beta_rad,
            p_deg_s=DEG_PER_RAD * motion.p_rad_s, phi_deg=DEG_PER_RAD * motion.phi_rad,
        )  # fmt: skip
        n_z = np.stack([n.n_z_first, *n.n_z_others])
        readings = Readings(
            r_deg_s=lateral.r_deg_s,
            alpha_deg=DEG_PER_RAD * motion.alpha_rad + noise.alpha_deg * n.alpha,
            n_z_g=motion.n_z_g + noise.n_z_g * n_z,
            beta_deg=lateral.beta_deg,
            p_deg_s=lateral.p_deg_s,
            q_deg_s=DEG_PER_RAD * motion.q_rad_s + noise.q_deg_s * n.q,
            phi_deg=lateral.phi_deg,
            theta_deg=DEG_PER_RAD * motion.theta_rad + noise.theta_deg * n.theta,
            v_tas_error_m_s=lateral.v_tas_error_m_s,
        )
        return after, readings
