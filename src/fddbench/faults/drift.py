"""Drift: the sensor walks off slowly and stays where it has come to."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from fddbench.blocks.layout import Rows, record
from fddbench.faults.key_rules import KeyRule, exactly_one
from fddbench.faults.specification import FaultSpecification, Finite, NonNegative
from fddbench.interfaces import Floats, Site

__all__ = ["Drift"]


@record
class Ramp:
    """Slope [unit/s], and the size at which it stops, in the unit of the site."""

    rate: Rows
    limit: Rows

    def at(self, time_s: Rows) -> Rows:
        """The ramp, no larger than its limit."""
        return np.minimum(np.maximum(self.rate * time_s, -self.limit), self.limit)


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
    profile = Ramp

    kind: Literal["drift"]
    mode: Literal["add"] = "add"
    rate_percent_s: Finite | None = None
    rate: Finite | None = None
    amplitude_percent: NonNegative | None = None
    amplitude: NonNegative | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one rate, and one final size."""
        yield from super().key_rules()
        yield exactly_one("rate_percent_s", cls.key("rate"))
        yield exactly_one("amplitude_percent", cls.key("amplitude"))

    def numbers(self, site: Site, uniform: Floats) -> Ramp:
        """Ramp of the given slope up to the given size."""
        del uniform
        return Ramp(rate=self.size("rate", site), limit=self.size("amplitude", site))
