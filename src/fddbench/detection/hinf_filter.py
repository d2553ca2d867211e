"""Residual filter given by its matrices, with an evaluation that isolates: residual i speaks for fault i."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.detection.lpv_filter.channels import require_channels, rows_of
from fddbench.detection.lpv_filter.gains import ChannelEntry, SensorsEntry
from fddbench.detection.lpv_filter.sensors import SensorsDecision, SensorsState
from fddbench.detection.mean_test import MeanTest, MeanTestState, watched
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict
from fddbench.systems import DiscreteLti, StateSpace

__all__ = ["HinfFilter", "HinfFilterGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Matrix = tuple[tuple[Number, ...], ...]

_SIDES = {
    "A": ("x", "x"), "B_y": ("x", "y"), "B_u": ("x", "u"), "C": ("r", "x"), "D_y": ("r", "y"), "D_u": ("r", "u"),
}  # fmt: skip
"""Rows and columns of each matrix: states, residuals, outputs y and inputs u."""


class HinfFilterGains(BaseModel):
    """Filter in continuous time and its evaluation.

    Attributes
    ----------
    A, B_y, B_u, C, D_y, D_u : matrices
        ``x' = A x + B_y y + B_u u``, ``r = C x + D_y y + D_u u``; one residual per fault site.
    window_s : float
        Length of the moving mean of every residual [s].
    thresholds : numbers
        Largest |mean| of each residual that is no alarm, in the unit of the residual.
    confirm_s : float
        How long a mean must stay beyond its threshold [s].
    estimates_faults : bool
        Whether residual i is made to be fault i itself (T_ref = I), so that its mean estimates the size.
    outputs, inputs : channels or None
        What y and u are on the bus; None: its signals y and u.
    sites : names or None
        Site of each residual; None: all of the kind of the first.
    about_first : bool
        Whether y and u are taken as deviations from the first sample: a linear filter about the trim that a flight begins in.
        A fault that is there already belongs to that trim.
    sensors : SensorsEntry or None
        Output i and residual i are of redundant sensor i: one is suspected only while it differs from one with a smaller
        residual. None: each residual by itself.
    """

    THRESHOLDS: ClassVar = {"thresholds": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    A: Matrix
    B_y: Matrix
    B_u: Matrix
    C: Matrix
    D_y: Matrix
    D_u: Matrix
    window_s: Positive
    thresholds: Annotated[tuple[Positive, ...], Field(min_length=1)]
    confirm_s: NonNegative
    estimates_faults: bool = False
    outputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)] | None = None
    inputs: tuple[ChannelEntry, ...] | None = None
    sites: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    about_first: bool = False
    sensors: SensorsEntry | None = None


@record
class Trim:
    """Outputs and inputs of the first sample, and 1 once there has been one."""

    first: Rows
    begun: Row


@record
class FilterState:
    """State of the filter; of the decision on its residuals; of that among sensors; the trim where it is taken off."""

    filter: Rows
    test: MeanTestState
    sensors: tuple[SensorsState, ...]
    trim: tuple[Trim, ...]


class HinfFilter:
    """Declares fault i when the moving mean of residual i stays beyond its threshold; a declaration is for good.

    Model assumed: the linear plant that the filter was designed for, whatever the design: robust H∞ filters and exact
    inverses are the same kind with other numbers. Blind to what its window averages out; noisy with disturbances in the
    direction of the faults, and off by the uncertainty times the inputs. Knobs: the window trades noise for delay, the
    thresholds (``fddbench tune``) false alarms for misses. Cost: (n_x + n_r) (n_x + n_y + n_u) products, and one sum per
    sample of the window and residual.

    Of redundant sensors (`sensors`) the residuals are compared: what the model misses is in all of them alike. An H∞ filter of
    a set of plants trusts its model above the frequency at which the worst of them is wrong; below it follows the sensors, so a
    fault common to several is forgotten, as the reference T_ref = s / (s + a) says beforehand.

    References
    ----------
    Robust fault detection and isolation by linear matrix inequalities with an optimal reference model, eq (8); moving
    mean and decision are ours.
    """

    about = "residual filter by its matrices, moving mean and a threshold per residual"
    Gains = HinfFilterGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: HinfFilterGains, bus: Bus) -> None:
        g = {name: np.array(getattr(gains, name), dtype=float) for name in _SIDES}
        system = StateSpace(g["A"], np.hstack([g["B_y"], g["B_u"]]), g["C"], np.hstack([g["D_y"], g["D_u"]]))
        self.filter = DiscreteLti.of(system, bus.sample_s)
        self.test = MeanTest(
            gains.thresholds,
            window_s=gains.window_s,
            confirm_s=gains.confirm_s,
            estimates=gains.estimates_faults,
            bus=bus,
        )
        self.sensors = tuple(
            SensorsDecision(entry, self.test.thresholds, confirm_s=gains.confirm_s, sample_s=bus.sample_s)
            for entry in (() if gains.sensors is None else (gains.sensors,))
        )
        self.outputs, self.inputs = gains.outputs, gains.inputs or ()
        self.watches, self.confirm_samples = _watched(bus, gains), self.test.confirm_samples
        self.estimates = "sites" if gains.estimates_faults else None
        self.evaluated, self.recorded = self.test.evaluated, self.test.recorded
        kept = tuple(each.states.shape for each in self.sensors)
        signals = g["B_y"].shape[1] + g["B_u"].shape[1]
        trim = (Trim(first=signals, begun=ROW),) if gains.about_first else ()
        self.states = Layout(FilterState(filter=len(g["A"]), test=self.test.states.shape, sensors=kept, trim=trim))
        self.about_first = gains.about_first

    @classmethod
    def from_design(cls, gains: HinfFilterGains, bus: Bus) -> "HinfFilter":
        """Filter for a bus with its outputs and inputs; refuses matrices that do not fit and unstable filters."""
        sizes = {"x": len(gains.A), **_signals(bus, gains), "r": len(_watched(bus, gains))}
        for name, (rows, columns) in _SIDES.items():
            found, need = _shape(getattr(gains, name)), (sizes[rows], sizes[columns])
            if found != need:
                raise DesignError(f"{name} is {found[0]} x {found[1]}, needs {need[0]} x {need[1]} on this benchmark")
        if len(gains.thresholds) != sizes["r"]:
            raise DesignError(f"{len(gains.thresholds)} thresholds for {sizes['r']} fault sites; give one for each")
        poles = np.linalg.eigvals(np.array(gains.A))
        if np.any(poles.real >= 0.0):
            raise DesignError(
                f"this filter diverges: A has poles {np.round(poles, 4).tolist()} in continuous time, all real parts "
                "must be negative. Were the matrices designed in discrete time?"
            )
        return cls(gains, bus)

    def start(self, c: Nothing) -> FilterState:
        """Nothing declared, filter at rest."""
        kept = tuple(each.start(c) for each in self.sensors)
        trim = (Trim(first=0.0, begun=0.0),) if self.about_first else ()
        return FilterState(filter=0.0, test=self.test.start(c), sensors=kept, trim=trim)

    def step(self, x: FilterState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[FilterState, Verdict]:
        """Verdict after one sample."""
        y, u = self._seen(measured, x.test.window[0])
        seen, kept = np.concatenate([y, u]), []
        for trim in x.trim:
            first = np.where(trim.begun > 0.5, trim.first, seen)
            kept.append(Trim(first=first, begun=np.ones_like(trim.begun)))
            seen = seen - first
        filtered, residual = self.filter.step(x.filter, seen)
        test, verdict = self.test.step(x.test, c, n, residual)
        after = replace(x, filter=filtered, test=test, trim=tuple(kept))
        for own, state in zip(self.sensors, x.sensors, strict=True):
            means = np.stack([verdict.signals[name] for name in self.evaluated])
            sensors, declared = own.step(state, c, n, y, means)
            after, verdict = replace(after, sensors=(sensors,)), replace(verdict, declared=declared)
        return after, verdict

    def _seen(self, measured: SimpleNamespace, like: Row) -> tuple[Rows, Rows]:
        """Outputs and inputs of one sample."""
        if self.outputs is None:
            return measured.y, measured.u
        return rows_of(self.outputs, measured, like), rows_of(self.inputs, measured, like)


def _signals(bus: Bus, gains: HinfFilterGains) -> dict[str, int]:
    """Numbers of outputs y and inputs u that this bus gives."""
    if (gains.outputs is None) != (gains.inputs is None):
        raise DesignError("outputs and inputs are given both, or neither: then they are the signals y and u of the bus")
    if gains.outputs is None:
        bus.require("y", "u")
        return {"y": bus.signals["y"], "u": bus.signals["u"]}
    require_channels(gains.outputs, bus, "outputs")
    require_channels(gains.inputs or (), bus, "inputs")
    found = {"y": len(gains.outputs), "u": len(gains.inputs or ())}
    if gains.sensors is not None and found["y"] != len(gains.thresholds):
        raise DesignError(
            f"sensors: {found['y']} outputs for {len(gains.thresholds)} residuals; each sensor has one of both"
        )
    return found


def _watched(bus: Bus, gains: HinfFilterGains) -> tuple[str, ...]:
    """Sites that the residuals speak for: those that are named, else those of the kind of the first one."""
    if gains.sites is not None:
        unknown = [name for name in gains.sites if name not in bus.names]
        if unknown:
            raise DesignError(f"sites: {', '.join(unknown)} is not on this benchmark; it has {', '.join(bus.names)}")
        return gains.sites
    return watched(bus)


def _shape(matrix: Matrix) -> tuple[int, int]:
    """Rows and columns; -1 columns where the rows differ in length."""
    lengths = {len(row) for row in matrix}
    return len(matrix), lengths.pop() if len(lengths) == 1 else -1
