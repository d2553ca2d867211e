"""Drift: the sensor walks off slowly and stays where it has come to."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Drift"]


class Drift(FaultSpecification):
    """A ramp added to the sensor that stops at a final size.

    Attributes
    ----------
    rate_percent_s, rate_deg_s2 : float
        Slope, of the admissible range per second [%/s] or in [deg/s^2]; give one.
    amplitude_percent, amplitude_deg_s : float
        Size at which the ramp stops, not negative [%] or [deg/s]; give one.
    """

    about: ClassVar[str] = "a ramp that stops at a final size"

    kind: Literal["drift"]
    mode: Literal["add"] = "add"
    rate_percent_s: Finite | None = None
    rate_deg_s2: Finite | None = None
    amplitude_percent: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] | None = None
    amplitude_deg_s: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] | None = None

    def wave(self, units: SensorUnits) -> FaultWave:
        """Ramp of the given slope up to the given size."""
        scale = units.admissible_deg_s / 100.0
        rate = None if self.rate_percent_s is None else self.rate_percent_s * scale
        size = None if self.amplitude_percent is None else self.amplitude_percent * scale
        return FaultWave(
            rate_deg_s2=one_of(rate_percent_s=rate, rate_deg_s2=self.rate_deg_s2),
            ramp_limit_deg_s=one_of(amplitude_percent=size, amplitude_deg_s=self.amplitude_deg_s),
        )
