"""Loss of effectiveness: the site does less than it says, in proportion."""

from typing import Annotated, Any, ClassVar, Literal

from fddbench.blocks.layout import Rows, record
from fddbench.faults.distortion import Distorting
from fddbench.faults.varied import Number
from fddbench.interfaces import Floats, Site

__all__ = ["Effectiveness", "Loss"]


@record
class Loss:
    """Lost share of the signal [-]; negative: the signal grows."""

    loss_ratio: Rows

    def of(self, reading: Rows, sign: Rows) -> Rows:
        """The total signal times what is left of it; a loss of zero leaves every bit."""
        return (1.0 - sign * self.loss_ratio) * reading


class Effectiveness(Distorting):
    """A share of the total signal is lost, trim included: where a surface stands near zero there is little to lose.

    An actuator does so much less than it is ordered; a sensor reads low by a scale factor, which is why sensors may have it.

    Attributes
    ----------
    loss_percent : float
        Lost share of the total, 0 to 100 [%]; with 100 the signal is zero.
    """

    about: ClassVar[str] = "a share of the total signal is lost"
    distortion = Loss

    kind: Literal["effectiveness"]
    loss_percent: Annotated[Any, Number(ge=0.0, le=100.0)]

    def numbers(self, site: Site, uniform: Floats) -> Loss:
        """The lost share, the same on every site."""
        del site, uniform
        return Loss(loss_ratio=self.loss_percent / 100.0)
