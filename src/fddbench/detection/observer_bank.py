"""A lateral observer for every yaw-rate sensor: the hypothesis whose observer is surprised least wins."""

from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import product
from fddbench.detection.decision import Nearest, NearestGains, NearestState
from fddbench.detection.gust_filter import LATERAL_SIGNALS, GustFilter, GustFilterGains, GustFilterState, lateral
from fddbench.interfaces import Bus, Verdict
from fddbench.units import RAD_PER_DEG

__all__ = ["ObserverBank", "ObserverBankGains"]


class ObserverBankGains(NearestGains):
    """Numbers of the decision, and of the observers.

    Attributes
    ----------
    filter : GustFilterGains
        Of each observer; made by ``fddbench design``.
    memory_s : float
        Lag on the residuals [s].
    """

    filter: GustFilterGains
    memory_s: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


@record
class ObserverBankState:
    """The observers; lagged residuals [-]; the decision."""

    observers: tuple[GustFilterState, ...]
    residual: Rows
    decision: NearestState


class ObserverBank:
    """Believes the sensor whose own observer is surprised least, and accuses whoever differs from it, one or two.

    One hypothesis a sensor and a pair, of three observers: the one of sensor k flies on k alone, so "k is healthy" covers
    "the others are a faulty pair" and, where one of them agrees with k, "the third is faulty". An observer on the mean of two
    sensors would be the mean of their observers, for all is linear.

    Model assumed: that of `KalmanGust`. A residual is the lagged size of what phi, V_y and p did not let expect of r. Since
    each observer follows its own sensor, only what contradicts the motion remains: a constant offset is found by its start
    and, with less force, by the turn and sideslip that it would mean. Blind to faults below the gate. Knobs:
    `recipe.filter.r_deg_s`, how little the observers follow their sensors, trades jumps for slow faults; `memory_s` quick
    decisions for sure ones. Cost: 712 operations a sample.

    References
    ----------
    Clark (1978), Instrument fault detection, IEEE Transactions on Aerospace and Electronic Systems 14(3), 456-465; Frank
    (1990), Fault diagnosis in dynamic systems using analytical and knowledge-based redundancy, Automatica 26(3), 459-474.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[observer_bank]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["observer_bank"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "lateral observers, one per yaw-rate sensor; the least surprised one is believed"
    Gains = ObserverBankGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: ObserverBankGains, bus: Bus) -> None:
        self.watches = bus.redundant("r_deg_s", least=3)
        n = len(self.watches)
        self.recorded = tuple(f"residual_{i + 1}" for i in range(n))
        self.observer, self.decision = GustFilter(gains.filter, bus), Nearest.of(gains, bus, n)
        self.share = float(1.0 - exp(np.array(-bus.sample_s / gains.memory_s)))
        self.states = Layout(
            ObserverBankState(
                observers=(self.observer.states.shape,) * n, residual=n, decision=self.decision.states.shape
            )
        )

    @classmethod
    def from_design(cls, gains: ObserverBankGains, bus: Bus) -> "ObserverBank":
        """Detector for a bus with the lateral signals and three or more yaw rates."""
        bus.require(*LATERAL_SIGNALS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> ObserverBankState:
        """In trim."""
        observers = tuple(self.observer.start(c) for _ in self.watches)
        return ObserverBankState(observers=observers, residual=0.0, decision=self.decision.start(c))

    def step(
        self, x: ObserverBankState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[ObserverBankState, Verdict]:
        """Verdict after one sample."""
        now, r_deg_s = lateral(measured), measured.r_deg_s
        observers, surprises = [], []
        for i, observer in enumerate(x.observers):
            e = self.observer.innovation(observer, now, r_deg_s[i] * RAD_PER_DEG)
            after, _ = self.observer.step(observer, c, n, now, e, np.ones_like(e[0]))
            observers.append(after)
            surprises.append(np.abs(product(self.observer.W, e)[3]))
        residual = x.residual + self.share * (np.stack(surprises) - x.residual)
        decided, decision = self.decision.step(x.decision, c, n, r_deg_s, residual)
        shown = {name: residual[i] for i, name in enumerate(self.recorded)}
        state = ObserverBankState(observers=tuple(observers), residual=residual, decision=decided)
        return state, Verdict(decision.declared, decision.residual, signals=shown)
