"""Parity relations of the yaw-moment equation, one for every sensor: what a window of it cannot have done by itself."""

from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import total
from fddbench.blocks.primitives import rarely
from fddbench.detection.confirmation import samples
from fddbench.detection.decision import Nearest, NearestGains, NearestState
from fddbench.detection.yaw_moment import NEEDS, YawMoment
from fddbench.interfaces import Bus, Verdict

__all__ = ["YawMomentParity", "YawMomentParityGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class YawMomentParityGains(NearestGains):
    """Numbers of the decision, and the parity vector.

    Attributes
    ----------
    block_s : float
        Samples of this time are averaged to one of the window [s].
    v : numbers
        Parity vector [s/deg], the newest block first; they add up to zero.
    memory_s : float
        Lag on the size of the residuals [s].
    """

    block_s: Positive
    v: Annotated[tuple[Number, ...], Field(min_length=2)]
    memory_s: Positive


@record
class YawMomentParityState:
    """What the moments make of r [deg/s]; sums of the block; windows, sensor after sensor; residuals; decision."""

    integral_deg_s: Rows
    sum_deg_s: Rows
    count: Row
    blocks: Row
    windows: tuple[Rows, ...]
    parity: Rows
    residual: Rows
    decision: NearestState


class YawMomentParity:
    """Believes the sensor whose parity relation is closest to zero, and accuses whoever differs from it, one or two.

    ``v_0 q[k] + v_1 q[k-1] + ... + v_s q[k-s]`` of block means of ``q = r - (integral of the modelled yaw acceleration)``. The
    state of the scalar equation adds the same to all of a window, and v adds up to zero; gusts act through the sideslip,
    which is measured, and are part of the integral: blind to both, whatever they are. Of all such vectors v tells a step
    some `recipe.fault_age_s` ago best from noise, walks of the acceleration and an acceleration that lasts the window.

    Model assumed: the yaw row of the lateral LPV model, scheduled by measured values. Blind to faults below the gate, and to a
    constant fault once it has filled the window: what it said must last until the decision (`memory_s`). Knobs:
    `recipe.window_blocks` and `recipe.yaw_off_deg_s2` trade slow faults for errors of the moments. Cost: 351 operations a
    sample.

    References
    ----------
    Chow, Willsky (1984), Analytical redundancy and the design of robust failure detection systems, IEEE Transactions on
    Automatic Control 29(7), 603-614.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[parity_space_yaw_rate]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["parity_space_yaw_rate"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "parity relations of the yaw-moment equation, one for every yaw-rate sensor"
    Gains = YawMomentParityGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: YawMomentParityGains, bus: Bus) -> None:
        self.watches = bus.redundant("r_deg_s", least=3)
        n, self.v, self.sample_s = len(self.watches), gains.v, bus.sample_s
        self.recorded = tuple(f"parity_{i + 1}" for i in range(n))
        self.moment, self.decision = YawMoment(), Nearest.of(gains, bus, n)
        self.block = samples("block_s", gains.block_s, bus.sample_s, least=1)
        self.share = float(1.0 - exp(np.array(-bus.sample_s / gains.memory_s)))
        self.states = Layout(
            YawMomentParityState(
                integral_deg_s=n, sum_deg_s=n, count=ROW, blocks=ROW, windows=(len(gains.v) - 1,) * n, parity=n,
                residual=n, decision=self.decision.states.shape,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: YawMomentParityGains, bus: Bus) -> "YawMomentParity":
        """Detector for a bus with three or more yaw rates and what their moment is made of."""
        bus.require(*NEEDS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> YawMomentParityState:
        """Windows empty."""
        windows = (0.0,) * len(self.watches)
        return YawMomentParityState(
            integral_deg_s=0.0, sum_deg_s=0.0, count=0.0, blocks=0.0, windows=windows, parity=0.0, residual=0.0,
            decision=self.decision.start(c),
        )  # fmt: skip

    def step(
        self, x: YawMomentParityState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[YawMomentParityState, Verdict]:
        """Verdict after one sample."""
        r_deg_s, a = measured.r_deg_s, self.moment.parts(measured)
        known = a.sideslip_deg_s2 + a.roll_deg_s2 + a.surfaces_deg_s2
        summed = x.sum_deg_s + (r_deg_s - x.integral_deg_s)
        count = x.count + 1.0
        full = rarely(count >= self.block)
        windows, parity = [], []
        for i, window in enumerate(x.windows):
            newest = summed[i] / self.block
            fresh = total([self.v[0] * newest, *(self.v[j + 1] * window[j] for j in range(len(window)))])
            parity.append(np.where(full, np.where(x.blocks >= float(len(window)), fresh, 0.0), x.parity[i]))
            windows.append(np.where(full, np.concatenate([newest[np.newaxis], window[:-1]]), window))
        residual = x.residual + self.share * (np.abs(np.stack(parity)) - x.residual)
        decided, decision = self.decision.step(x.decision, c, n, r_deg_s, residual)
        after = YawMomentParityState(
            integral_deg_s=x.integral_deg_s + self.sample_s * (known + a.damping_1_s * r_deg_s),
            sum_deg_s=np.where(full, 0.0, summed), count=np.where(full, 0.0, count),
            blocks=np.where(full, x.blocks + 1.0, x.blocks), windows=tuple(windows), parity=np.stack(parity),
            residual=residual, decision=decided,
        )  # fmt: skip
        shown = {name: parity[i] for i, name in enumerate(self.recorded)}
        return after, Verdict(decision.declared, decision.residual, signals=shown)
