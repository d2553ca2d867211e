"""Drift: the sensor walks off slowly and stays where it has come to."""

from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, NonNegative
from fddbench.interfaces import FaultUnits

__all__ = ["Drift"]


class Drift(FaultSpecification):
    """A ramp added to the sensor that stops at a final size.

    Attributes
    ----------
    rate_percent_s, rate : float
        Slope, of the admissible range per second [%/s] or in the unit of the sites per second; give one.
    amplitude_percent, amplitude : float
        Size at which the ramp stops, not negative [%] or in the unit of the sites; give one.
    """

    about: ClassVar[str] = "a ramp that stops at a final size"

    kind: Literal["drift"]
    mode: Literal["add"] = "add"
    rate_percent_s: Finite | None = None
    rate: Finite | None = None
    amplitude_percent: NonNegative | None = None
    amplitude: NonNegative | None = None

    def wave(self, units: FaultUnits) -> FaultWave:
        """Ramp of the given slope up to the given size."""
        return FaultWave(
            rate=self.size("rate", "rate_percent_s", units),
            ramp_limit=self.size("amplitude", "amplitude_percent", units),
        )
