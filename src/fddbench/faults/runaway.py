"""Runaway: the sensor drives away at a constant rate until it reaches its stop."""

from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite
from fddbench.interfaces import FaultUnits

__all__ = ["Runaway"]


class Runaway(FaultSpecification):
    """A ramp added to the sensor, the sum clipped at the sensor's range.

    Attributes
    ----------
    rate_percent_s, rate : float
        Slope, of the admissible range per second [%/s] or in the unit of the sites per second; give one.
    """

    about: ClassVar[str] = "a ramp up to the sensor's range"

    kind: Literal["runaway"]
    rate_percent_s: Finite | None = None
    rate: Finite | None = None

    def wave(self, units: FaultUnits) -> FaultWave:
        """Ramp of the given slope, clipped at the sensor's range."""
        return FaultWave(
            **self.base(units),
            rate=self.size("rate", "rate_percent_s", units),
            clip=units.sensor_range,
        )
