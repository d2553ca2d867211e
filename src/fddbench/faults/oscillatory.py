"""Oscillatory failure: a sine on the sensor."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import model_validator

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Oscillatory"]


class Oscillatory(FaultSpecification):
    """A sine added to the sensor (liquid), or put in its place (solid).

    Attributes
    ----------
    amplitude_percent, amplitude_deg_s : float
        Half of the peak-to-peak excursion, of the admissible range [%] or in [deg/s]; give one.
    frequency_hz, frequency_rad_s : float
        Frequency; give one.
    phase_rad : float
        Phase at the onset [rad].
    phase : "uniform"
        Draws the phase per case instead.
    """

    about: ClassVar[str] = "a sine on the sensor"

    kind: Literal["oscillatory"]
    amplitude_percent: Finite | None = None
    amplitude_deg_s: Finite | None = None
    frequency_hz: Finite | None = None
    frequency_rad_s: Finite | None = None
    phase_rad: Finite | None = None
    phase: Literal["uniform"] | None = None

    @model_validator(mode="after")
    def _one_phase(self) -> "Oscillatory":
        if self.phase is not None and self.phase_rad is not None:
            raise ValueError("give phase_rad or phase: uniform, not both")
        return self

    def wave(self, units: SensorUnits) -> FaultWave:
        """Sine of the given size."""
        percent = None if self.amplitude_percent is None else self.amplitude_percent / 100.0 * units.admissible_deg_s
        turns = None if self.frequency_hz is None else 2.0 * np.pi * self.frequency_hz
        return FaultWave(
            **self.base(units),
            amplitude_deg_s=one_of(amplitude_percent=percent, amplitude_deg_s=self.amplitude_deg_s),
            frequency_rad_s=one_of(frequency_hz=turns, frequency_rad_s=self.frequency_rad_s),
            phase_rad=self.phase_rad or 0.0,
            phase_uniform=float(self.phase == "uniform"),
        )
