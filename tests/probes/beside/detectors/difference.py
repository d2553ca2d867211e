"""The difference of two redundant sensors: says that something is wrong, not which."""

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.interfaces import Verdict


class Gains(BaseModel):
    limit_deg_s: float


@record
class Latched:
    alarm: Rows


class Difference:
    about, recorded, isolates, Gains = "difference of two sensors, latched", (), False, Gains
    states = Layout(Latched(alarm=0))

    def __init__(self, gains):
        self.gains = gains

    @classmethod
    def from_design(cls, gains, bus):
        bus.redundant("q_deg_s")
        return cls(gains)

    def start(self):
        return Latched(alarm=0.0)

    def step(self, x, measured):
        residual = np.abs(measured.q_deg_s[0] - measured.q_deg_s[1]) / self.gains.limit_deg_s
        alarm = np.where(residual > 1.0, 1.0, x.alarm)
        return Latched(alarm=alarm), Verdict(None, residual, alarm=alarm)
