"""Residual filter given by its matrices, with an evaluation that isolates: residual i speaks for fault i."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column, largest, total
from fddbench.detection.confirmation import held_samples, samples
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


@record
class FilterState:
    """State of the filter; the last residuals, sample after sample; for how long each mean has exceeded; declarations."""

    filter: Rows
    window: Rows
    held_samples: Rows
    declared: Rows


class HinfFilter:
    """Declares fault i when the moving mean of residual i stays beyond its threshold; a declaration is for good.

    Model assumed: the linear plant that the filter was designed for, whatever the design: robust H∞ filters and exact
    inverses are the same kind with other numbers. Blind to what its window averages out; noisy with disturbances in the
    direction of the faults, and off by the uncertainty times the inputs. Knobs: the window trades noise for delay, the
    thresholds (``fddbench tune``) false alarms for misses. Cost: (n_x + n_r) (n_x + n_y + n_u) products, and one sum per
    sample of the window and residual.

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
        self.n_residuals, self.thresholds = len(gains.thresholds), column(gains.thresholds)
        self.window = int(samples("window_s", gains.window_s, bus.sample_s, least=1))
        self.confirm_samples = samples("confirm_s", gains.confirm_s, bus.sample_s)
        n, self.watches = self.n_residuals, _watched(bus)
        self.estimates = "sites" if gains.estimates_faults else None
        self.evaluated = tuple(f"mean_{i + 1}" for i in range(n))
        self.recorded = tuple(f"{name}_{i + 1}" for i in range(n) for name in ("mean", "threshold"))
        self.states = Layout(FilterState(filter=len(g["A"]), window=n * self.window, held_samples=n, declared=n))

    @classmethod
    def from_design(cls, gains: HinfFilterGains, bus: Bus) -> "HinfFilter":
        """Filter for a bus with outputs y and inputs u; refuses matrices that do not fit and unstable filters."""
        bus.require("y", "u")
        sizes = {"x": len(gains.A), "y": bus.signals["y"], "u": bus.signals["u"], "r": len(_watched(bus))}
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
        del c
        return FilterState(filter=0.0, window=0.0, held_samples=0.0, declared=0.0)

    def step(self, x: FilterState, c: Nothing, n: Nothing, measured: SimpleNamespace) -> tuple[FilterState, Verdict]:
        """Verdict after one sample."""
        del c, n
        n_r = self.n_residuals
        filtered, residual = self.filter.step(x.filter, np.concatenate([measured.y, measured.u]))
        window = np.concatenate([residual, x.window[:-n_r]])
        mean = total([window[n_r * j : n_r * (j + 1)] for j in range(self.window)]) / float(self.window)
        held = held_samples(x.held_samples, np.abs(mean) > self.thresholds)
        declared = np.maximum(x.declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        after = FilterState(filter=filtered, window=window, held_samples=held, declared=declared)
        shown = {name: mean[i] for i, name in enumerate(self.evaluated)}
        shown |= {f"threshold_{i + 1}": np.zeros_like(mean[i]) + self.thresholds[i] for i in range(n_r)}
        sizes = mean if self.estimates else None
        return after, Verdict(declared, largest(np.abs(mean) / self.thresholds), signals=shown, estimate=sizes)


def _watched(bus: Bus) -> tuple[str, ...]:
    """Sites that the residuals speak for: those of the kind of the first one."""
    return bus.sites_of(bus.sites[0].kind) if bus.sites else ()


def _shape(matrix: Matrix) -> tuple[int, int]:
    """Rows and columns; -1 columns where the rows differ in length."""
    lengths = {len(row) for row in matrix}
    return len(matrix), lengths.pop() if len(lengths) == 1 else -1
