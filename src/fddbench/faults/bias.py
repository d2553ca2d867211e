"""Bias: the sensor is off by a constant from the onset on."""

from typing import ClassVar, Literal

from fddbench.blocks.layout import Rows, record
from fddbench.faults.specification import WithAmplitude
from fddbench.interfaces import Floats, Site

__all__ = ["Bias", "Offset"]


@record
class Offset:
    """A constant in the unit of the site."""

    offset: Rows

    def at(self, time_s: Rows) -> Rows:
        """The constant, whatever the time."""
        del time_s
        return self.offset


class Bias(WithAmplitude):
    """A constant added to the sensor.

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Size, of the admissible range [%] or in the unit of the sites; give one.
    """

    about: ClassVar[str] = "a constant added to the sensor"
    profile = Offset

    kind: Literal["bias"]
    mode: Literal["add"] = "add"

    def numbers(self, site: Site, uniform: Floats) -> Offset:
        """Offset of the given size."""
        del uniform
        return Offset(offset=self.size("amplitude", site))
