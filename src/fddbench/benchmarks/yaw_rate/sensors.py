"""Sensors of the yaw-rate benchmark: noise added once per sample, or inertial units and air data with drawn errors."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.inertial import InertialErrors
from fddbench.blocks import consumers
from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import Nothing, Row, Rows, record

__all__ = ["PRESETS", "Noise", "Readings", "SensorErrors", "Sensors"]


@dataclass(frozen=True, kw_only=True)
class SensorErrors:
    """Errors that a flight draws once, the same in every scenario; one sigma each, cut at three.

    Attributes
    ----------
    units : InertialErrors
        Of the inertial units, one beside each yaw-rate sensor.
    beta_bias_deg, beta_lag_s : float
        Of the sideslip vane: bias [deg], and time constant of its first-order lag [s], which every flight has.
    v_tas_bias_kt : float
        Of the true airspeed [kt].
    """

    units: InertialErrors
    beta_bias_deg: float
    beta_lag_s: float
    v_tas_bias_kt: float


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
    errors : SensorErrors, optional
        Then bank angle, roll rate and yaw rate come of inertial units, as many as there are yaw-rate sensors; bank angle and
        roll rate are voted too, and are fault sites. None: noise is all there is.
    """

    r_deg_s: float
    beta_deg: float
    p_deg_s: float
    phi_deg: float
    alpha_deg: float = 0.0
    theta_deg: float = 0.0
    q_deg_s: float = 0.0
    n_z_g: float = 0.0
    errors: SensorErrors | None = None


@record
class SensorDraws:
    """One normal number for each yaw-rate sensor, for sideslip, roll rate and bank angle."""

    r: tuple[Row, ...]
    beta: Row
    p: Row
    phi: Row


@record
class Readings:
    """Yaw rates [deg/s], (n_sensors, n_cases); sideslip [deg], roll rate [deg/s] and bank angle [deg], (n_cases,).

    Of inertial units roll rates and bank angles are (n_sensors, n_cases). `v_tas_error_m_s` is to be added to the airspeed.
    """

    r_deg_s: Rows
    beta_deg: Row
    p_deg_s: Any
    phi_deg: Any
    v_tas_error_m_s: Row


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
    before: Draws[Any] = NO_DRAWS
    n_units = 0

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

    def prepare(self, normals: Nothing) -> Nothing:
        """No constants."""
        return normals

    def start(self, c: Nothing) -> Nothing:
        """Nothing to keep."""
        return c

    def step(
        self,
        x: Nothing,
        c: Nothing,
        n: SensorDraws,
        sample: Row,
        *,
        r_deg_s: Row,
        beta_deg: Row,
        p_deg_s: Row,
        phi_deg: Row,
    ) -> tuple[Nothing, Readings]:
        """What they read of the true values."""
        del c, sample
        readings = Readings(
            r_deg_s=r_deg_s + self.noise.r_deg_s * np.stack(n.r),
            beta_deg=beta_deg + self.noise.beta_deg * n.beta,
            p_deg_s=p_deg_s + self.noise.p_deg_s * n.p,
            phi_deg=phi_deg + self.noise.phi_deg * n.phi,
            v_tas_error_m_s=0.0,
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
    # ours, of three inertial units with drawn errors; labels 330 and 327 of ARINC 429 have 13 bits of 128 deg/s, label 325 has
    # 14 of 180 deg (to be confirmed against the specification)
    "iru": Noise(
        r_deg_s=0.01,
        beta_deg=0.1,
        p_deg_s=0.01,
        phi_deg=0.01,
        alpha_deg=0.02,
        theta_deg=0.02,
        q_deg_s=0.02,
        n_z_g=0.002,
        errors=SensorErrors(
            units=InertialErrors(
                rate_bias_deg_s=0.02,
                rate_scale_percent=0.1,
                misalignment_deg=0.1,
                bank_bias_deg=0.1,
                rate_quantum_deg_s=128.0 / 2**13,
                bank_quantum_deg=180.0 / 2**14,
                rate_most_deg_s=128.0,
                bank_most_deg=180.0,
                latency_s=(0.005, 0.020),
            ),
            beta_bias_deg=0.3,
            beta_lag_s=0.1,
            v_tas_bias_kt=2.0,
        ),
    ),
}
"""Sensor sets by their names in campaigns; the first is the default."""
