"""Declares a sensor that has left a band, for good: on rows, and the same in ordinary Python."""

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.interfaces import Verdict


class Gains(BaseModel):
    limit_deg: float
    raises_above_deg: float = 1e9


@record
class Latched:
    declared: Rows


class Band:
    about, recorded, Gains = "left a band", (), Gains
    states = Layout(Latched(declared=2))

    def __init__(self, gains, bus):
        self.gains, self.watches = gains, bus.sites_on("level_deg")

    from_design = classmethod(lambda cls, gains, bus: cls(gains, bus))

    def start(self):
        return Latched(declared=0.0)

    def step(self, x, measured):
        residual = np.abs(measured.level_deg) / self.gains.limit_deg
        declared = np.where(residual > 1.0, 1.0, x.declared)
        return Latched(declared=declared), Verdict(declared, np.maximum(residual[0], residual[1]))


class PlainBand:
    about, recorded, Gains = "left a band, in ordinary Python", (), Gains

    def __init__(self, gains, bus):
        self.gains, self.watches = gains, bus.sites_on("level_deg")

    from_design = classmethod(lambda cls, gains, bus: cls(gains, bus))

    def start(self):
        return [False, False]

    def step(self, declared, measured):
        if max(measured.level_deg) > self.gains.raises_above_deg:
            raise ValueError("too much")
        residuals = [abs(reading) / self.gains.limit_deg for reading in measured.level_deg]
        for i, residual in enumerate(residuals):
            declared[i] = declared[i] or residual > 1.0
        return declared, Verdict(declared, max(residuals))


class SecondOnly(Band):
    """Watches the spare sensor alone."""

    states = Layout(Latched(declared=1))

    def __init__(self, gains, bus):
        self.gains, self.watches = gains, ("spare",)

    def step(self, x, measured):
        residual = np.abs(measured.level_deg[1]) / self.gains.limit_deg
        declared = np.where(residual > 1.0, 1.0, x.declared[0])
        return Latched(declared=np.stack([declared])), Verdict(np.stack([declared]), residual)


class Alarm(Band):
    """Says that something is wrong, not which."""

    isolates = False

    def step(self, x, measured):
        after, verdict = super().step(x, measured)
        return after, Verdict(None, verdict.residual, alarm=np.where(verdict.residual > 1.0, 1.0, 0.0))


class ManyAtOnce(Band):
    """Cannot be compiled, and sees many flights side by side."""

    batched = True

    def step(self, x, measured):
        if (measured.level_deg > self.gains.raises_above_deg).any():
            raise ValueError("too much")
        return super().step(x, measured)


class NoNumber(Band):
    """Declares what is no number where the first sensor reads much."""

    def step(self, x, measured):
        after, verdict = super().step(x, measured)
        large = np.where(measured.level_deg[0] > 2.0, 1e308, 1.0)
        nothing = large * 10.0 - large * 10.0
        return after, Verdict(np.stack([nothing, nothing]), verdict.residual)
