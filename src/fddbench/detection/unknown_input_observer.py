"""Observers of the yaw rate that no gust can move, one for every sensor."""

from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column, product, total
from fddbench.detection.decision import Nearest, NearestGains, NearestState
from fddbench.detection.gust_filter import LATERAL_SIGNALS, Lateral, lateral
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict
from fddbench.units import RAD_PER_DEG

__all__ = ["UnknownInputObserver", "UnknownInputObserverGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Row3 = Annotated[tuple[Number, ...], Field(min_length=3, max_length=3)]


class UnknownInputObserverGains(NearestGains):
    """Numbers of the decision, and of the observers of phi [rad], p and r [rad/s].

    Attributes
    ----------
    sample_s : float
        Clock of the gains [s].
    K : 3 x 3 matrix
        Correction by the innovations of phi, p and r.
    w : 3 numbers
        Residual ``w e`` of the innovations, of unit variance as designed.
    memory_s : float
        Lag on the size of the residuals [s].
    """

    sample_s: Positive
    K: Annotated[tuple[Row3, ...], Field(min_length=3, max_length=3)]
    w: Row3
    memory_s: Positive


@record
class UnknownInputObserverState:
    """phi, p and r of the observers, one after the other; lagged residuals [-]; the decision."""

    z: tuple[Rows, ...]
    residual: Rows
    decision: NearestState


class UnknownInputObserver:
    """Believes the sensor whose observer is surprised least, and accuses whoever differs from it; no gust moves an observer.

    A gust enters the lateral motion by its change alone, in the rate of the air-relative V_y. V_y is measured, so
    ``rank(C E) = rank(E) = 1``, and what is left, phi, p and r driven by the measured V_y, is detectable: the unknown input is
    gone exactly, whatever its spectrum, and with it all that the side-force equation could say. `fddbench design` checks both
    conditions at every vertex.

    Model assumed: the roll and yaw rows of the lateral LPV model, scheduled by measured values; white noise. Blind to faults
    below the gate; a constant fault is found by its start, for an observer follows its sensor within a second or so. Off with
    errors of the moments, which it cannot tell from a fault of its sensor. Knobs: those of `ObserverBank`. Cost: 478
    operations a sample.

    References
    ----------
    Watanabe, Himmelblau (1982), Instrument fault detection in systems with uncertainties, International Journal of Systems
    Science 13(2), 137-158; Chen, Patton, Zhang (1996), Design of unknown input observers and robust fault detection filters,
    International Journal of Control 63(1), 85-105.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[unknown_input_observer]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["unknown_input_observer"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "observers that the gust cannot move, one for every yaw-rate sensor"
    Gains = UnknownInputObserverGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: UnknownInputObserverGains, bus: Bus) -> None:
        self.watches = bus.redundant("r_deg_s", least=3)
        n, self.sample_s = len(self.watches), bus.sample_s
        self.recorded = tuple(f"residual_{i + 1}" for i in range(n))
        self.K, self.w, self.decision = column(gains.K), gains.w, Nearest.of(gains, bus, n)
        self.share = float(1.0 - exp(np.array(-bus.sample_s / gains.memory_s)))
        self.states = Layout(UnknownInputObserverState(z=(3,) * n, residual=n, decision=self.decision.states.shape))

    @classmethod
    def from_design(cls, gains: UnknownInputObserverGains, bus: Bus) -> "UnknownInputObserver":
        """Detector for a bus with the lateral signals, three or more yaw rates, and the clock of its gains."""
        bus.require(*LATERAL_SIGNALS)
        if abs(gains.sample_s - bus.sample_s) > 1e-9:
            raise DesignError(
                f"sample_s: these gains are for {gains.sample_s} s, this campaign has {bus.sample_s}; design it anew"
            )
        return cls(gains, bus)

    def start(self, c: Nothing) -> UnknownInputObserverState:
        """In trim."""
        z = (0.0,) * len(self.watches)
        return UnknownInputObserverState(z=z, residual=0.0, decision=self.decision.start(c))

    def step(
        self, x: UnknownInputObserverState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[UnknownInputObserverState, Verdict]:
        """Verdict after one sample."""
        now, r_deg_s = lateral(measured), measured.r_deg_s
        observers, sizes = [], []
        for i, z in enumerate(x.z):
            e = np.stack([now.y[0] - z[0], now.y[2] - z[1], r_deg_s[i] * RAD_PER_DEG - z[2]])
            observers.append(self._moved(z + product(self.K, e), now))
            sizes.append(np.abs(total([self.w[j] * e[j] for j in range(3)])))
        residual = x.residual + self.share * (np.stack(sizes) - x.residual)
        decided, decision = self.decision.step(x.decision, c, n, r_deg_s, residual)
        shown = {name: residual[i] for i, name in enumerate(self.recorded)}
        state = UnknownInputObserverState(z=tuple(observers), residual=residual, decision=decided)
        return state, Verdict(decision.declared, decision.residual, signals=shown)

    def _moved(self, z: Rows, now: Lateral) -> Rows:
        """phi, p and r a sample later; the sideslip is the measured one, whatever moves it."""
        x = np.stack([z[0], now.y[1], z[1], z[2]])
        rate = [total([now.A[row, j] * x[j] for j in range(4)]) + now.rates[row] for row in (0, 2, 3)]
        return z + self.sample_s * np.stack(rate)
