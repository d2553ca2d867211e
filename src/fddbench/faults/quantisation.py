"""Quantisation: the sensor shows whole steps only."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from fddbench.blocks.layout import Rows, record
from fddbench.faults.distortion import Distorting
from fddbench.faults.key_rules import KeyRule, exactly_one
from fddbench.faults.specification import NonNegative
from fddbench.interfaces import Floats, Site

__all__ = ["Quantisation", "count_of"]


def count_of(reading: Rows, quantum: Rows) -> Rows:
    """The reading as a whole number of quanta, the nearest one; halves go to the even one, as IEEE 754 rounds.

    >>> count_of(np.array([0.74, -0.76, 0.75]), np.array([0.5]))
    array([ 1., -2.,  2.])
    """
    return np.rint(reading / quantum)


@record
class Steps:
    """Height of a step, in the unit of the site; 0: none."""

    quantum: Rows

    def of(self, reading: Rows, sign: Rows) -> Rows:
        """The nearest step; a quantum of zero leaves every bit."""
        del sign
        stepped = self.quantum > 0.0
        height = np.where(stepped, self.quantum, 1.0)
        return np.where(stepped, height * count_of(reading, height), reading)


class Quantisation(Distorting):
    """The reading rounded to whole quanta: a converter that has lost its low bits, a sensor that sticks.

    Attributes
    ----------
    quantum_percent, quantum : float
        Height of a step, not negative, of the admissible range [%] or in the unit of the sites; give one.
    """

    about: ClassVar[str] = "a reading in whole steps"
    distortion = Steps

    kind: Literal["quantisation"]
    quantum_percent: NonNegative | None = None
    quantum: NonNegative | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one quantum."""
        yield from super().key_rules()
        yield exactly_one("quantum_percent", cls.key("quantum"))

    def numbers(self, site: Site, uniform: Floats) -> Steps:
        """Steps of the given height."""
        del uniform
        return Steps(quantum=self.size("quantum", site))
