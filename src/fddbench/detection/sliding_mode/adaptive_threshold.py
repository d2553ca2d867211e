"""The adaptive threshold: it opens while the surfaces work."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest

__all__ = ["AdaptiveThreshold", "ThresholdState"]


@record
class ThresholdState:
    """State of the filter [deg/s]."""

    level_deg_s: Row


@dataclass(frozen=True, kw_only=True)
class AdaptiveThreshold:
    """Eq (38), ``T' = -a T + g max(|ail, sp| / 12, |rud| / 2)``, exact for surfaces held over the sample, with a floor.

    Attributes
    ----------
    pole_1_s, gain : float
        a [1/s] and g [1/s].
    roll_surface_scale, rudder_scale : float
        Divisors of the deflections [deg per deg/s].
    floor_deg_s : float
        Least threshold [deg/s].
    sample_s : float
        Sample time [s].
    """

    states: ClassVar = Layout(ThresholdState(level_deg_s=ROW))
    constants: ClassVar[Layout[Any]] = NOTHING
    draws: ClassVar[Draws[Any]] = NO_DRAWS

    pole_1_s: float
    gain: float
    roll_surface_scale: float
    rudder_scale: float
    floor_deg_s: float
    sample_s: float

    def start(self, c: Nothing) -> ThresholdState:
        """At rest."""
        del c
        return ThresholdState(level_deg_s=0.0)

    def step(self, x: ThresholdState, c: Nothing, n: Nothing, surface_deg: Rows) -> tuple[ThresholdState, Row]:
        """State at the next sample, and the threshold at this one [deg/s], (n_cases,)."""
        del c, n
        rudder = np.abs(surface_deg[0]) / self.rudder_scale
        others = largest(np.abs(surface_deg[1:])) / self.roll_surface_scale
        decay = float(exp(np.array(-self.pole_1_s * self.sample_s)))
        target = (self.gain / self.pole_1_s) * np.maximum(others, rudder)
        moved = x.level_deg_s + (1.0 - decay) * (target - x.level_deg_s)
        return ThresholdState(level_deg_s=moved), np.maximum(x.level_deg_s, self.floor_deg_s)
