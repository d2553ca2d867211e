"""Bias: the sensor is off by a constant from the onset on."""

from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite
from fddbench.interfaces import FaultUnits

__all__ = ["Bias"]


class Bias(FaultSpecification):
    """A constant added to the sensor.

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Size, of the admissible range [%] or in the unit of the sites; give one.
    """

    about: ClassVar[str] = "a constant added to the sensor"

    kind: Literal["bias"]
    mode: Literal["add"] = "add"
    amplitude_percent: Finite | None = None
    amplitude: Finite | None = None

    def wave(self, units: FaultUnits) -> FaultWave:
        """Offset of the given size."""
        return FaultWave(offset=self.size("amplitude", "amplitude_percent", units))
