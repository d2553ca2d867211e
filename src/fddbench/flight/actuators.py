"""First-order actuators with rate and position limits, exact at the sample."""

from dataclasses import dataclass

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Rows

__all__ = ["Actuators"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Actuators:
    """``y[k+1] = y[k] + clip((1 - exp(-w T)) (u - y[k]), +-rate T)``, then clipped to the travel.

    Exact for a command held over the sample, while no limit is met.

    Attributes
    ----------
    bandwidth_rad_s : float
        Corner frequency w [rad/s].
    rate_deg_s : (n, 1) array
        Rate limits [deg/s].
    sample_s : float
        T [s].
    """

    bandwidth_rad_s: float
    rate_deg_s: np.ndarray
    sample_s: float

    def step(self, position_deg: Rows, command_deg: Rows, lowest_deg: Rows, highest_deg: Rows) -> Rows:
        """Positions at the next sample [deg], (n, n_cases); the command is limited to the travel first."""
        share = float(1.0 - exp(np.array(-self.bandwidth_rad_s * self.sample_s)))
        most_deg = self.rate_deg_s * self.sample_s
        reachable = np.minimum(np.maximum(command_deg, lowest_deg), highest_deg)
        move = np.minimum(np.maximum(share * (reachable - position_deg), -most_deg), most_deg)
        return np.minimum(np.maximum(position_deg + move, lowest_deg), highest_deg)
