"""Elevator, stabiliser and engines: first-order lags with stops and rates, exact at the sample."""

from typing import Any

import numpy as np

from fddbench.benchmarks.b747_longitudinal.plant import ELEVATOR_DEG, STABILISER_DEG, TrimPoint
from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column

__all__ = ["BANDWIDTH_RAD_S", "ActuatorState", "Actuators"]

BANDWIDTH_RAD_S = (27.0, 0.5, 0.5)
"""Corner frequencies of elevator, stabiliser and engines: 27/(s + 27), 1/(2 s + 1), 1/(2 s + 1), section IV [rad/s]."""
# ours: hydraulic elevator 37 deg/s, jackscrew of the stabiliser 0.5 deg/s; engines are limited by their lag alone
_RATES = (37.0, 0.5, 1e9)


@record
class ActuatorState:
    """Elevator and stabiliser [deg] and thrust per engine at the trim's airspeed [N], (3, n_cases)."""

    position: Rows


class Actuators:
    """``y[k+1] = y[k] + clip((1 - exp(-w T)) (u - y[k]), +-rate T)``, then clipped to the travel.

    Exact for an order held over the sample, while no limit is met.

    Parameters
    ----------
    sample_s : float
        T [s].
    """

    states = Layout(ActuatorState(position=3))
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, sample_s: float) -> None:
        self.share = column([float(1.0 - exp(np.array(-w * sample_s))) for w in BANDWIDTH_RAD_S])
        self.most = column(_RATES) * sample_s

    def start(self, at: TrimPoint) -> ActuatorState:
        """In trim."""
        return ActuatorState(position=np.stack([at.elevator_deg, at.stabiliser_deg, at.thrust_n]))

    def step(self, x: ActuatorState, at: TrimPoint, n: Nothing, orders: Rows) -> tuple[ActuatorState, Rows]:
        """Positions at the next sample and at this one, (3, n_cases); orders are limited to the travel first."""
        del n
        low, high = travel(at)
        reachable = np.minimum(np.maximum(orders, low), high)
        move = np.minimum(np.maximum(self.share * (reachable - x.position), -self.most), self.most)
        return ActuatorState(position=x.position + move), x.position


def travel(at: TrimPoint) -> tuple[Rows, Rows]:
    """Lowest and highest positions, (3, n_cases)."""
    ones = np.ones_like(at.thrust_highest_n)
    low = np.stack([ELEVATOR_DEG[0] * ones, STABILISER_DEG[0] * ones, 0.0 * ones])
    return low, np.stack([ELEVATOR_DEG[1] * ones, STABILISER_DEG[1] * ones, at.thrust_highest_n])
