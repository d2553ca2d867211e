"""Sensors of the aircraft with six degrees of freedom: three of yaw rate, incidence and load factor, one of the others."""

import numpy as np

from fddbench.benchmarks.yaw_rate.sensors import Noise
from fddbench.blocks import consumers
from fddbench.blocks.block import NOTHING
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import Nothing, Row, Rows, record
from fddbench.flight.transport.motion import Motion
from fddbench.units import DEG_PER_RAD

__all__ = ["N_VOTED", "Readings", "TransportSensors"]

N_VOTED = 3
"""Sensors of incidence and of load factor."""


@record
class SensorDraws:
    """One normal number for each sensor; those that the lateral model has too see the same numbers there."""

    r: tuple[Row, ...]
    beta: Row
    p: Row
    phi: Row
    q: Row
    theta: Row
    alpha: Rows
    n_z_first: Row
    n_z_others: Rows


@record
class Readings:
    """Redundant readings, (n_sensors, n_cases): yaw rate [deg/s], incidence [deg], load factor [g]; others, (n_cases,)."""

    r_deg_s: Rows
    alpha_deg: Rows
    n_z_g: Rows
    beta_deg: Row
    p_deg_s: Row
    q_deg_s: Row
    phi_deg: Row
    theta_deg: Row


class TransportSensors:
    """Sensors as a block without states and constants.

    Parameters
    ----------
    noise : Noise
        How noisy they are.
    n_rates : int
        Yaw-rate sensors.
    """

    states = NOTHING
    constants = NOTHING

    def __init__(self, noise: Noise, n_rates: int) -> None:
        self.noise, self.n_rates = noise, n_rates
        self.draws: Draws[SensorDraws] = Draws(
            SensorDraws(
                r=tuple(Draw(*consumers.sensor_number(j)) for j in range(n_rates)),
                beta=Draw(consumers.SENSORS_A, 3),
                p=Draw(consumers.SENSORS_B, 0),
                phi=Draw(consumers.SENSORS_B, 1),
                q=Draw(consumers.SENSORS_B, 2),
                theta=Draw(consumers.SENSORS_B, 3),
                alpha=Draw(consumers.SENSORS_C, 0, rows=3),
                n_z_first=Draw(consumers.SENSORS_C, 3),
                n_z_others=Draw(consumers.SENSORS_D, 0, rows=2),
            )
        )

    def start(self, c: Nothing) -> Nothing:
        """Nothing to keep."""
        return c

    def step(self, x: Nothing, c: Nothing, n: SensorDraws, motion: Motion) -> tuple[Nothing, Readings]:
        """What they read of the true motion."""
        del c
        noise = self.noise
        n_z = np.stack([n.n_z_first, *n.n_z_others])
        readings = Readings(
            r_deg_s=DEG_PER_RAD * motion.r_rad_s + noise.r_deg_s * np.stack(n.r),
            alpha_deg=DEG_PER_RAD * motion.alpha_rad + noise.alpha_deg * n.alpha,
            n_z_g=motion.n_z_g + noise.n_z_g * n_z,
            beta_deg=DEG_PER_RAD * motion.beta_rad + noise.beta_deg * n.beta,
            p_deg_s=DEG_PER_RAD * motion.p_rad_s + noise.p_deg_s * n.p,
            q_deg_s=DEG_PER_RAD * motion.q_rad_s + noise.q_deg_s * n.q,
            phi_deg=DEG_PER_RAD * motion.phi_rad + noise.phi_deg * n.phi,
            theta_deg=DEG_PER_RAD * motion.theta_rad + noise.theta_deg * n.theta,
        )
        return x, readings
