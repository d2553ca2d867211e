"""Built-in test with fixed thresholds: differences of sensors and their rates of change, no aircraft model."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.confirmation import samples
from fddbench.detection.consolidation import deviations_deg_s
from fddbench.detection.decision import Confirmation, ConfirmationState, Miscompare, MiscompareState
from fddbench.interfaces import Bus, Verdict

__all__ = ["FixedThreshold", "FixedThresholdGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class FixedThresholdGains(BaseModel):
    """Thresholds and times.

    Attributes
    ----------
    differ_deg_s : float
        Root mean square difference of two sensors that is none [deg/s].
    mean_s : float
        Time constant of mean squares [s].
    rate_deg_s2 : float
        Fastest change of a sensor that an aircraft can cause [deg/s^2].
    rate_lag_s : float
        Time constant of the filter that takes the rate [s]; noise of sigma reads as about sigma / rate_lag_s.
    memory_s : float
        How long a sensor that has changed faster is remembered for it [s].
    confirm_s : float
        How long a sensor must be suspected [s].
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up", "rate_deg_s2": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    differ_deg_s: Positive
    mean_s: Positive
    rate_deg_s2: Positive
    rate_lag_s: Positive
    memory_s: Positive
    confirm_s: NonNegative


@record
class FixedThresholdState:
    """Lagged sensors [deg/s], and whether there was a sample; for how many samples each is remembered; the decision."""

    lagged_deg_s: Rows
    begun: Row
    remembered: Rows
    mean_square: Rows
    compared: MiscompareState
    confirmed: ConfirmationState


class FixedThreshold:
    """Of two sensors that differ, declares the one that has changed too fast of late, else the one farther from the vote.

    What equipment in service does with thresholds alone. Model assumed: no aircraft, but that it turns no faster than
    `rate_deg_s2`, and that of three sensors the odd one is wrong unless others have jumped. So it finds jumps of two sensors,
    and is wrong, with certainty, where two drift or swing together more slowly than that: they win the vote. Blind to what
    differs by less than `differ_deg_s`. Knobs: `rate_deg_s2` must stay above what manoeuvres, gusts and noise / `rate_lag_s`
    reach; longer memories tell pairs whose difference takes its time, and accuse those that were merely shaken. Cost: 140
    operations.

    References
    ----------
    Osder (1999), Practical view of redundancy management application and theory, Journal of Guidance, Control, and Dynamics
    22(1), 12-21.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[fixed_threshold]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["fixed_threshold"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "fixed thresholds on differences and rates of change, no aircraft model"
    sees = "sensors"
    recorded = ("rate_ratio", "difference_ratio")
    Gains = FixedThresholdGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: FixedThresholdGains, bus: Bus) -> None:
        T, self.watches = bus.sample_s, bus.redundant("r_deg_s")
        n, self.scale = len(self.watches), 1.0 / (gains.rate_lag_s * gains.rate_deg_s2)
        self.miscompare = Miscompare(gains.differ_deg_s, mean_s=gains.mean_s, sample_s=T, n_sensors=n)
        self.confirmation = Confirmation(gains.confirm_s, sample_s=T, n_sites=n)
        self.memory = samples("memory_s", gains.memory_s, T, least=1)
        self.share, self.lag = (float(1.0 - exp(np.array(-T / s))) for s in (gains.mean_s, gains.rate_lag_s))
        self.states = Layout(
            FixedThresholdState(
                lagged_deg_s=n, begun=ROW, remembered=n, mean_square=n, compared=self.miscompare.states.shape,
                confirmed=self.confirmation.states.shape,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: FixedThresholdGains, bus: Bus) -> "FixedThreshold":
        """Monitor for a bus that has redundant yaw rates and their voted signal."""
        bus.require("r_voted_deg_s")
        return cls(gains, bus)

    def start(self, c: Nothing) -> FixedThresholdState:
        """Nothing remembered, nothing declared."""
        return FixedThresholdState(
            lagged_deg_s=0.0, begun=0.0, remembered=0.0, mean_square=0.0, compared=self.miscompare.start(c),
            confirmed=self.confirmation.start(c),
        )  # fmt: skip

    def step(
        self, x: FixedThresholdState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[FixedThresholdState, Verdict]:
        """Verdict after one sample."""
        r_deg_s = measured.r_deg_s
        before = np.where(x.begun > 0.0, x.lagged_deg_s, r_deg_s)
        fast = np.abs(r_deg_s - before) * self.scale
        remembered = np.where(fast > 1.0, self.memory, np.maximum(x.remembered - 1.0, 0.0))
        deviation = deviations_deg_s(r_deg_s, measured.r_voted_deg_s)
        mean_square = x.mean_square + self.share * (deviation * deviation - x.mean_square)
        # below one, so that no distance from the vote outweighs a rate
        against = np.where(remembered > 0.0, 1.0, 0.0) + mean_square / (1.0 + mean_square)
        compared, found = self.miscompare.step(x.compared, c, n, r_deg_s, against, x.confirmed.declared)
        confirmed, declared = self.confirmation.step(x.confirmed, c, n, found.suspected)
        after = FixedThresholdState(
            lagged_deg_s=before + self.lag * (r_deg_s - before),
            begun=np.ones_like(x.begun),
            remembered=remembered,
            mean_square=mean_square,
            compared=compared,
            confirmed=confirmed,
        )
        shown = {"rate_ratio": largest(fast), "difference_ratio": found.ratio}
        return after, Verdict(declared, found.ratio, signals=shown)
