"""Bias: the sensor is off by a constant from the onset on."""

from dataclasses import replace
from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Bias"]


class Bias(FaultSpecification):
    """A constant added to the sensor.

    Attributes
    ----------
    amplitude_percent, amplitude_deg_s : float
        Size, of the admissible range [%] or in [deg/s]; give one.
    """

    about: ClassVar[str] = "a constant added to the sensor"

    kind: Literal["bias"]
    mode: Literal["add"] = "add"
    amplitude_percent: Finite | None = None
    amplitude_deg_s: Finite | None = None

    def wave(self, units: SensorUnits) -> FaultWave:
        """Offset of the given size."""
        percent = None if self.amplitude_percent is None else self.amplitude_percent / 100.0 * units.admissible_deg_s
        offset = one_of(amplitude_percent=percent, amplitude_deg_s=self.amplitude_deg_s)
        return replace(FaultWave(), offset_deg_s=offset)
