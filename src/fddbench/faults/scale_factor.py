"""Scale factor error: the sensor reads high or low, in proportion."""

from typing import ClassVar, Literal

from fddbench.faults.distortion import Distorting
from fddbench.faults.effectiveness import Loss
from fddbench.faults.specification import Finite
from fddbench.interfaces import Floats, Site

__all__ = ["ScaleFactor"]


class ScaleFactor(Distorting):
    """The reading times one plus an error; where the signal is near zero there is little to see of it.

    Attributes
    ----------
    scale_factor_percent : float
        Error of the scale factor [%]: the site shows (1 + error) times its reading; with -100 the signal is zero.
    correlation : {"identical", "independent", "opposite"}
        Opposite: one site reads high, the next one low.
    """

    about: ClassVar[str] = "a reading high or low in proportion"
    distortion = Loss

    kind: Literal["scale_factor"]
    correlation: Literal["identical", "independent", "opposite"] = "identical"  # type: ignore[assignment]
    scale_factor_percent: Finite

    def numbers(self, site: Site, uniform: Floats) -> Loss:
        """A loss of the other sign, the same on every site."""
        del site, uniform
        return Loss(loss_ratio=-self.scale_factor_percent / 100.0)
