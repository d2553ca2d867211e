"""The baseline: the comparison with the voted signal and its confirmation time, nothing else."""

from types import SimpleNamespace
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.layout import Layout, Rows
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.consolidation import deviations_deg_s, largest_deviation_deg_s, outlier
from fddbench.detection.isolation import latch
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Floats, Verdict

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

    model_config = ConfigDict(extra="forbid", frozen=True)

    flag_threshold_deg_s: Positive
    confirm_one_s: Positive


class VotingMonitor:
    """Declares the sensor that stays away from the voted signal; what consolidation in service does.

    Model assumed: at most one faulty sensor. Blind to a fault common to two sensors: they win the vote and the healthy
    one is declared. Knobs: a smaller threshold or a shorter time detects faster and alarms on noise. Cost: 32 operations.
    It is the baseline that shows what an observer adds.
    """

    about = "comparison with the voted signal, one faulty sensor"
    recorded = ("deviation_deg_s", "threshold_deg_s")
    Gains = VotingMonitorGains

    def __init__(self, gains: VotingMonitorGains, bus: Bus) -> None:
        self.gains, self.n_sites = gains, len(bus.sites)
        self.confirm_samples = samples(gains.confirm_one_s, bus.sample_s)
        self.states = Layout(held_samples=0, n_declared=0, declared=self.n_sites)

    @classmethod
    def from_design(cls, gains: VotingMonitorGains, bus: Bus) -> "VotingMonitor":
        """Monitor for a bus; needs the redundant sensors and their voted signal."""
        missing = [name for name in ("r_deg_s", "r_voted_deg_s") if name not in bus.signals]
        if missing:
            raise DesignError(f"voting_monitor needs the signals {missing}, this benchmark has {sorted(bus.signals)}")
        return cls(gains, bus)

    def start(self, n_cases: int) -> Floats:
        """Nothing declared."""
        return self.states.zeros(n_cases)

    def step(self, state: Rows, measured: SimpleNamespace) -> tuple[Rows, Verdict]:
        """Verdict after one sample."""
        x = self.states.unpack(state)
        deviation = deviations_deg_s(measured.r_deg_s, measured.r_voted_deg_s)
        largest = largest_deviation_deg_s(deviation)
        held = held_samples(x.held_samples, largest > self.gains.flag_threshold_deg_s)
        n_now = np.maximum(x.n_declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        declared = latch(x.declared, outlier(deviation), n_before=x.n_declared, n_now=n_now)
        threshold = np.full_like(largest, self.gains.flag_threshold_deg_s)
        verdict = Verdict(
            declared, largest / threshold, signals={"deviation_deg_s": largest, "threshold_deg_s": threshold}
        )
        return self.states.pack(held_samples=held, n_declared=n_now, declared=declared), verdict
