"""A sawtooth on a sensor: a kind of fault of one's own, in one file."""

import numpy as np

from fddbench.blocks.layout import Rows, record
from fddbench.faults.specification import Positive, WithAmplitude


@record
class Teeth:
    height: Rows
    period_s: Rows

    def at(self, time_s):
        return self.height * (time_s / self.period_s - np.floor(time_s / self.period_s))


class Sawtooth(WithAmplitude):
    """A ramp that falls back to zero."""

    profile = Teeth
    period_s: Positive

    def numbers(self, site, uniform):
        return Teeth(height=self.size("amplitude", site), period_s=self.period_s)
