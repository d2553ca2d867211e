"""Declares each signal that moves by more than a limit from one sample to the next."""

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.interfaces import Verdict


class Gains(BaseModel):
    limit: float


@record
class Before:
    values: Rows
    begun: Rows
    declared: Rows


class WatchAll:
    about, recorded, Gains = "jumps of every signal", (), Gains

    def __init__(self, gains, bus):
        self.gains, n = gains, len(bus.signals)
        self.names = tuple(bus.signals)
        self.states = Layout(Before(values=n, begun=0, declared=n))

    from_design = classmethod(lambda cls, gains, bus: cls(gains, bus))

    def start(self):
        return Before(values=0.0, begun=0.0, declared=0.0)

    def step(self, x, measured):
        values = np.stack([getattr(measured, name) for name in self.names])
        jumps = np.where(x.begun > 0.0, np.abs(values - x.values), 0.0) / self.gains.limit
        declared = np.where(jumps > 1.0, 1.0, x.declared)
        return Before(values=values, begun=np.ones_like(x.begun), declared=declared), Verdict(
            declared, jumps.max(axis=0)
        )
