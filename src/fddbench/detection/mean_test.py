"""The decision on residuals that speak for a site each: a moving mean, a threshold, a confirmation time."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column, largest, total
from fddbench.detection.confirmation import held_samples, samples
from fddbench.interfaces import Bus, Verdict

__all__ = ["MeanTest", "MeanTestState", "watched"]


@record
class MeanTestState:
    """The last residuals, sample after sample; for how long each mean has exceeded; declarations."""

    window: Rows
    held_samples: Rows
    declared: Rows


class MeanTest:
    """Declares site i, for good, when the moving mean of residual i stays beyond its threshold.

    Parameters
    ----------
    thresholds : sequence of float
        Largest |mean| of each residual that is no alarm.
    window_s, confirm_s : float
        Length of the mean, and how long it must stay beyond [s].
    estimates : bool
        Whether a mean estimates the size of its fault.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(
        self, thresholds: tuple[float, ...], *, window_s: float, confirm_s: float, estimates: bool, bus: Bus
    ) -> None:
        self.n_residuals, self.thresholds, self.estimates = len(thresholds), column(thresholds), estimates
        self.window = int(samples("window_s", window_s, bus.sample_s, least=1))
        self.confirm_samples = samples("confirm_s", confirm_s, bus.sample_s)
        n = self.n_residuals
        self.evaluated = tuple(f"mean_{i + 1}" for i in range(n))
        self.recorded = tuple(f"{name}_{i + 1}" for i in range(n) for name in ("mean", "threshold"))
        self.states = Layout(MeanTestState(window=n * self.window, held_samples=n, declared=n))

    def start(self, c: Nothing) -> MeanTestState:
        """Nothing declared."""
        del c
        return MeanTestState(window=0.0, held_samples=0.0, declared=0.0)

    def step(self, x: MeanTestState, c: Nothing, n: Nothing, residual: Rows) -> tuple[MeanTestState, Verdict]:
        """State and verdict of the residuals at this sample, (n_residuals, n_cases)."""
        del c, n
        n_r = self.n_residuals
        window = np.concatenate([residual, x.window[:-n_r]])
        mean = total([window[n_r * j : n_r * (j + 1)] for j in range(self.window)]) / float(self.window)
        held = held_samples(x.held_samples, np.abs(mean) > self.thresholds)
        declared = np.maximum(x.declared, np.where(held - 1.0 >= self.confirm_samples, 1.0, 0.0))
        shown = {name: mean[i] for i, name in enumerate(self.evaluated)}
        shown |= {f"threshold_{i + 1}": np.zeros_like(mean[i]) + self.thresholds[i] for i in range(n_r)}
        sizes = mean if self.estimates else None
        verdict = Verdict(declared, largest(np.abs(mean) / self.thresholds), signals=shown, estimate=sizes)
        return MeanTestState(window=window, held_samples=held, declared=declared), verdict


def watched(bus: Bus) -> tuple[str, ...]:
    """Sites that the residuals speak for: those of the kind of the first one."""
    return bus.sites_of(bus.sites[0].kind) if bus.sites else ()
