"""Spike: short pulses on the sensor, one or again and again."""

from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.faults.cycle import into_cycle, whole_samples
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import Time, WithAmplitude
from fddbench.faults.varied import bounds, in_words
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Spike"]

_NEVER_AGAIN_S = 1e9
"""Period of a pulse that stays the only one; longer than any flight."""


@record
class Pulses:
    """Size of a pulse, in the unit of the site, its width and the period [s]."""

    size: Rows
    width_s: Rows
    period_s: Rows


class SpikeBlock:
    """A size added for the first samples of every period, from the onset on."""

    states: Layout[Any] = NOTHING

    def __init__(self, n_sites: int, sample_s: float) -> None:
        self.sample_s = sample_s
        self.constants = constants_of(Pulses, n_sites)

    def start(self, c: Pulses) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Pulses, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        place = into_cycle(now.since_samples, whole_samples(c.period_s, self.sample_s))
        within = place < whole_samples(c.width_s, self.sample_s)
        return x, np.where(within, reading + now.sign * c.size, reading)


class Spike(WithAmplitude):
    """A short pulse added to the sensor at the onset, and again every period.

    The site counts as faulty from its onset to its end, between the pulses too.

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Height of a pulse, of the admissible range [%] or in the unit of the sites; give one.
    width_s : float
        Length of a pulse, a whole number of samples, at least one [s].
    period_s : float or None
        From the beginning of one pulse to that of the next, longer than a pulse [s]; None: one pulse only.
    """

    about: ClassVar[str] = "short pulses, one or periodic"
    lengths: ClassVar[tuple[str, ...]] = ("width_s", "period_s")

    kind: Literal["spike"]
    width_s: Time
    period_s: Time | None = None

    @model_validator(mode="after")
    def _apart(self) -> Self:
        if self.period_s is not None and bounds(self.width_s)[1] >= bounds(self.period_s)[0]:
            raise ValueError(
                f"pulses need a period_s longer than width_s, got period_s {in_words(self.period_s)} and width_s "
                f"{in_words(self.width_s)}; pulses that touch are a bias"
            )
        return self

    def numbers(self, site: Site, uniform: Floats) -> Pulses:
        """Pulses of the given size."""
        del uniform
        period_s = _NEVER_AGAIN_S if self.period_s is None else self.period_s
        return Pulses(size=self.size("amplitude", site), width_s=self.width_s, period_s=period_s)

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> SpikeBlock:
        """What flies of it."""
        return SpikeBlock(n_sites, sample_s)
