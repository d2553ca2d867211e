"""Runaway: the sensor drives away at a constant rate until it reaches its stop."""

from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Runaway"]


class Runaway(FaultSpecification):
    """A ramp added to the sensor, the sum clipped at the sensor's range.

    Attributes
    ----------
    rate_percent_s, rate_deg_s2 : float
        Slope, of the admissible range per second [%/s] or in [deg/s^2]; give one.
    """

    about: ClassVar[str] = "a ramp up to the sensor's range"

    kind: Literal["runaway"]
    rate_percent_s: Finite | None = None
    rate_deg_s2: Finite | None = None

    def wave(self, units: SensorUnits) -> FaultWave:
        """Ramp of the given slope, clipped at the sensor's range."""
        percent = None if self.rate_percent_s is None else self.rate_percent_s / 100.0 * units.admissible_deg_s
        return FaultWave(
            **self.base(units),
            rate_deg_s2=one_of(rate_percent_s=percent, rate_deg_s2=self.rate_deg_s2),
            clip_deg_s=units.sensor_range_deg_s,
        )
