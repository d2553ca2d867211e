"""Runaway: the sensor drives away at a constant rate until it reaches its stop."""

from typing import Any, ClassVar, Literal

import numpy as np

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import FaultSpecification, Finite
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Runaway"]


@record
class Drive:
    """Slope [unit/s], and the stops of the site in its unit."""

    rate: Rows
    low: Rows
    high: Rows


class RunawayBlock:
    """A ramp added to the reading, the sum clipped at the stops."""

    states: Layout[Any] = NOTHING

    def __init__(self, n_sites: int) -> None:
        self.constants = constants_of(Drive, n_sites)

    def start(self, c: Drive) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Drive, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        driven = reading + now.sign * (c.rate * now.time_s)
        return x, np.minimum(np.maximum(driven, c.low), c.high)


class Runaway(FaultSpecification):
    """A ramp added to the sensor, the sum clipped at the sensor's range.

    Attributes
    ----------
    rate_percent_s, rate : float
        Slope, of the admissible range per second [%/s] or in the unit of the sites per second; give one.
    """

    about: ClassVar[str] = "a ramp up to the sensor's range"

    kind: Literal["runaway"]
    rate_percent_s: Finite | None = None
    rate: Finite | None = None

    def numbers(self, site: Site, uniform: Floats) -> Drive:
        """Ramp of the given slope, clipped at the stops of the site."""
        del uniform
        return Drive(rate=self.size("rate", site), low=site.stops[0], high=site.stops[1])

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> RunawayBlock:
        """What flies of it."""
        del sample_s
        return RunawayBlock(n_sites)
