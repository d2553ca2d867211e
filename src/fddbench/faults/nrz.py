"""NRZ: a non-return-to-zero bit stream on the sensor."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite
from fddbench.interfaces import FaultUnits

__all__ = ["Nrz"]


class Nrz(FaultSpecification):
    """Random plus or minus a size, drawn anew every bit (a corrupted digital word).

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Size of a bit, of the admissible range [%] or in the unit of the sites; give one.
    bit_s : float
        Length of a bit [s]; our choice of 0.05 s where the paper is silent.
    """

    about: ClassVar[str] = "random plus or minus a size, bit by bit"

    kind: Literal["nrz"]
    amplitude_percent: Finite | None = None
    amplitude: Finite | None = None
    bit_s: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 0.05

    def wave(self, units: FaultUnits) -> FaultWave:
        """Bit stream of the given size."""
        size = self.size("amplitude", "amplitude_percent", units)
        return FaultWave(**self.base(units), bit=size, bit_s=self.bit_s)
