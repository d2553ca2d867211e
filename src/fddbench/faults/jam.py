"""Jam: the sensor stands off by a constant, or stands still."""

from dataclasses import replace
from typing import ClassVar, Literal

from fddbench.faults.specification import FaultSpecification, FaultWave, Finite, SensorUnits, one_of

__all__ = ["Jam"]


class Jam(FaultSpecification):
    """A constant added to the sensor (the published case), or the sensor standing at a value.

    Attributes
    ----------
    amplitude_percent, amplitude_deg_s : float
        Offset with ``mode: add``, of the admissible range [%] or in [deg/s]; give one. With ``mode: replace`` give
        ``freeze: true`` or a ``hold_value_*`` instead.
    """

    about: ClassVar[str] = "a constant offset (add) or a stuck sensor (replace)"

    kind: Literal["jam"]
    amplitude_percent: Finite | None = None
    amplitude_deg_s: Finite | None = None

    def wave(self, units: SensorUnits) -> FaultWave:
        """Offset, or the held value alone."""
        if self.mode == "replace":
            if self.amplitude_percent is not None or self.amplitude_deg_s is not None:
                raise ValueError("a jam with mode: replace stands at hold_value_* or freezes; remove the amplitude")
            if not self.freeze and self.hold_value_deg_s is None and self.hold_value_percent is None:
                raise ValueError("a jam with mode: replace needs freeze: true | hold_value_deg_s | hold_value_percent")
            return FaultWave(**self.base(units))
        percent = None if self.amplitude_percent is None else self.amplitude_percent / 100.0 * units.admissible_deg_s
        offset = one_of(amplitude_percent=percent, amplitude_deg_s=self.amplitude_deg_s)
        return replace(FaultWave(), offset_deg_s=offset)
