"""Noise: the sensor turns noisy."""

from typing import ClassVar, Literal

import numpy as np

from fddbench.faults.specification import FaultSpecification, FaultWave, NonNegative
from fddbench.interfaces import FaultUnits

__all__ = ["Noise"]


class Noise(FaultSpecification):
    """White noise added to every sample.

    Attributes
    ----------
    variance_percent, variance : float
        Variance, percent of the *number* of the admissible range (Table 2 of the paper: 1.25 % of 40 is
        0.5 deg^2/s^2) or in the unit of the sites squared; give one.
    """

    about: ClassVar[str] = "white noise on every sample"

    kind: Literal["noise"]
    variance_percent: NonNegative | None = None
    variance: NonNegative | None = None

    def wave(self, units: FaultUnits) -> FaultWave:
        """Noise of the given variance."""
        variance = self.size("variance", "variance_percent", units)
        return FaultWave(**self.base(units), sigma=float(np.sqrt(variance)))
