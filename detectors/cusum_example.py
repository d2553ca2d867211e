"""A detector of one's own, to copy: a one-sided cumulative sum of each sensor's distance from the voted signal.

Beside this file lies its design, ``cusum_example.yaml``; a campaign names that design under ``detectors:``.
"""

from types import SimpleNamespace

import numpy as np
from pydantic import BaseModel, ConfigDict

from fddbench.blocks.layout import Layout, Rows
from fddbench.blocks.linear import largest
from fddbench.interfaces import Bus, Floats, Verdict


class CusumGains(BaseModel):
    """Slack [deg/s] taken off every sample, and limit [deg/s] of the sum; checked when the design is read."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    slack_deg_s: float
    limit_deg_s: float


class Cusum:
    """``s[k] = max(0, s[k-1] + |r_i - r_voted| - slack)``; a sensor is declared, for good, when its sum passes the limit.

    Reference: Page (1954), Continuous inspection schemes, Biometrika 41(1/2), 100-115.
    """

    about = "cumulative sum of the distance from the voted signal"
    recorded = ("sum_deg_s", "limit_deg_s")
    Gains = CusumGains

    def __init__(self, gains: CusumGains, n_sites: int) -> None:
        self.gains = gains
        self.states = Layout(sum_deg_s=n_sites, declared=n_sites)

    @classmethod
    def from_design(cls, gains: CusumGains, bus: Bus) -> "Cusum":
        """Detector for the sites of a benchmark."""
        return cls(gains, len(bus.sites))

    def start(self, n_cases: int) -> Floats:
        """Sums at zero, nothing declared."""
        return self.states.zeros(n_cases)

    def step(self, state: Rows, measured: SimpleNamespace) -> tuple[Rows, Verdict]:
        """One sample: rows of numbers in, rows of numbers out; `np.where` instead of `if`."""
        x = self.states.unpack(state)
        distance = np.abs(measured.r_deg_s - measured.r_voted_deg_s)
        sums = np.maximum(x.sum_deg_s + distance - self.gains.slack_deg_s, 0.0)
        declared = np.where(sums > self.gains.limit_deg_s, 1.0, x.declared)
        worst = largest(sums)
        limit = np.full_like(worst, self.gains.limit_deg_s)
        verdict = Verdict(declared, worst / limit, signals={"sum_deg_s": worst, "limit_deg_s": limit})
        return self.states.pack(sum_deg_s=sums, declared=declared), verdict
