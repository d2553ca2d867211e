"""Sensors of the longitudinal benchmark: errors that stay for a flight, and noise once per sample."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from fddbench.blocks import consumers
from fddbench.blocks.block import NOTHING
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, record
from fddbench.interfaces import Floats

__all__ = ["PRESETS", "SIGNALS", "Noise", "SensorErrors", "Sensors"]

SIGNALS = (
    "alpha_deg", "q_deg_s", "v_tas_m_s", "theta_deg", "altitude_m", "gamma_deg", "acceleration_m_s2",
    "elevator_deg", "stabiliser_deg", "thrust_n",
)  # fmt: skip
"""What is measured: angle of attack and airspeed through the air; pitch, flight path and acceleration along it by inertial
navigation; the last three are outputs of actuators."""


@dataclass(frozen=True, kw_only=True)
class Noise:
    """White noise, one sigma per sample, in the units of the names (see `SIGNALS`)."""

    alpha_deg: float
    q_deg_s: float
    v_tas_m_s: float
    theta_deg: float
    altitude_m: float
    gamma_deg: float
    acceleration_m_s2: float
    elevator_deg: float
    stabiliser_deg: float
    thrust_n: float


@record
class SensorErrors:
    """What is added to angle of attack, pitch rate, pitch angle and altitude, and the factor on airspeed."""

    alpha_deg: Row
    q_deg_s: Row
    v_tas_ratio: Row
    theta_deg: Row
    altitude_m: Row


@record
class SensorDraws:
    """One normal number for each signal."""

    alpha_deg: Row
    q_deg_s: Row
    v_tas_m_s: Row
    theta_deg: Row
    altitude_m: Row
    gamma_deg: Row
    acceleration_m_s2: Row
    elevator_deg: Row
    stabiliser_deg: Row
    thrust_n: Row


class Sensors:
    """One sensor for each signal, as a block without states.

    Parameters
    ----------
    noise : Noise
        How noisy they are.
    """

    states: Layout[Any] = NOTHING
    constants = Layout(SensorErrors(alpha_deg=ROW, q_deg_s=ROW, v_tas_ratio=ROW, theta_deg=ROW, altitude_m=ROW))
    draws: Draws[SensorDraws] = Draws(
        SensorDraws(
            alpha_deg=Draw(consumers.SENSORS_A, 0),
            q_deg_s=Draw(consumers.SENSORS_A, 1),
            v_tas_m_s=Draw(consumers.SENSORS_A, 2),
            theta_deg=Draw(consumers.SENSORS_A, 3),
            altitude_m=Draw(consumers.SENSORS_B, 0),
            acceleration_m_s2=Draw(consumers.SENSORS_B, 1),
            elevator_deg=Draw(consumers.SENSORS_B, 2),
            stabiliser_deg=Draw(consumers.SENSORS_B, 3),
            thrust_n=Draw(consumers.SENSORS_C, 0),
            gamma_deg=Draw(consumers.SENSORS_C, 1),
        )
    )

    def __init__(self, noise: Noise) -> None:
        self.noise = noise

    def prepare(self, parameters: Mapping[str, Floats]) -> SensorErrors:
        """Errors of flights."""
        return SensorErrors(
            alpha_deg=parameters["alpha_error_deg"],
            q_deg_s=parameters["q_error_deg_s"],
            v_tas_ratio=1.0 + 0.01 * parameters["v_tas_error_percent"],
            theta_deg=parameters["theta_error_deg"],
            altitude_m=parameters["altitude_error_m"],
        )

    def step(
        self, x: Nothing, c: SensorErrors, n: SensorDraws, true: Mapping[str, Row]
    ) -> tuple[Nothing, SimpleNamespace]:
        """What they read of the true values of `SIGNALS`."""
        shown = {
            **true,
            "alpha_deg": true["alpha_deg"] + c.alpha_deg,
            "q_deg_s": true["q_deg_s"] + c.q_deg_s,
            "v_tas_m_s": true["v_tas_m_s"] * c.v_tas_ratio,
            "theta_deg": true["theta_deg"] + c.theta_deg,
            "altitude_m": true["altitude_m"] + c.altitude_m,
        }
        noisy = {name: shown[name] + getattr(self.noise, name) * getattr(n, name) for name in SIGNALS}
        return x, SimpleNamespace(**noisy)


_IDEAL = Noise(
    alpha_deg=0.0, q_deg_s=0.0, v_tas_m_s=0.0, theta_deg=0.0, altitude_m=0.0, gamma_deg=0.0,
    acceleration_m_s2=0.0, elevator_deg=0.0, stabiliser_deg=0.0, thrust_n=0.0,
)  # fmt: skip

PRESETS: Mapping[str, Noise] = {
    # "the sensors are considered ideal", section V
    "ideal": _IDEAL,
    # ours, of inertial and air-data sensors after their filters; positions and thrust are read without noise
    "white": Noise(
        alpha_deg=0.02, q_deg_s=0.005, v_tas_m_s=0.05, theta_deg=0.005, altitude_m=0.2, gamma_deg=0.005,
        acceleration_m_s2=0.005, elevator_deg=0.0, stabiliser_deg=0.0, thrust_n=0.0,
    ),
    # ours: vane, rate gyro and air data as they are, position transducers, and a thrust computed from pressures
    "realistic": Noise(
        alpha_deg=0.1, q_deg_s=0.02, v_tas_m_s=0.2, theta_deg=0.02, altitude_m=1.0, gamma_deg=0.02,
        acceleration_m_s2=0.02, elevator_deg=0.02, stabiliser_deg=0.01, thrust_n=100.0,
    ),
}  # fmt: skip
"""Sensor sets by their names in campaigns; the first is the default."""
