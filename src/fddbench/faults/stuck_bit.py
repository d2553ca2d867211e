"""Stuck bit: one bit of the digital word that a sensor sends stands at 0 or at 1."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np

from fddbench.blocks.layout import Rows, record
from fddbench.faults.distortion import Distorting
from fddbench.faults.key_rules import KeyRule, exactly_one
from fddbench.faults.quantisation import count_of
from fddbench.faults.specification import Positive
from fddbench.faults.varied import Number
from fddbench.interfaces import Floats, Site

__all__ = ["StuckBit"]


@record
class Bit:
    """Quantum, in the unit of the site; weight of the bit in quanta, 0 where none is stuck, and where it stands."""

    quantum: Rows
    weight: Rows
    value: Rows

    def of(self, reading: Rows, sign: Rows) -> Rows:
        """The reading with what the bit changes; where the bit already stands so, every bit of the reading is left."""
        del sign
        there = self.weight > 0.0
        quantum, weight = np.where(there, self.quantum, 1.0), np.where(there, self.weight, 1.0)
        # floor makes it two's complement: of -1 every bit is 1
        whole = np.floor(count_of(reading, quantum) / weight)
        bit = whole - 2.0 * np.floor(whole / 2.0)
        return np.where(there & (bit != self.value), reading + (self.value - bit) * weight * quantum, reading)


class StuckBit(Distorting):
    """One bit of the reading is stuck: the reading as a two's-complement count of the quantum, its other bits as they are.

    The word is taken to be wide enough for the reading, so no bit is its sign; what lies below the quantum stays. A bit that
    is stuck where it stands anyway does nothing: bit n at 0 shows once the reading passes 2^n quanta, or is negative.

    Attributes
    ----------
    bit : int
        Which one, 0 for that of one quantum, at most 31; several in a grid sweep it.
    value : {0, 1}
        At which it is stuck.
    quantum_percent, quantum : float
        What a count of one is, of the admissible range [%] or in the unit of the sites; give one.
    """

    about: ClassVar[str] = "a bit of the digital word that stands at 0 or 1"
    distortion = Bit

    kind: Literal["stuck_bit"]
    bit: Annotated[Any, Number(ge=0.0, le=31.0, whole=True)]
    value: Annotated[Any, Number(ge=0.0, le=1.0, whole=True)]
    quantum_percent: Positive | None = None
    quantum: Positive | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one quantum."""
        yield from super().key_rules()
        yield exactly_one("quantum_percent", cls.key("quantum"))

    def numbers(self, site: Site, uniform: Floats) -> Bit:
        """Weight of the bit, exactly a power of two."""
        del uniform
        weight = np.ldexp(1.0, np.asarray(self.bit).astype(np.int64))
        return Bit(quantum=self.size("quantum", site), weight=weight, value=self.value)
