"""Loss of effectiveness: the site does less than it says, in proportion."""

from typing import Annotated, Any, ClassVar, Literal

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.varied import Number
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Effectiveness"]


@record
class Loss:
    """Lost share of the signal [-]."""

    loss_ratio: Rows


class EffectivenessBlock:
    """The total signal times what is left of it; a loss of zero leaves every bit."""

    states: Layout[Any] = NOTHING

    def __init__(self, n_sites: int) -> None:
        self.constants = constants_of(Loss, n_sites)

    def start(self, c: Loss) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Loss, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        del now
        return x, (1.0 - c.loss_ratio) * reading


class Effectiveness(FaultSpecification):
    """A share of the total signal is lost, trim included: where a surface stands near zero there is little to lose.

    An actuator does so much less than it is ordered; a sensor reads low by a scale factor, which is why sensors may have it.
    Sites whose signal is only what faults add have nothing to lose and are refused.

    Attributes
    ----------
    loss_percent : float
        Lost share of the total, 0 to 100 [%]; with 100 the signal is zero.
    """

    about: ClassVar[str] = "a share of the total signal is lost"

    kind: Literal["effectiveness"]
    mode: Literal["add"] = "add"
    correlation: Literal["identical", "independent"] = "identical"
    loss_percent: Annotated[Any, Number(ge=0.0, le=100.0)]

    def numbers(self, site: Site, uniform: Floats) -> Loss:
        """The lost share, the same on every site."""
        del site, uniform
        return Loss(loss_ratio=self.loss_percent / 100.0)

    def unfit_on(self, site: Site) -> str:
        """Nothing can be lost where a healthy signal is zero."""
        return "its signal is zero while it is healthy, so there is nothing to lose" if site.additive else ""

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> EffectivenessBlock:
        """What flies of it."""
        del sample_s
        return EffectivenessBlock(n_sites)
