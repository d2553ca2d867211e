"""A detector that steps at every n-th sample and holds its decision between, as one on a slower clock does."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from fddbench.blocks.block import Part
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, mapped, record
from fddbench.blocks.primitives import Symbolic, rarely
from fddbench.interfaces import Verdict

__all__ = ["Hold", "HoldState"]


@record
class Held:
    """What was decided at the last step; `Nothing` of what a detector does not give."""

    declared: Part
    residual: Row
    alarm: Row
    estimate: Part
    signals: tuple[Row, ...]


@record
class HoldState:
    """Samples since the last step, 0 where the next one is due; state of the detector; its decision."""

    since: Row
    own: Part
    held: Held


class Hold:
    """Steps at the samples 0, n, 2n, …; between them the verdict is that of the last step.

    What the detector does is compiled behind a branch that is taken at every n-th sample.

    Parameters
    ----------
    every : int
        n.
    own : Layout
        States of the detector.
    names : sequence of str
        All sites of the benchmark.
    watches : sequence of str
        Those that the detector declares; the others are never, and are not kept.
    isolates, sizes : bool
        Whether it declares sites, and whether its estimate has a row for each.
    estimates : bool
        Whether it gives an estimate.
    recorded : sequence of str
        Names of what it shows.
    """

    def __init__(
        self, every: int, own: Layout[Any], names: Sequence[str], watches: Sequence[str], *,
        isolates: bool, estimates: bool, sizes: bool, recorded: Sequence[str],
    ) -> None:  # fmt: skip
        self.every, self.own, self.recorded, self.sizes = every, own, tuple(recorded), sizes
        self.rows = [names.index(name) for name in watches] if isolates or sizes else []
        self.n_sites, self.isolates, self.estimates = len(names), isolates, estimates
        rows: Part = len(self.rows) or Nothing()
        held = Held(
            declared=rows if isolates else Nothing(),
            residual=ROW,
            alarm=ROW,
            estimate=(rows if sizes else ROW) if estimates else Nothing(),
            signals=(ROW,) * len(self.recorded),
        )
        self.states = Layout(HoldState(since=ROW, own=own.shape, held=held))

    def start(self, own: Any) -> HoldState:
        """Nothing decided, the first step due."""
        return HoldState(since=0.0, own=own, held=mapped(lambda _: 0.0, self.states.shape.held))

    def step(self, x: HoldState, own_step: Callable[[Any], tuple[Any, Verdict]]) -> tuple[HoldState, Verdict]:
        """State after a sample, and the verdict on it.

        Parameters
        ----------
        own_step : callable
            Step of the detector from a state, with a verdict on all sites.
        """
        since = np.where(x.since + 1.0 >= float(self.every), 0.0, x.since + 1.0)
        if not isinstance(x.since, Symbolic) and np.all(x.since > 0.0):
            # the same bits; a detector that is not compiled is not asked for what nobody uses
            return HoldState(since=since, own=x.own, held=x.held), self._verdict(x.held)
        due = rarely(x.since <= 0.0)
        own, fresh = own_step(x.own)
        own, held = (
            mapped(lambda new, old: np.where(due, new, old), after, before)
            for after, before in ((self.own.ordered(own), x.own), (self._held(fresh), x.held))
        )
        return HoldState(since=since, own=own, held=held), self._verdict(held)

    def _held(self, verdict: Verdict) -> Held:
        """What is kept of a verdict on all sites."""
        return Held(
            declared=self._watched(verdict.declared) if self.isolates else Nothing(),
            residual=verdict.residual,
            alarm=verdict.alarm * 1.0,
            estimate=(self._watched(verdict.estimate) if self.sizes else verdict.estimate)
            if self.estimates
            else Nothing(),
            signals=tuple(verdict.signals[name] + np.zeros_like(verdict.residual) for name in self.recorded),
        )

    def _watched(self, everywhere: Any) -> Part:
        return everywhere[self.rows] * 1.0 if self.rows else Nothing()

    def _verdict(self, held: Held) -> Verdict:
        """The verdict on all sites again."""
        zero = np.zeros_like(held.residual)
        return Verdict(
            self._everywhere(held.declared if self.isolates else Nothing(), zero),
            held.residual,
            signals=dict(zip(self.recorded, held.signals, strict=True)),
            alarm=held.alarm,
            estimate=(self._everywhere(held.estimate, zero) if self.sizes else held.estimate)
            if self.estimates
            else None,
        )

    def _everywhere(self, watched: Part, zero: Row) -> Any:
        """Rows of all sites, 0 where the detector does not watch."""
        own: dict[int, Row] = {} if isinstance(watched, Nothing) else dict(zip(self.rows, watched, strict=True))
        rows: list[Row] = [own.get(site, zero) for site in range(self.n_sites)]
        return np.stack(rows)
