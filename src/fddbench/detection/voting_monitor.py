"""The baseline: the comparison with the voted signal and its confirmation time, nothing else."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.consolidation import deviations_deg_s, largest_deviation_deg_s, outlier
from fddbench.detection.isolation import latch
from fddbench.interfaces import Bus, Verdict

__all__ = ["VotingMonitor"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class VotingMonitorGains(BaseModel):
    """Numbers of a voting monitor.

    Attributes
    ----------
    flag_threshold_deg_s : float
        Distance from the voted signal that raises the flag [deg/s].
    confirm_one_s : float
        How long the flag must stand [s].
    """

    THRESHOLDS: ClassVar = {"flag_threshold_deg_s": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    flag_threshold_deg_s: Positive
    confirm_one_s: Positive


@record
class MonitorState:
    """For how many samples the flag has stood; how many sites are declared, and which."""

    held_samples: Row
    n_declared: Row
    declared: Rows


class VotingMonitor:
    """Declares the sensor that stays away from the voted signal; what consolidation in service does.

    Model assumed: at most one faulty sensor. Blind to a fault common to two sensors: they win the vote and the healthy
    one is declared. Knobs: a smaller threshold or a shorter time detects faster and alarms on noise. Cost: 36 operations.
    It is the baseline that shows what an observer adds.
    """

    about = "comparison with the voted signal, one faulty sensor"
    recorded = ("deviation_deg_s", "threshold_deg_s")
    Gains = VotingMonitorGains

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: VotingMonitorGains, bus: Bus) -> None:
        self.gains, self.watches = gains, bus.redundant("r_deg_s")
        self.confirm_samples = samples("confirm_one_s", gains.confirm_one_s, bus.sample_s)
        self.states = Layout(MonitorState(held_samples=ROW, n_declared=ROW, declared=len(self.watches)))

    @classmethod
    def from_design(cls, gains: VotingMonitorGains, bus: Bus) -> "VotingMonitor":
        """Monitor for a bus; needs redundant sensors and their voted signal."""
        bus.require("r_deg_s", "r_voted_deg_s")
        return cls(gains, bus)

    def start(self, c: Nothing) -> MonitorState:
        """Nothing declared."""
        del c
        return MonitorState(held_samples=0.0, n_declared=0.0, declared=0.0)

    def step(self, x: MonitorState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[MonitorState, Verdict]:
        """Verdict after one sample."""
        del c, n
        deviation = deviations_deg_s(measured.r_deg_s, measured.r_voted_deg_s)
        largest = largest_deviation_deg_s(deviation)
        held = held_samples(x.held_samples, largest > self.gains.flag_threshold_deg_s)
        n_now = np.maximum(x.n_declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        declared = latch(x.declared, outlier(deviation), n_before=x.n_declared, n_now=n_now)
        threshold = np.full_like(largest, self.gains.flag_threshold_deg_s)
        verdict = Verdict(
            declared, largest / threshold, signals={"deviation_deg_s": largest, "threshold_deg_s": threshold}
        )
        return MonitorState(held_samples=held, n_declared=n_now, declared=declared), verdict
