"""Sensors whose errors are drawn: inertial units beside each other, a sideslip vane that lags, an airspeed that is off."""

from typing import Any

import numpy as np

from fddbench.benchmarks.yaw_rate.inertial import Attitude, InertialUnits, UnitDraws, cut
from fddbench.benchmarks.yaw_rate.sensors import Noise, Readings, SensorErrors, Sensors
from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Row, record
from fddbench.flight.atmosphere import KT_M_S

__all__ = ["UnitSensors", "sensors_of"]


@record
class UnitSensorState:
    """What inertial units have not shown yet, and the sideslip behind its lag [deg]."""

    units: Attitude
    beta_deg: Row


@record
class UnitSensorConstants:
    """Errors of the units, of the sideslip [deg] and of the airspeed [m/s]."""

    units: Any
    beta_bias_deg: Row
    v_tas_error_m_s: Row


@record
class UnitSensorDraws:
    """One normal number for each yaw-rate sensor and for sideslip, the same as without units; and those of the units."""

    r: tuple[Row, ...]
    beta: Row
    units: UnitDraws


@record
class UnitSensorNormals:
    """Before the first sample: of the units, and of sideslip and airspeed."""

    units: Any
    beta: Row
    v_tas: Row


class UnitSensors:
    """Inertial units, a sideslip vane that lags, and an airspeed that is off.

    Parameters
    ----------
    noise : Noise
        How noisy they are.
    errors : SensorErrors
        What else is wrong with them.
    n_rates : int
        Units.
    sample_s : float
        Sample time [s].
    """

    def __init__(self, noise: Noise, errors: SensorErrors, n_rates: int, sample_s: float) -> None:
        self.noise, self.errors, self.n_rates, self.n_units = noise, errors, n_rates, n_rates
        self.units = InertialUnits(
            errors.units,
            rate_noise_deg_s=(noise.r_deg_s, noise.p_deg_s),
            bank_noise_deg=noise.phi_deg,
            n_units=n_rates,
            sample_s=sample_s,
        )
        self.keeps = float(exp(np.array(-sample_s / errors.beta_lag_s))) if errors.beta_lag_s else 0.0
        self.states = Layout(UnitSensorState(units=self.units.states.shape, beta_deg=ROW))
        self.constants = Layout(
            UnitSensorConstants(units=self.units.constants.shape, beta_bias_deg=ROW, v_tas_error_m_s=ROW)
        )
        self.draws: Draws[UnitSensorDraws] = Draws(
            UnitSensorDraws(
                r=tuple(Draw(*consumers.sensor_number(j)) for j in range(n_rates)),
                beta=Draw(consumers.SENSORS_A, 3),
                units=self.units.draws.names,
            )
        )
        self.before: Draws[UnitSensorNormals] = Draws(
            UnitSensorNormals(
                units=self.units.before.names,
                beta=Draw(consumers.SENSORS_START, 0),
                v_tas=Draw(consumers.SENSORS_START, 1),
            )
        )

    def prepare(self, normals: UnitSensorNormals) -> UnitSensorConstants:
        """Errors of flights."""
        return UnitSensorConstants(
            units=self.units.prepare(normals.units),
            beta_bias_deg=self.errors.beta_bias_deg * cut(normals.beta),
            v_tas_error_m_s=KT_M_S * self.errors.v_tas_bias_kt * cut(normals.v_tas),
        )

    def start(self, c: UnitSensorConstants) -> UnitSensorState:
        """Level flight before sample 0."""
        return UnitSensorState(units=self.units.start(c.units), beta_deg=0.0)

    def step(
        self,
        x: UnitSensorState,
        c: UnitSensorConstants,
        n: UnitSensorDraws,
        sample: Row,
        *,
        r_deg_s: Row,
        beta_deg: Row,
        p_deg_s: Row,
        phi_deg: Row,
    ) -> tuple[UnitSensorState, Readings]:
        """What is kept, and what they read of the true values; the vane begins without a lag behind the first gust."""
        true = Attitude(phi_deg=phi_deg, p_deg_s=p_deg_s, r_deg_s=r_deg_s)
        units, read = self.units.step(x.units, c.units, n.units, true, n.r)
        lagged = np.where(sample > 0.0, beta_deg + self.keeps * (x.beta_deg - beta_deg), beta_deg)
        readings = Readings(
            r_deg_s=read.r_deg_s,
            beta_deg=lagged + c.beta_bias_deg + self.noise.beta_deg * n.beta,
            p_deg_s=read.p_deg_s,
            phi_deg=read.phi_deg,
            v_tas_error_m_s=c.v_tas_error_m_s,
        )
        return UnitSensorState(units=units, beta_deg=lagged), readings


def sensors_of(noise: Noise, n_rates: int, sample_s: float) -> Sensors | UnitSensors:
    """The block that a preset describes; one from a file may have nothing but its noise."""
    errors: SensorErrors | None = getattr(noise, "errors", None)
    return Sensors(noise, n_rates) if errors is None else UnitSensors(noise, errors, n_rates, sample_s)
