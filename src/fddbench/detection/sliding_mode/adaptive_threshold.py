"""The adaptive threshold: it opens while the surfaces work."""

from dataclasses import dataclass

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import largest

__all__ = ["AdaptiveThreshold"]


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

    pole_1_s: float
    gain: float
    roll_surface_scale: float
    rudder_scale: float
    floor_deg_s: float
    sample_s: float

    def step(self, level_deg_s: Rows, surface_deg: Rows) -> tuple[Rows, Rows]:
        """Filter state at the next sample and threshold at this one [deg/s], (n_cases,) each."""
        rudder = np.abs(surface_deg[0]) / self.rudder_scale
        others = largest(np.abs(surface_deg[1:])) / self.roll_surface_scale
        decay = float(exp(np.array(-self.pole_1_s * self.sample_s)))
        target = (self.gain / self.pole_1_s) * np.maximum(others, rudder)
        threshold = np.maximum(level_deg_s, self.floor_deg_s)
        return level_deg_s + (1.0 - decay) * (target - level_deg_s), threshold
