"""The observer as a detector: a fault is declared where its estimate stays beyond its threshold."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, largest
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.lpv_filter.channels import require_channels, rows_of
from fddbench.detection.lpv_filter.trim_tracker import TrimState, TrimTracker
from fddbench.detection.sliding_mode_observer.gains import SlidingModeObserverGains
from fddbench.detection.sliding_mode_observer.observer import Observer, ObserverState
from fddbench.errors import DesignError, did_you_mean
from fddbench.interfaces import Bus, Scheduling, Verdict

__all__ = ["SlidingModeObserver"]


@record
class SlidingModeObserverState:
    """The observer; estimates after their lags; offsets, where they are taken out; the decision; 1 after the first sample."""

    observer: ObserverState
    smoothed: Rows
    trim: tuple[TrimState, ...]
    held_samples: Rows
    declared: Rows
    begun: Row


class SlidingModeObserver:
    """Declares a site, for good, when the fault that the observer reconstructs stays beyond its threshold.

    Model assumed: an affine model at the parameters that are measured, whose outputs show the faults: faults of sensors by
    filters on the suspect outputs, those of actuators where each moves the rate of an output in a direction of its own. What
    the model misses of the rates of outputs becomes a fault: errors of coefficients, gusts, and the noise of outputs times the
    bandwidth K P_o / delta. A fault of a site that has no estimate becomes one of those that have. Knobs: delta and the lags
    trade noise for delay, the thresholds (``fddbench tune``) false alarms for misses, the weights of the recipe uncertainty
    for noise; `injection` sharpness for chattering. Cost: about n (n + m + 2 p) (n_rho + 1) products a sample.

    References
    ----------
    Edwards, Spurgeon, Patton (2000), Sliding mode observers for fault detection and isolation, Automatica 36(4), 541-553; the
    yaw-rate sliding-mode observer paper of the ADDSAFE project, section 4. The decision is ours.
    """

    about = "LPV sliding-mode observer of any affine model: reconstructs faults of sensors or actuators, a threshold for each"
    Gains = SlidingModeObserverGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: SlidingModeObserverGains, bus: Bus, scheduling: Scheduling | None) -> None:
        self.outputs, self.inputs, self.scheduling = gains.outputs, gains.inputs, scheduling
        self.observer = Observer(gains, bus.sample_s)
        self.units, self.thresholds = column(gains.unit_per_fault), column(gains.thresholds)
        lags = np.array([-bus.sample_s / lag if lag else -np.inf for lag in gains.smooth_s])
        self.shares = column([1.0 - float(exp(np.array(lag))) if np.isfinite(lag) else 1.0 for lag in lags])
        self.trackers = () if gains.trim is None else (TrimTracker(gains.trim, bus.sample_s),)
        self.confirm_samples = samples("confirm_s", gains.confirm_s, bus.sample_s)
        self.isolates, q = gains.isolates, len(gains.sites)
        suffix = {site.name: site.unit.suffix for site in bus.sites}
        self.watches = gains.sites if gains.isolates else bus.names
        self.estimates = "sites" if gains.isolates else None
        self.evaluated = tuple(f"estimate_{name}{suffix.get(name, '')}" for name in gains.sites)
        self.shown_thresholds = tuple(f"threshold_{name}{suffix.get(name, '')}" for name in gains.sites)
        pairs = zip(self.evaluated, self.shown_thresholds, strict=True)
        self.recorded = tuple(name for pair in pairs for name in pair)
        self.states = Layout(
            SlidingModeObserverState(
                observer=self.observer.states.shape, smoothed=q, trim=tuple(each.shape for each in self.trackers),
                held_samples=q, declared=q, begun=ROW,
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: SlidingModeObserverGains, bus: Bus, scheduling: Any = None) -> "SlidingModeObserver":
        """Detector for a bus that has the signals of its channels and of its scheduling, and the sites that it declares."""
        require_channels(gains.outputs, bus, "outputs")
        require_channels(gains.inputs, bus, "inputs")
        made = None if scheduling is None else scheduling()
        if made is not None:
            bus.require(*made.signals)
        n_rho = 0 if made is None else len(made.parameters)
        for name in ("A", "B", "G_l", "strength"):
            members = len(getattr(gains, name) or (0,))
            if members not in (1, n_rho + 1):
                raise DesignError(f"{name} has {members} matrices; with {n_rho} parameters it needs 1 or {n_rho + 1}")
        unknown = [name for name in gains.sites if name not in bus.names] if gains.isolates else []
        if unknown:
            raise DesignError(
                f"sites: this benchmark has no {unknown[0]!r}. {did_you_mean(unknown[0], bus.names)} It has: "
                f"{', '.join(bus.names)}; one that only gives an alarm says isolates: false"
            )
        return cls(gains, bus, made)

    def start(self, c: Nothing) -> SlidingModeObserverState:
        """Nothing declared."""
        del c
        return SlidingModeObserverState(
            observer=self.observer.start(), smoothed=0.0, trim=tuple(each.start() for each in self.trackers),
            held_samples=0.0, declared=0.0, begun=0.0,
        )  # fmt: skip

    def step(
        self, x: SlidingModeObserverState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[SlidingModeObserverState, Verdict]:
        """Verdict after one sample."""
        del c, n
        y, u = rows_of(self.outputs, measured, x.begun), rows_of(self.inputs, measured, x.begun)
        rho = x.smoothed if self.scheduling is None else self.scheduling.rho(measured)
        observer, fault = self.observer.step(x.observer, y, u, rho, x.begun < 0.5)
        smoothed = x.smoothed + self.shares * (self.units * fault - x.smoothed)
        estimate, trims = smoothed, []
        for tracker, offset in zip(self.trackers, x.trim, strict=True):
            trim, estimate = tracker.step(offset, estimate)
            trims.append(trim)
        held = held_samples(x.held_samples, np.abs(estimate) > self.thresholds)
        declared = np.maximum(x.declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        shown = {name: estimate[i] for i, name in enumerate(self.evaluated)}
        for i, name in enumerate(self.shown_thresholds):
            shown[name] = np.zeros_like(estimate[i]) + self.thresholds[i]
        after = SlidingModeObserverState(
            observer=observer, smoothed=smoothed, trim=tuple(trims), held_samples=held, declared=declared,
            begun=np.ones_like(x.begun),
        )  # fmt: skip
        residual = largest(np.abs(estimate) / self.thresholds)
        if not self.isolates:
            return after, Verdict(None, residual, signals=shown, alarm=largest(declared))
        return after, Verdict(declared, residual, signals=shown, estimate=estimate)
