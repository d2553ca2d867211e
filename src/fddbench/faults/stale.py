"""Stale data: the sensor refreshes its reading too seldom and shows the old one meanwhile."""

from typing import Annotated, Any, ClassVar, Literal

import numpy as np

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.faults.cycle import into_cycle
from fddbench.faults.distortion import Distorting
from fddbench.faults.profile import constants_of
from fddbench.faults.varied import Number
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Stale"]


@record
class Refresh:
    """Samples from one refresh to the next."""

    every_samples: Rows


@record
class Kept:
    """The last fresh reading."""

    reading: Rows


class StaleBlock:
    """The reading of the last refresh; the first one is at the onset."""

    def __init__(self, n_sites: int) -> None:
        self.constants = constants_of(Refresh, n_sites)
        self.states = Layout(Kept(reading=n_sites))

    def start(self, c: Refresh) -> Kept:
        """Nothing kept yet; the onset is a refresh."""
        del c
        return Kept(reading=0.0)

    def step(self, x: Kept, c: Refresh, reading: Rows, now: Instant) -> tuple[Kept, Rows]:
        """What the sites show."""
        fresh = into_cycle(now.since_samples, np.maximum(c.every_samples, 1.0)) == 0.0
        shown = np.where(fresh, reading, x.reading)
        return Kept(reading=shown), shown


class Stale(Distorting):
    """A reading that is refreshed at every n-th sample only, and held between.

    Attributes
    ----------
    every_samples : int
        Samples from one refresh to the next, counted from the onset; 1 is the healthy sensor. Several in a grid sweep it.
    """

    about: ClassVar[str] = "a reading refreshed at every n-th sample"

    kind: Literal["stale"]
    every_samples: Annotated[Any, Number(ge=1.0, whole=True)]

    def numbers(self, site: Site, uniform: Floats) -> Refresh:
        """Its cycle."""
        del site, uniform
        return Refresh(every_samples=self.every_samples)

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> StaleBlock:
        """What flies of it."""
        del sample_s
        return StaleBlock(n_sites)
