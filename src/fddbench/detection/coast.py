"""No aircraft model at all: the yaw rate is what it was when the sensors last agreed."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.detection.decision import (
    Confirmation,
    ConfirmationState,
    Miscompare,
    MiscompareState,
    live_mean,
)
from fddbench.interfaces import Bus, Verdict

__all__ = ["Coast", "CoastGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class CoastGains(BaseModel):
    """Numbers of the comparison.

    Attributes
    ----------
    differ_deg_s : float
        Root mean square difference of two sensors that is none [deg/s].
    mean_s : float
        Time constant of mean squares [s].
    confirm_s : float
        How long a sensor must be suspected [s].
    """

    THRESHOLDS: ClassVar = {"differ_deg_s": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    differ_deg_s: Positive
    mean_s: Positive
    confirm_s: NonNegative


@record
class CoastState:
    """Yaw rate when the sensors last agreed [deg/s]; mean square distances from it [(deg/s)^2]; comparison; declarations."""

    agreed_deg_s: Row
    mean_square: Rows
    compared: MiscompareState
    confirmed: ConfirmationState


class Coast:
    """Of two sensors that differ, declares the one farther from what all read when they last agreed.

    Model assumed: none; the yaw rate stands still for as long as a decision takes. It is the sanity line beside every score:
    what a detector with a model does not do better was no work for a model. Blind to what differs by less than
    `differ_deg_s`, and on the wrong side where the yaw rate moves faster than the fault grows: slow pairs, faults at the
    entry of a turn. Knobs: a smaller `differ_deg_s` decides while the last agreement is fresh, and alarms on the sensors' own
    errors; a shorter confirmation does the same. Cost: 116 operations.

    References
    ----------
    None; it is what is left of the other monitors when the model is taken away.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[coast]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["coast"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "no aircraft model: accuses the sensor farther from what all read when they last agreed"
    sees = "sensors"
    recorded = ("agreed_deg_s", "difference_ratio")
    Gains = CoastGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: CoastGains, bus: Bus) -> None:
        T, self.watches = bus.sample_s, bus.redundant("r_deg_s")
        n = len(self.watches)
        self.miscompare = Miscompare(gains.differ_deg_s, mean_s=gains.mean_s, sample_s=T, n_sensors=n)
        self.confirmation = Confirmation(gains.confirm_s, sample_s=T, n_sites=n)
        self.share = float(1.0 - exp(np.array(-T / gains.mean_s)))
        self.states = Layout(
            CoastState(
                agreed_deg_s=ROW,
                mean_square=n,
                compared=self.miscompare.states.shape,
                confirmed=self.confirmation.states.shape,
            )
        )

    @classmethod
    def from_design(cls, gains: CoastGains, bus: Bus) -> "Coast":
        """Detector for a bus that has redundant yaw rates."""
        return cls(gains, bus)

    def start(self, c: Nothing) -> CoastState:
        """Straight flight, nothing declared."""
        return CoastState(
            agreed_deg_s=0.0, mean_square=0.0, compared=self.miscompare.start(c), confirmed=self.confirmation.start(c)
        )

    def step(self, x: CoastState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[CoastState, Verdict]:
        """Verdict after one sample."""
        r_deg_s = measured.r_deg_s
        distance = r_deg_s - x.agreed_deg_s
        mean_square = x.mean_square + self.share * (distance * distance - x.mean_square)
        compared, found = self.miscompare.step(x.compared, c, n, r_deg_s, mean_square, x.confirmed.declared)
        confirmed, declared = self.confirmation.step(x.confirmed, c, n, found.suspected)
        agreed = np.where(found.differ, x.agreed_deg_s, live_mean(r_deg_s, declared))
        after = CoastState(agreed_deg_s=agreed, mean_square=mean_square, compared=compared, confirmed=confirmed)
        return after, Verdict(
            declared, found.ratio, signals={"agreed_deg_s": x.agreed_deg_s, "difference_ratio": found.ratio}
        )
