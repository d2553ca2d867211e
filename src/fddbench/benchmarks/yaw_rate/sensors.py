"""Sensors of the yaw-rate benchmark: noise added once per sample."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.block import NOTHING
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import Nothing, Row, Rows, record

__all__ = ["PRESETS", "Noise", "Readings", "Sensors"]


@dataclass(frozen=True, kw_only=True)
class Noise:
    """White noise, one sigma per sample.

    Attributes
    ----------
    r_deg_s, p_deg_s : float
        Each yaw-rate sensor, and the roll rate [deg/s].
    beta_deg, phi_deg : float
        Sideslip and bank angle [deg].
    alpha_deg, theta_deg, q_deg_s, n_z_g : float
        Of an aircraft with six degrees of freedom: each incidence and load-factor sensor [deg, g], pitch angle [deg] and pitch
        rate [deg/s].
    """

    r_deg_s: float
    beta_deg: float
    p_deg_s: float
    phi_deg: float
    alpha_deg: float = 0.0
    theta_deg: float = 0.0
    q_deg_s: float = 0.0
    n_z_g: float = 0.0


@record
class SensorDraws:
    """One normal number for each yaw-rate sensor, for sideslip, roll rate and bank angle."""

    r: tuple[Row, ...]
    beta: Row
    p: Row
    phi: Row


@record
class Readings:
    """Yaw rates [deg/s], (n_sensors, n_cases); sideslip [deg], roll rate [deg/s] and bank angle [deg], (n_cases,)."""

    r_deg_s: Rows
    beta_deg: Row
    p_deg_s: Row
    phi_deg: Row


class Sensors:
    """Redundant yaw-rate sensors and single others, as a block without states and constants.

    Parameters
    ----------
    noise : Noise
        How noisy they are.
    n_rates : int
        Yaw-rate sensors; each has a random number of its own for good.
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
            )
        )

    def start(self, c: Nothing) -> Nothing:
        """Nothing to keep."""
        return c

    def step(
        self, x: Nothing, c: Nothing, n: SensorDraws, *, r_deg_s: Row, beta_deg: Row, p_deg_s: Row, phi_deg: Row
    ) -> tuple[Nothing, Readings]:
        """What they read of the true values."""
        del c
        readings = Readings(
            r_deg_s=r_deg_s + self.noise.r_deg_s * np.stack(n.r),
            beta_deg=beta_deg + self.noise.beta_deg * n.beta,
            p_deg_s=p_deg_s + self.noise.p_deg_s * n.p,
            phi_deg=phi_deg + self.noise.phi_deg * n.phi,
        )
        return x, readings


PRESETS: Mapping[str, Noise] = {
    # at 100 Hz; our choice for the reproduction campaigns
    "white": Noise(
        r_deg_s=0.01,
        beta_deg=0.02,
        p_deg_s=0.02,
        phi_deg=0.02,
        alpha_deg=0.02,
        theta_deg=0.02,
        q_deg_s=0.02,
        n_z_g=0.002,
    ),
    "ideal": Noise(r_deg_s=0.0, beta_deg=0.0, p_deg_s=0.0, phi_deg=0.0),
}
"""Sensor sets by their names in campaigns; the first is the default."""
