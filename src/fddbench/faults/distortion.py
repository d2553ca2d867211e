"""Faults that distort the reading itself: what they have in common, and the block of those that keep nothing."""

from typing import Any, ClassVar, Literal, Protocol

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows
from fddbench.errors import FddbenchError
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import FaultBlock, Instant, Site

__all__ = ["Distorting", "Distortion", "DistortionBlock"]


class Distortion(Protocol):
    """A record of the constants of a fault, rows of numbers (n_sites, n_cases), that says what becomes of a reading."""

    def of(self, reading: Rows, sign: Rows) -> Rows:
        """What the sites show, (n_sites, n_cases), in their unit; `sign` is -1 on every second site of opposite faults."""
        ...


class DistortionBlock:
    """A distortion of the reading of its sites; nothing is kept from sample to sample."""

    states: Layout[Any] = NOTHING

    def __init__(self, distortion: type[Distortion], n_sites: int) -> None:
        self.constants = constants_of(distortion, n_sites)

    def start(self, c: Distortion) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Distortion, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        return x, c.of(reading, now.sign)


class Distorting(FaultSpecification):
    """A fault that makes something else of the reading; it has no signal of its own that could be added or stand alone.

    Sites whose signal is only what faults add have nothing to distort and are refused.

    Attributes
    ----------
    mode : "add"
        It acts on the signal as it is.
    correlation : {"identical", "independent"}
        The same on every site.
    """

    distortion: ClassVar[type[Distortion] | None] = None
    """What becomes of a reading, for kinds that need no block of their own."""

    mode: Literal["add"] = "add"
    correlation: Literal["identical", "independent"] = "identical"

    def unfit_on(self, site: Site) -> str:
        """Nothing can be lost, delayed or rounded where a healthy signal is zero."""
        lost = "its signal is zero while it is healthy, so there is nothing to lose or to distort"
        return lost if site.additive else ""

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> FaultBlock:
        """What flies of it."""
        del sample_s
        if cls.distortion is None:
            raise FddbenchError(f"the fault {cls.__name__} has neither a distortion nor a block of its own")
        return DistortionBlock(cls.distortion, n_sites)
