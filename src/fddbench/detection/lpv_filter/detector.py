"""The bank as a detector: a fault is declared where its estimate stays beyond its threshold."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, largest
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.lpv_filter.channels import require_channels, rows_of
from fddbench.detection.lpv_filter.course import course
from fddbench.detection.lpv_filter.fits import require_fit
from fddbench.detection.lpv_filter.gains import LpvFilterGains
from fddbench.detection.lpv_filter.residual_filter import ResidualFilter, table_of
from fddbench.detection.lpv_filter.sensors import SensorsDecision, SensorsState
from fddbench.detection.lpv_filter.trim_tracker import TrimState, TrimTracker
from fddbench.interfaces import Bus, Scheduling, Verdict

__all__ = ["LpvFilter"]


@record
class LpvFilterState:
    """State of each filter; estimates, and signals, of the sample before; offsets, where they are taken out; the decision."""

    w: tuple[Rows, ...]
    smoothed: Rows
    y: Rows
    u: Rows
    rho: Rows
    begun: Row
    trim: tuple[TrimState, ...]
    held_samples: Rows
    declared: Rows
    sensors: tuple[SensorsState, ...]


class LpvFilter:
    """Declares a site when the estimate of its fault stays beyond its threshold; a declaration is for good.

    Model assumed: the affine model that the filters were designed for, at the parameters that are measured; a constant bank is
    the LTI filter of one flight condition. The other faults of the bank do not reach an estimate, whatever their course; model
    errors do: 5 % of a coefficient is 5 % of all that acts through it, beside a fault that is a share of that. Noisy with
    the rates of the outputs that a filter watches, and with turbulence. Knobs: the decay of the design trades delay for noise,
    the thresholds (``fddbench tune``) false alarms for misses, `trim` slow offsets for slow faults. Cost: a few hundred
    products a sample for two filters of one state with nine parameters.

    **Sensors.** A filter may speak for a sensor (`output` of its entry): it follows the faulty reading, so its estimate is
    that of a fresh fault and is forgotten with the decay. With `sensors` several of one quantity have a filter each, alike but
    for the reading that it takes; what the model misses moves all estimates and no difference of readings, and a sensor is
    declared while it differs from one with a smaller estimate. Faults slower than the decay stay unseen, and common ones.

    References
    ----------
    The LPV detection filter paper, equations (14) and (15); discretisation, estimate and decision are ours.
    """

    about = "gain-scheduled geometric detection filters, an estimate and a threshold per fault"
    estimates = "sites"
    Gains = LpvFilterGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: LpvFilterGains, bus: Bus, scheduling: Scheduling | None) -> None:
        self.outputs, self.inputs, self.scheduling = gains.outputs, gains.inputs, scheduling
        self.bend, self.sample_s = table_of(gains.bend), bus.sample_s
        self.smooth = np.array([0.0 if entry.held else 1.0 for entry in gains.inputs])
        self.filters = tuple(ResidualFilter(entry, bus.sample_s) for entry in gains.filters)
        self.trackers = () if gains.trim is None else (TrimTracker(gains.trim, bus.sample_s),)
        self.watches = tuple(entry.site for entry in gains.filters)
        self.readings = tuple(entry.output for entry in gains.filters)
        self.units = column([entry.unit_per_fault for entry in gains.filters])
        self.thresholds = column(gains.thresholds)
        self.confirm_samples = samples("confirm_s", gains.confirm_s, bus.sample_s)
        self.sensors = tuple(
            SensorsDecision(entry, self.thresholds, confirm_s=gains.confirm_s, sample_s=bus.sample_s)
            for entry in (() if gains.sensors is None else (gains.sensors,))
        )
        suffix = {site.name: site.unit.suffix for site in bus.sites}
        self.evaluated = tuple(f"estimate_{name}{suffix[name]}" for name in self.watches)
        self.shown_thresholds = tuple(f"threshold_{name}{suffix[name]}" for name in self.watches)
        self.recorded = tuple(name for pair in zip(self.evaluated, self.shown_thresholds, strict=True) for name in pair)
        n, n_rho = len(self.watches), 0 if scheduling is None else len(scheduling.parameters)
        self.states = Layout(
            LpvFilterState(
                w=tuple(each.order for each in self.filters), smoothed=n, y=len(gains.outputs), u=len(gains.inputs) or ROW,
                rho=n_rho or ROW, begun=ROW, trim=tuple(each.shape for each in self.trackers),
                held_samples=0 if self.sensors else n, declared=0 if self.sensors else n,
                sensors=tuple(each.states.shape for each in self.sensors),
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: LpvFilterGains, bus: Bus, scheduling: Any = None) -> "LpvFilter":
        """Bank for a bus that has the signals of its channels and of its scheduling, and the sites of its filters."""
        require_channels(gains.outputs, bus, "outputs")
        require_channels(gains.inputs, bus, "inputs")
        made = None if scheduling is None else scheduling()
        if made is not None:
            bus.require(*made.signals)
        require_fit(gains, bus, made)
        return cls(gains, bus, made)

    def start(self, c: Nothing) -> LpvFilterState:
        """Nothing declared; filters begin with the first sample."""
        return LpvFilterState(
            w=tuple(0.0 for _ in self.filters), smoothed=0.0, y=0.0, u=0.0, rho=0.0, begun=0.0,
            trim=tuple(each.start() for each in self.trackers), held_samples=0.0, declared=0.0,
            sensors=tuple(each.start(c) for each in self.sensors),
        )  # fmt: skip

    def step(
        self, x: LpvFilterState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[LpvFilterState, Verdict]:
        """Verdict after one sample."""
        y, u = rows_of(self.outputs, measured, x.begun), rows_of(self.inputs, measured, x.begun)
        rho = x.rho if self.scheduling is None else self.scheduling.rho(measured)
        w, first = self._moved(x, y, u), x.begun < 0.5
        faults = zip(self.filters, w, x.smoothed, strict=True)
        smoothed = np.stack([own.smoothed(before, own.fault(each, y, rho), first) for own, each, before in faults])
        estimate, trims = smoothed, []
        for tracker, offset in zip(self.trackers, x.trim, strict=True):
            trim, estimate = tracker.step(offset, estimate)
            trims.append(trim)
        begun = np.ones_like(x.begun)
        after = replace(x, w=w, smoothed=smoothed, y=y, u=u, rho=rho, begun=begun, trim=tuple(trims))
        after, declared = self._decided(after, c, n, y, estimate)
        shown = {name: estimate[i] for i, name in enumerate(self.evaluated)}
        for i, name in enumerate(self.shown_thresholds):
            shown[name] = np.zeros_like(estimate[i]) + self.thresholds[i]
        residual = largest(np.abs(estimate) / self.thresholds)
        return after, Verdict(declared, residual, signals=shown, estimate=estimate)

    def _decided(
        self, x: LpvFilterState, c: Nothing, n: Nothing, y: Rows, estimate: Rows
    ) -> tuple[LpvFilterState, Rows]:
        """State with the decision, and the declared sites: each by itself, or among sensors."""
        for own, state in zip(self.sensors, x.sensors, strict=True):
            readings = np.stack([y[place] for place in self.readings if place is not None]) * self.units
            sensors, declared = own.step(state, c, n, readings, estimate)
            return replace(x, sensors=(sensors,)), declared
        held = held_samples(x.held_samples, np.abs(estimate) > self.thresholds)
        declared = np.maximum(x.declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        return replace(x, held_samples=held, declared=declared), declared

    def _moved(self, x: LpvFilterState, y: Rows, u: Rows) -> tuple[Rows, ...]:
        """State of every filter at this sample: from the one before, or from its outputs if it is the first."""
        first: Rows = x.begun < 0.5
        between = course((x.y, y), (x.u, u), x.rho, bend=self.bend, smooth=self.smooth, sample_s=self.sample_s)
        return tuple(
            np.where(first, own.begin(y), own.move(w, between, x.rho)) for own, w in zip(self.filters, x.w, strict=True)
        )
