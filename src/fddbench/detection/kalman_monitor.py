"""Kalman filter of one flight condition and a test of its innovations: the textbook monitor that the geometric filters face."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, product, total
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.lpv_filter.channels import require_channels, rows_of
from fddbench.detection.lpv_filter.gains import ChannelEntry
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict

__all__ = ["KalmanMonitor", "KalmanMonitorGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Matrix = Annotated[tuple[tuple[Number, ...], ...], Field(min_length=1)]


class KalmanMonitorGains(BaseModel):
    """Filter in discrete time and its test.

    Attributes
    ----------
    outputs, inputs : channels
        y and u; what they were at the first sample is taken off.
    sample_s : float
        Clock that the matrices are for [s].
    A, B, C, K, W : matrices
        ``x[k+1] = A x[k] + B u[k] + K e[k]``, ``e = y - C x``; W whitens e, ``W E[e e'] W' = I``.
    mean_s : float
        Time constant of the mean of ``|W e|^2 / n_y`` [s]; one in the long run, if the model is right.
    thresholds : one number
        Largest mean that is no alarm [-].
    confirm_s : float
        How long the mean must stay beyond it [s].
    """

    THRESHOLDS: ClassVar = {"thresholds": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    outputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)]
    inputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)]
    sample_s: Positive
    A: Matrix
    B: Matrix
    C: Matrix
    K: Matrix
    W: Matrix
    mean_s: Positive
    thresholds: Annotated[tuple[Positive, ...], Field(min_length=1, max_length=1)]
    confirm_s: Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


@record
class KalmanMonitorState:
    """Predicted state; outputs and inputs of the first sample, and whether there was one; the mean and the decision on it."""

    x: Rows
    y_first: Rows
    u_first: Rows
    begun: Row
    mean: Row
    held_samples: Row
    alarm: Row


class KalmanMonitor:
    """Alarms, for good, when the mean square of the whitened innovations stays above a threshold; declares no site.

    Model assumed: the linear model of one flight condition, about the trim that a flight begins in, with white noise of known
    size. Everything that the model does not
    know raises the innovations, a fault as well as a manoeuvre that leaves the condition, a gust or another mass: it cannot
    tell which. Knobs: less process noise makes it sharper for small faults and blinder for model errors; the mean trades
    noise for delay; the threshold (``fddbench tune``) false alarms for misses. Cost: n_x (n_x + n_u + 2 n_y) + n_y^2 products.

    References
    ----------
    Mehra, Peschon (1971), An innovations approach to fault detection and diagnosis in dynamic systems, Automatica 7(5),
    637-640.
    """

    about = "Kalman filter of one flight condition, test of its innovations; detects, does not isolate"
    isolates = False
    evaluated = ("innovation_mean",)
    recorded = ("innovation_mean", "threshold")
    Gains = KalmanMonitorGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: KalmanMonitorGains, bus: Bus) -> None:
        self.outputs, self.inputs, self.threshold = gains.outputs, gains.inputs, gains.thresholds[0]
        self.A, self.B, self.C, self.K, self.W = (column(m) for m in (gains.A, gains.B, gains.C, gains.K, gains.W))
        self.share = float(1.0 - exp(np.array(-bus.sample_s / gains.mean_s)))
        self.confirm_samples = samples("confirm_s", gains.confirm_s, bus.sample_s)
        self.states = Layout(
            KalmanMonitorState(
                x=len(gains.A), y_first=len(gains.outputs), u_first=len(gains.inputs), begun=ROW, mean=ROW,
                held_samples=ROW, alarm=ROW,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: KalmanMonitorGains, bus: Bus) -> "KalmanMonitor":
        """Monitor for a bus with the signals of its channels, on the clock of its matrices."""
        require_channels(gains.outputs, bus, "outputs")
        require_channels(gains.inputs, bus, "inputs")
        if abs(gains.sample_s - bus.sample_s) > 1e-9:
            raise DesignError(
                f"this design is for sample_s = {gains.sample_s}, this campaign has {bus.sample_s}; design it anew"
            )
        n, n_y, n_u = len(gains.A), len(gains.outputs), len(gains.inputs)
        needs = {"A": (n, n), "B": (n, n_u), "C": (n_y, n), "K": (n, n_y), "W": (n_y, n_y)}
        for name, need in needs.items():
            found = {(len(getattr(gains, name)), len(row)) for row in getattr(gains, name)}
            if found != {need}:
                raise DesignError(f"{name} needs {need[0]} rows of {need[1]} numbers")
        A, K, C = (np.array(matrix) for matrix in (gains.A, gains.K, gains.C))
        radius = float(np.abs(np.linalg.eigvals(A - K @ C)).max())
        if radius >= 1.0:
            raise DesignError(f"this filter diverges: A - K C has spectral radius {radius:.4f}, must be below 1")
        return cls(gains, bus)

    def start(self, c: Nothing) -> KalmanMonitorState:
        """In trim."""
        del c
        return KalmanMonitorState(x=0.0, y_first=0.0, u_first=0.0, begun=0.0, mean=0.0, held_samples=0.0, alarm=0.0)

    def step(
        self, x: KalmanMonitorState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[KalmanMonitorState, Verdict]:
        """Verdict after one sample."""
        del c, n
        y, u = rows_of(self.outputs, measured, x.mean), rows_of(self.inputs, measured, x.mean)
        first: Rows = x.begun < 0.5
        y_first, u_first = np.where(first, y, x.y_first), np.where(first, u, x.u_first)
        e = y - y_first - product(self.C, x.x)
        white = product(self.W, e)
        mean = x.mean + self.share * (total(white * white) / float(len(self.outputs)) - x.mean)
        held = held_samples(x.held_samples, mean > self.threshold)
        alarm = np.maximum(x.alarm, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        predicted = product(self.A, x.x) + product(self.B, u - u_first) + product(self.K, e)
        shown = {"innovation_mean": mean, "threshold": np.zeros_like(mean) + self.threshold}
        after = KalmanMonitorState(
            x=predicted,
            y_first=y_first,
            u_first=u_first,
            begun=np.ones_like(mean),
            mean=mean,
            held_samples=held,
            alarm=alarm,
        )
        return after, Verdict(None, mean / self.threshold, signals=shown, alarm=alarm)
