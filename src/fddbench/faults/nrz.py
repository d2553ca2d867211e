"""NRZ: a non-return-to-zero bit stream on the sensor."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Nrz"]


class Nrz(FaultSpecification):
    """Random plus or minus a size, drawn anew every bit (a corrupted digital word).

    Attributes
    ----------
    amplitude_percent, amplitude_deg_s : float
        Size of a bit, of the admissible range [%] or in [deg/s]; give one.
    bit_s : float
        Length of a bit [s]; our choice of 0.05 s where the paper is silent.
    """

    about: ClassVar[str] = "random plus or minus a size, bit by bit"

    kind: Literal["nrz"]
    amplitude_percent: Finite | None = None
    amplitude_deg_s: Finite | None = None
    bit_s: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 0.05

    def wave(self, units: SensorUnits) -> FaultWave:
        """Bit stream of the given size."""
        percent = None if self.amplitude_percent is None else self.amplitude_percent / 100.0 * units.admissible_deg_s
        size = one_of(amplitude_percent=percent, amplitude_deg_s=self.amplitude_deg_s)
        return FaultWave(**self.base(units), bit_deg_s=size, bit_s=self.bit_s)
