"""First-order actuators with rate and position limits, exact at the sample."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record

__all__ = ["ActuatorState", "Actuators"]


@record
class ActuatorState:
    """Positions [deg]."""

    position_deg: Rows


class Actuators:
    """``y[k+1] = y[k] + clip((1 - exp(-w T)) (u - y[k]), +-rate T)``, then clipped to the travel.

    Exact for a command held over the sample, while no limit is met.

    Parameters
    ----------
    bandwidth_rad_s : float
        Corner frequency w [rad/s].
    rate_deg_s : (n, 1) array
        Rate limits [deg/s].
    sample_s : float
        T [s].
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, *, bandwidth_rad_s: float, rate_deg_s: np.ndarray, sample_s: float) -> None:
        self.bandwidth_rad_s, self.rate_deg_s, self.sample_s = bandwidth_rad_s, rate_deg_s, sample_s
        self.states = Layout(ActuatorState(position_deg=len(rate_deg_s)))

    def start(self, c: Nothing) -> ActuatorState:
        """At zero."""
        del c
        return ActuatorState(position_deg=0.0)

    def step(
        self, x: ActuatorState, c: Nothing, n: Nothing, command_deg: Rows, lowest_deg: Rows, highest_deg: Rows
    ) -> tuple[ActuatorState, Rows]:
        """Positions at the next sample and at this one [deg], (n, n_cases); the command is limited to the travel first."""
        del c, n
        share = float(1.0 - exp(np.array(-self.bandwidth_rad_s * self.sample_s)))
        most_deg = self.rate_deg_s * self.sample_s
        reachable = np.minimum(np.maximum(command_deg, lowest_deg), highest_deg)
        move = np.minimum(np.maximum(share * (reachable - x.position_deg), -most_deg), most_deg)
        moved = np.minimum(np.maximum(x.position_deg + move, lowest_deg), highest_deg)
        return ActuatorState(position_deg=moved), x.position_deg
