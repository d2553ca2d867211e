"""NRZ: a non-return-to-zero bit stream on the sensor."""

from typing import ClassVar, Literal

import numpy as np

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.faults.cycle import into_cycle, whole_samples
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import Time, WithAmplitude
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Nrz"]


@record
class Bits:
    """Size of a bit, in the unit of the site, and its length [s]."""

    size: Rows
    bit_s: Rows


@record
class BitState:
    """The bit that stands, +1 or -1."""

    bit: Rows


class NrzBlock:
    """Plus or minus a size, drawn anew at every bit; a bit lasts whole samples."""

    def __init__(self, n_sites: int, sample_s: float) -> None:
        self.sample_s = sample_s
        self.constants = constants_of(Bits, n_sites)
        self.states = Layout(BitState(bit=n_sites))

    def start(self, c: Bits) -> BitState:
        """No bit yet."""
        del c
        return BitState(bit=0.0)

    def step(self, x: BitState, c: Bits, reading: Rows, now: Instant) -> tuple[BitState, Rows]:
        """What the sites show."""
        begins = into_cycle(now.since_samples, whole_samples(c.bit_s, self.sample_s)) == 0.0
        bit = np.where(begins, np.where(now.random >= 0.0, 1.0, -1.0), x.bit)
        return BitState(bit=bit), reading + now.sign * (c.size * bit)


class Nrz(WithAmplitude):
    """Random plus or minus a size, drawn anew every bit (a corrupted digital word).

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Size of a bit, of the admissible range [%] or in the unit of the sites; give one.
    bit_s : float
        Length of a bit, a whole number of samples, at least one [s]; our choice of 0.05 s where the paper is silent.
    """

    about: ClassVar[str] = "random plus or minus a size, bit by bit"
    random: ClassVar[bool] = True
    lengths: ClassVar[tuple[str, ...]] = ("bit_s",)

    kind: Literal["nrz"]
    bit_s: Time = 0.05

    def numbers(self, site: Site, uniform: Floats) -> Bits:
        """Bit stream of the given size."""
        del uniform
        return Bits(size=self.size("amplitude", site), bit_s=self.bit_s)

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> NrzBlock:
        """What flies of it."""
        return NrzBlock(n_sites, sample_s)
