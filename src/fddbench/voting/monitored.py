"""Median with rejection: a sensor that stays apart is lost for good, the mean of the others is voted from then on."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.clock import misfit, samples
from fddbench.errors import FddbenchError
from fddbench.voting.mean_of_left import mean_of_left
from fddbench.voting.median import Median

__all__ = ["Monitored", "MonitoredState"]


@record
class MonitoredState:
    """For how many samples each sensor has been apart; 1 where one is out."""

    apart: Rows
    out: Rows


class Monitored:
    """Middle value of the sensors; one that stays apart from what is voted is latched out, then the mean of those left.

    A sensor that differs from the voted signal by more than a threshold at every sample of the confirmation time is out from
    the next sample on, for the rest of the flight: the farthest one where several come due together. Where two are left a
    difference accuses nobody, and neither goes. Equal faults on two of three sensors throw the healthy one out: that is what
    makes such faults worth a detector. Sites that a detector declares (``reconfigure``) are out as well, as long as they are
    declared, unless that would leave nobody.

    Thresholds are at least twice the largest difference from the median in 2000 healthy flights with three inertial units of
    drawn errors, all five manoeuvres: 0.19 deg/s in yaw, 0.2 deg/s in roll rate, 0.4 deg of bank. Other numbers are a subclass
    in a file beside the campaign, ``voter: mine.py:Mine``, with its own `thresholds` and `confirm_s`.

    Attributes
    ----------
    thresholds : mapping of str to float
        Largest difference of a healthy sensor by the name of the signal, in its unit. A signal that is not there is never
        monitored.
    confirm_s : float
        For how long a sensor must differ [s]; a multiple of the sample time.

    Examples
    --------
    >>> voter = Monitored(threshold=0.5, confirm_samples=1)
    >>> x = voter.states.spread(voter.start(), 1)
    >>> for third in (9.0, 9.0, 9.0):
    ...     x, voted = voter.step(x, np.array([[1.0], [1.2], [third]]))
    ...     print(voted, x.out[:, 0])
    [1.2] [0. 0. 0.]
    [1.2] [0. 0. 1.]
    [1.1] [0. 0. 1.]
    """

    about = "middle value; a sensor that stays apart is latched out, then the mean of those left"
    reconfigures = True
    thresholds: ClassVar[Mapping[str, float]] = {
        "r_deg_s": 0.4,
        "p_units_deg_s": 0.5,
        "phi_units_deg": 1.0,
        "alpha_deg": 0.5,
        "n_z_g": 0.05,
    }
    confirm_s: ClassVar[float] = 0.1

    def __init__(self, *, threshold: float | None = None, confirm_samples: int = 10, n_sensors: int = 3) -> None:
        self.threshold = self.thresholds["r_deg_s"] if threshold is None else threshold
        self.confirm_samples = confirm_samples
        self.states: Layout[Any] = Layout(MonitoredState(apart=n_sensors, out=n_sensors))

    @classmethod
    def for_signal(cls, signal: str, n_sensors: int, sample_s: float) -> "Monitored":
        """The voter of a signal; raises FddbenchError for a confirmation time that does not fit the clock."""
        wrong = misfit(cls.confirm_s, sample_s)
        if wrong:
            raise FddbenchError(
                f"voter {cls.__name__}: confirm_s {wrong}; set it in a subclass in a file beside the campaign"
            )
        return cls(
            threshold=cls.thresholds.get(signal, np.inf),
            confirm_samples=samples(cls.confirm_s, sample_s),
            n_sensors=n_sensors,
        )

    def vote(self, sensors: Rows) -> Row:
        """What it votes while all are in: their middle value, (n_cases,)."""
        return Median().vote(sensors)

    def start(self) -> MonitoredState:
        """All are in."""
        return MonitoredState(apart=0.0, out=0.0)

    def step(self, x: MonitoredState, sensors: Rows, declared: Rows = None) -> tuple[MonitoredState, Row]:
        """State at the next sample, and the voted signal, (n_cases,), at this one; `declared` are rows of 0 and 1."""
        out = x.out if declared is None else _unless_all(np.maximum(x.out, declared), x.out)
        voted = mean_of_left(sensors, out, self.vote(sensors))
        away = [np.abs(value - voted) for value in sensors]
        apart = [np.where(d > self.threshold, run + 1.0, 0.0) for d, run in zip(away, x.apart, strict=True)]
        # samples k - confirm to k: held for the confirmation time
        due = [
            np.where((run > self.confirm_samples + 0.5) & (gone < 0.5), d, -1.0)
            for d, run, gone in zip(away, apart, out, strict=True)
        ]
        farthest = due[0]
        for d in due[1:]:
            farthest = np.maximum(farthest, d)
        lost, taken = [], _left(out) < 2.5
        for d, gone in zip(due, x.out, strict=True):
            goes = (d >= 0.0) & (d >= farthest) & ~taken
            taken = taken | goes
            lost.append(np.where(goes, 1.0, gone))
        return MonitoredState(apart=np.stack(apart), out=np.stack(lost)), voted


def _unless_all(wanted: Rows, otherwise: Rows) -> Rows:
    """Sensors that are out, unless that would leave nobody."""
    return np.where(_left(wanted) > 0.5, wanted, otherwise)


def _left(out: Rows) -> Row:
    """How many sensors are in, (n_cases,)."""
    left = 1.0 - out[0]
    for gone in out[1:]:
        left = left + (1.0 - gone)
    return left
