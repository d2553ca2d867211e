"""Noise: the sensor turns noisy."""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.faults.key_rules import KeyRule, exactly_one
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import FaultSpecification, NonNegative
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Noise"]


@record
class Sigma:
    """Standard deviation of a sample, in the unit of the site."""

    sigma: Rows


class NoiseBlock:
    """A normal number added at every sample."""

    states: Layout[Any] = NOTHING

    def __init__(self, n_sites: int) -> None:
        self.constants = constants_of(Sigma, n_sites)

    def start(self, c: Sigma) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Sigma, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        return x, reading + now.sign * (c.sigma * now.random)


class Noise(FaultSpecification):
    """White noise added to every sample.

    Attributes
    ----------
    variance_percent, variance : float
        Variance, percent of the *number* of the admissible range (Table 2 of the paper: 1.25 % of 40 is
        0.5 deg^2/s^2) or in the unit of the sites squared; give one.
    """

    about: ClassVar[str] = "white noise on every sample"
    random: ClassVar[bool] = True

    kind: Literal["noise"]
    variance_percent: NonNegative | None = None
    variance: NonNegative | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one variance."""
        yield from super().key_rules()
        yield exactly_one("variance_percent", cls.key("variance"))

    def numbers(self, site: Site, uniform: Floats) -> Sigma:
        """Noise of the given variance."""
        del uniform
        return Sigma(sigma=np.sqrt(self.size("variance", site)))

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> NoiseBlock:
        """What flies of it."""
        del sample_s
        return NoiseBlock(n_sites)
