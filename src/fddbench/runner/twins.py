"""Healthy twins: what a faulty flight would have been without its faults, flown once for all flights that share it.

A twin has the point, the run and the manoeuvre of its flights, no faults and no detectors, so nobody acts on anything. It is
recorded stretch by stretch, and what is kept of it for a flight counts from that flight's k0 to its last scored sample; so
flights with different onsets, ends and departures share one. Twins are found anew in each chunk: cuts change no number.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Scenario
from fddbench.campaign.plan import Plan, plan
from fddbench.interfaces import NEVER, Floats
from fddbench.metrics.consequences import Consequences, begin_of
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembling import loop_of
from fddbench.runner.assembly import Assembly, Batch

__all__ = ["Kept", "Pairs", "healthy_twins", "paired"]

Numbers = npt.NDArray[np.int64]


def healthy_twins(assembly: Assembly) -> Assembly:
    """What flies the twins of a campaign: its loop without faults, one scenario a manoeuvre, as long as its longest."""
    planned, campaign = assembly.plan, assembly.plan.campaign
    scenarios = []
    for manoeuvre in dict.fromkeys(each.manoeuvre for each in planned.scenarios):
        own = [each for each in planned.scenarios if each.manoeuvre == manoeuvre]
        entry = own[0].scenario.entry.model_copy(
            update={
                "name": manoeuvre,
                "faults": (),
                "runs": max(each.n_runs for each in own),
                "duration_s": max(max(each.durations_s) for each in own),
                "detection_time_limit_s": None,
            }
        )
        scenarios.append(Scenario(entry=entry, faults=()))
    twins = plan(replace(campaign, scenarios=tuple(scenarios), designs=(), reconfigure=""))
    loop = loop_of(twins)
    return Assembly(plan=twins, loop=loop, detectors={}, scoring=Scoring(loop.bus.names, 0, campaign.sample_s))


@dataclass(frozen=True, kw_only=True, eq=False)
class Pairs:
    """Faulty flights of a batch and their twins.

    Attributes
    ----------
    which : (n,) array
        Places of the flights in their batch.
    twin : (n,) array
        Place of the twin of each.
    begin, end : (n,) arrays
        First sample that counts, and the last that is scored, of each.
    cases : (n_twins,) array
        Numbers of the twins in their plan.
    """

    which: Numbers
    twin: Numbers
    begin: Floats
    end: Floats
    cases: Numbers


def paired(planned: Plan, twins: Plan, batch: Batch, *, last_scored: Floats) -> Pairs:
    """Flights of a batch with at least one faulty sample that is scored, and the twins that they need, each once."""
    k0 = batch.faults.k0
    which = np.flatnonzero((k0 < NEVER) & (last_scored >= k0))
    first = {each.name: each.first_case for each in twins.scenarios}
    runs = {each.name: each.n_runs for each in twins.scenarios}
    flown = [each.manoeuvre for each in planned.scenarios]
    of = batch.scenario[which]
    begins, n_runs = (np.array([named[name] for name in flown], dtype=np.int64)[of] for named in (first, runs))
    numbers = begins + batch.point[which] * n_runs + batch.run[which]
    cases, twin = np.unique(numbers, return_inverse=True)
    return Pairs(which=which, twin=twin.ravel(), begin=begin_of(k0[which]), end=last_scored[which], cases=cases)


class Kept:
    """What is kept of twins for their flights, fed with recordings stretch by stretch.

    Parameters
    ----------
    announced : Consequences
        Of the loop.
    pairs : Pairs
        Flights and twins.
    """

    def __init__(self, announced: Consequences, pairs: Pairs) -> None:
        self.announced, self.pairs = announced, pairs
        n, n_twins = len(pairs.which), len(pairs.cases)
        self.peaks = np.zeros((len(announced.peaks), n))
        self.ends = np.zeros((len(announced.errors), n))
        self.sums = np.zeros((len(announced.rises), 2, n))
        self.running = np.zeros((len(announced.rises), n_twins))

    def feed(self, first: int, signals: Mapping[str, Floats]) -> None:
        """Take a stretch of samples, from `first` on, (n_time, n_twins) each."""
        for row, each in enumerate(self.announced.peaks):
            self._peak(self.peaks[row], first, np.abs(signals[each.signal]))
        for row, each in enumerate(self.announced.errors):
            self._at(self.ends[row], first, signals[each.signal], self.pairs.end)
        for row, each in enumerate(self.announced.rises):
            together = np.cumsum(np.vstack([self.running[row], signals[each.signal]]), axis=0)[1:]
            self.running[row] = together[-1]
            self._at(self.sums[row, 0], first, together, self.pairs.end)
            self._at(self.sums[row, 1], first, together, self.pairs.begin - 1.0)

    def _at(self, kept: Floats, first: int, rows: Floats, sample: Floats) -> None:
        """Keep what stands at a sample of each flight, where that lies in this stretch."""
        place = sample - first
        here = np.flatnonzero((place >= 0.0) & (place < len(rows)))
        kept[here] = rows[place[here].astype(np.int64), self.pairs.twin[here]]

    def _peak(self, kept: Floats, first: int, rows: Floats) -> None:
        """Keep the largest of each flight in its part of this stretch; extremes of beginnings and ends are found once."""
        low = np.maximum(self.pairs.begin - first, 0.0).astype(np.int64)
        high = np.minimum(self.pairs.end - first, len(rows) - 1.0).astype(np.int64)
        so_far, to_come = (
            np.maximum.accumulate(rows, axis=0),
            np.maximum.accumulate(rows[::-1], axis=0)[::-1],
        )
        for i in np.flatnonzero((low > 0) & (high < len(rows) - 1) & (low <= high)).tolist():
            kept[i] = max(kept[i], rows[low[i] : high[i] + 1, self.pairs.twin[i]].max())
        for part, here, place in (
            (so_far, (low == 0) & (high >= 0), high),
            (to_come, (low > 0) & (low < len(rows)) & (high == len(rows) - 1), low),
        ):
            mine = np.flatnonzero(here)
            kept[mine] = np.maximum(kept[mine], part[place[mine], self.pairs.twin[mine]])

    def rows(self, n_cases: int, alive: npt.NDArray[np.bool_]) -> Floats:
        """All that is kept by the layout of `announced`, (n_rows, n_cases); not-a-number where a twin was not `alive`."""
        packed = np.full((self.announced.states.size, n_cases), np.nan)
        own = np.concatenate([self.peaks, self.ends, *self.sums])
        packed[:, self.pairs.which] = np.where(alive, own, np.nan)
        return packed
