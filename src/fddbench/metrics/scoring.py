"""Scoring inside the flight: extremes and integers only, so that no signal has to be stored.

The conventions are those of the columns in ``fddbench.results.schema``: k0 is the first faulty sample, n the number of
declared sites, onsets and declarations are sample numbers and are compared as such.
"""

from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import total
from fddbench.interfaces import Floats, Verdict

__all__ = ["NEVER", "EventScore", "EventTimes", "ScoreConstants", "ScoreState", "Scoring"]

NEVER = float(2**53)
"""A sample number that no flight reaches; an exact float64."""


@record
class EventTimes:
    """One fault of a scenario: first and last faulty sample (`NEVER`: to the end), and its sites (1 or 0)."""

    first: Row
    last: Row
    own: Rows


@record
class EventScore:
    """First alarm on its own sites and detection of one fault, as samples; 1 where it was declared early."""

    alarm: Row
    detection: Row
    early: Row


@record
class ScoreConstants:
    """First faulty sample, number of faulty sites, last sample of the flight, and the events."""

    k0: Row
    n_faulty: Row
    last: Row
    events: tuple[EventTimes, ...]


@record
class ScoreState:
    """First alarm and detection as samples; flags, largest residuals, final declaration, and the events."""

    first_alarm: Row
    detection: Row
    over_declared: Row
    false_alarm: Row
    margin_healthy: Row
    margin_faulty: Row
    nonfinite: Row
    declared: Rows
    events: tuple[EventScore, ...]


class Scoring:
    """Score of one detector on many flights, as a block that is fed with its verdicts.

    Parameters
    ----------
    n_sites : int
        Fault sites of the benchmark.
    n_events : int
        Faults that are scored on their own, 0 where no scenario has several or ending faults.
    """

    draws: Draws[Any] = NO_DRAWS

    def __init__(self, n_sites: int, n_events: int) -> None:
        self.n_sites, self.n_events = n_sites, n_events
        events = tuple(EventTimes(first=ROW, last=ROW, own=n_sites) for _ in range(n_events))
        scores = tuple(EventScore(alarm=ROW, detection=ROW, early=ROW) for _ in range(n_events))
        self.constants = Layout(ScoreConstants(k0=ROW, n_faulty=ROW, last=ROW, events=events))
        self.states = Layout(
            ScoreState(
                first_alarm=ROW, detection=ROW, over_declared=ROW, false_alarm=ROW, margin_healthy=ROW,
                margin_faulty=ROW, nonfinite=ROW, declared=n_sites, events=scores,
            )
        )  # fmt: skip

    def rows(self, *, k0: float, n_faulty: int, last: float, events: Sequence[EventTimes], n_cases: int) -> Floats:
        """Constant rows of one scenario, (n_rows, n_cases); the sites of an event are a column, (n_sites, 1)."""
        nothing = EventTimes(first=NEVER, last=NEVER, own=0.0)
        own = tuple(events[j] if j < len(events) else nothing for j in range(self.n_events))
        constants = ScoreConstants(k0=k0, n_faulty=float(n_faulty), last=last, events=own)
        packed: Floats = self.constants.pack(self.constants.spread(constants, n_cases), n_cases)
        return packed

    def start(self, c: ScoreConstants) -> ScoreState:
        """Nothing seen yet."""
        del c
        event = EventScore(alarm=NEVER, detection=NEVER, early=0.0)
        return ScoreState(
            first_alarm=NEVER, detection=NEVER, over_declared=0.0, false_alarm=0.0, margin_healthy=0.0,
            margin_faulty=0.0, nonfinite=0.0, declared=0.0, events=(event,) * self.n_events,
        )  # fmt: skip

    def step(
        self, x: ScoreState, c: ScoreConstants, n: Nothing, verdict: Verdict, sample: Row, alive: Row
    ) -> tuple[ScoreState, Row]:
        """Score after one more sample, and the number of declared sites at this one.

        Flights that have departed or ended keep their score. `verdict` has a row for every site of the benchmark, and an alarm.
        """
        del n
        declared = verdict.declared * 1.0  # a plug-in may declare with booleans, whose sum would be a logical or
        alarm = verdict.alarm * 1.0
        number = total(declared)
        active = alive & (sample <= c.last)
        faulty = active & (sample >= c.k0)
        healthy = active & (sample < c.k0)
        # 0 for verdicts of 0 and 1 only; what is anything else, or not a number, is not repaired but said
        odd = total(np.abs(declared * (declared - 1.0))) + np.abs(alarm * (alarm - 1.0))
        sound = (np.abs(verdict.residual) < np.inf) & (odd == 0.0)
        after = ScoreState(
            first_alarm=_first(x.first_alarm, faulty & (alarm > 0.0), sample),
            detection=_first(x.detection, faulty & (number == c.n_faulty), sample),
            over_declared=np.where(faulty & (number > c.n_faulty), 1.0, x.over_declared),
            false_alarm=np.where(healthy & (alarm > 0.0), 1.0, x.false_alarm),
            margin_healthy=np.where(healthy, np.maximum(x.margin_healthy, verdict.residual), x.margin_healthy),
            margin_faulty=np.where(faulty, np.maximum(x.margin_faulty, verdict.residual), x.margin_faulty),
            nonfinite=np.where(active & ~sound, 1.0, x.nonfinite),
            declared=np.where(active, declared, x.declared),
            events=tuple(self._event(x, c, j, declared, sample, active) for j in range(self.n_events)),
        )
        return after, number

    def _event(self, x: ScoreState, c: ScoreConstants, j: int, declared: Rows, sample: Row, active: Row) -> EventScore:
        """First alarm and detection of one fault, on its own sites and in its own interval, and alarms before it."""
        event, score = c.events[j], x.events[j]
        within = active & (sample >= event.first) & (sample <= event.last)
        hits, own = total(declared * event.own), total(event.own)
        # a site that another fault has made faulty is rightly declared before this one
        others = [np.where(sample >= other.first, other.own, 0.0) for i, other in enumerate(c.events) if i != j]
        innocent = event.own * (1.0 - reduce(np.maximum, others, np.zeros_like(event.own)))
        early = active & (sample < event.first) & (total(declared * innocent) > 0.0)
        return EventScore(
            alarm=_first(score.alarm, within & (hits > 0.0), sample),
            detection=_first(score.detection, within & (hits == own), sample),
            early=np.where(early, 1.0, score.early),
        )


def _first(number: Row, condition: Row, sample: Row) -> Row:
    """Sample number at which the condition was first true."""
    return np.where(condition, np.minimum(number, sample), number)
