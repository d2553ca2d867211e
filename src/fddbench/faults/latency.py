"""Latency: the sensor shows what it read some time ago."""

from collections.abc import Iterator, Sequence
from typing import ClassVar, Literal, Self

import numpy as np

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.blocks.primitives import pick
from fddbench.blocks.ring import ring
from fddbench.clock import samples
from fddbench.faults.cycle import into_cycle
from fddbench.faults.distortion import Distorting
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import Time
from fddbench.faults.timing import misfits
from fddbench.faults.varied import bounds, in_words
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Latency"]

MOST_SAMPLES = 1000
"""Longest latency that is kept [samples]."""


@record
class Delay:
    """Latency [s]."""

    latency_s: Rows


@record
class Past:
    """First reading of the flight, and the readings of the last samples, one ring a site."""

    first: Rows
    rings: tuple[Rows, ...]


class LatencyBlock:
    """The reading of some samples ago; before there is one, the first.

    Every ring is as deep as the longest latency that will fly. Where that is the only one the oldest reading is shown,
    otherwise the one of each flight is picked out.
    """

    def __init__(self, n_sites: int, sample_s: float, *, longest: int, only: bool) -> None:
        self.sample_s, self.depth, self.only = sample_s, longest, only
        self.constants = constants_of(Delay, n_sites)
        self.states = Layout(Past(first=n_sites, rings=(longest,) * n_sites))

    def start(self, c: Delay) -> Past:
        """Nothing read yet."""
        del c
        return Past(first=0.0, rings=tuple(0.0 for _ in self.states.shape.rings))

    def step(self, x: Past, c: Delay, reading: Rows, now: Instant) -> tuple[Past, Rows]:
        """What the sites show."""
        first = np.where(now.sample == 0.0, reading, x.first)
        ago = np.rint(c.latency_s / self.sample_s)
        rings, shown = [], []
        for row, kept in enumerate(x.rings):
            after, oldest = ring(kept, reading[row], now.sample)
            rings.append(after)
            shown.append(oldest if self.only else self._picked(kept, ago[row], now.sample))
        past = np.where(now.sample >= ago, np.stack(shown), first)
        return Past(first=first, rings=tuple(rings)), np.where(ago > 0.0, past, reading)

    def _picked(self, kept: Rows, ago: Rows, sample: Rows) -> Rows:
        """The reading of so many samples ago, as the ring was before this sample is written."""
        return pick(into_cycle(sample - ago, float(self.depth)), *kept)


class Latency(Distorting):
    """The reading comes late: from the onset on the site shows what it read a constant time before.

    Attributes
    ----------
    latency_s : float
        How late, a whole number of samples, at most 1000 of them [s]; 0 is the healthy sensor. Not `delay_s`, which is from
        site to site.
    """

    about: ClassVar[str] = "a reading that comes late"

    kind: Literal["latency"]
    latency_s: Time

    @property
    def times(self) -> tuple[str, ...]:
        """Fields that are times on the clock."""
        return (*super().times, "latency_s")

    def unfit(self, sample_s: float) -> Iterator[tuple[str, str]]:
        """What the clock cannot show, and what is too late to be kept."""
        yield from super().unfit(sample_s)
        yield from (("latency_s", f"latency_s {wrong}") for wrong in misfits(self.latency_s, sample_s))
        if bounds(self.latency_s)[1] > MOST_SAMPLES * sample_s:
            most = f"at most {MOST_SAMPLES * sample_s:g} s at sample_s {sample_s:g}, {MOST_SAMPLES} samples"
            yield "latency_s", f"latency_s is {most}, got {in_words(self.latency_s)}; a signal so late is a freeze"

    def numbers(self, site: Site, uniform: Floats) -> Delay:
        """How late."""
        del site, uniform
        return Delay(latency_s=self.latency_s)

    @classmethod
    def block_for(cls, faults: Sequence[Self], n_sites: int, sample_s: float) -> LatencyBlock:
        """What flies of these: rings as deep as the longest latency needs."""
        each = {samples(end, sample_s) for fault in faults for end in bounds(fault.latency_s)}
        return LatencyBlock(n_sites, sample_s, longest=max(each | {1}), only=len(each) == 1)

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> LatencyBlock:
        """One that could keep the longest latency there is."""
        return LatencyBlock(n_sites, sample_s, longest=MOST_SAMPLES, only=False)
