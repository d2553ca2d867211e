"""Runaway: the sensor drives away at a constant rate until it reaches its stop."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from fddbench.blocks.layout import Rows, record
from fddbench.faults.key_rules import KeyRule, exactly_one
from fddbench.faults.specification import FaultSpecification, Finite
from fddbench.interfaces import Floats, Site

__all__ = ["Runaway"]


@record
class Drive:
    """Slope [unit/s], in the unit of the site."""

    rate: Rows

    def at(self, time_s: Rows) -> Rows:
        """The ramp; where it ends is a matter of the site, whose stops act on everything."""
        return self.rate * time_s


class Runaway(FaultSpecification):
    """A ramp added to the sensor; only the stops of the site end it.

    Attributes
    ----------
    rate_percent_s, rate : float
        Slope, of the admissible range per second [%/s] or in the unit of the sites per second; give one.
    """

    about: ClassVar[str] = "a ramp up to the sensor's range"
    profile = Drive

    kind: Literal["runaway"]
    rate_percent_s: Finite | None = None
    rate: Finite | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one rate."""
        yield from super().key_rules()
        yield exactly_one("rate_percent_s", cls.key("rate"))

    def numbers(self, site: Site, uniform: Floats) -> Drive:
        """Ramp of the given slope."""
        del uniform
        return Drive(rate=self.size("rate", site))
