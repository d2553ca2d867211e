"""Noise: the sensor turns noisy."""

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from fddbench.faults.specification import FaultSpecification, FaultWave, SensorUnits, one_of

__all__ = ["Noise"]

Variance = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class Noise(FaultSpecification):
    """White noise added to every sample.

    Attributes
    ----------
    variance_percent, variance_deg2_s2 : float
        Variance, percent of the *number* of the admissible range (Table 2 of the paper: 1.25 % of 40 is
        0.5 deg^2/s^2) or in [deg^2/s^2]; give one.
    """

    about: ClassVar[str] = "white noise on every sample"

    kind: Literal["noise"]
    variance_percent: Variance | None = None
    variance_deg2_s2: Variance | None = None

    def wave(self, units: SensorUnits) -> FaultWave:
        """Noise of the given variance."""
        percent = None if self.variance_percent is None else self.variance_percent / 100.0 * units.admissible_deg_s
        variance = one_of(variance_percent=percent, variance_deg2_s2=self.variance_deg2_s2)
        return FaultWave(**self.base(units), sigma_deg_s=float(np.sqrt(variance)))
