"""Scoring inside the flight: extremes and integers only, so that no signal has to be stored.

The conventions are those of the columns in ``fddbench.results.schema``: k0 is the first faulty sample, n the number of
declared sites, onsets and declarations are sample numbers and are compared as such.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from fddbench.blocks.layout import Layout, Rows
from fddbench.blocks.linear import total
from fddbench.interfaces import Floats, Verdict

__all__ = ["NEVER", "EventTimes", "Scoring"]

NEVER = float(2**53)
"""A sample number that no flight reaches; an exact float64."""


@dataclass(frozen=True)
class EventTimes:
    """One fault of a scenario: first and last faulty sample (`NEVER`: to the end), and its sites (1 or 0)."""

    first: float
    last: float
    own: tuple[float, ...]


class Scoring:
    """Score of one detector on many flights.

    Parameters
    ----------
    n_sites : int
        Fault sites of the benchmark.
    n_events : int
        Faults that are scored on their own, 0 where no scenario has several or ending faults.
    """

    def __init__(self, n_sites: int, n_events: int) -> None:
        self.n_sites, self.n_events = n_sites, n_events
        event = Layout(first=0, last=0, own=n_sites)
        self.event = event
        self.constants = Layout(k0=0, n_faulty=0, last=0, **{f"event_{j}": event.size for j in range(n_events)})
        self.states = Layout(
            first_alarm=0, detection=0, over_declared=0, false_alarm=0, margin_healthy=0, margin_faulty=0, nonfinite=0,
            declared=n_sites,
            **{f"{name}_{j}": 0 for j in range(n_events) for name in ("event_alarm", "event_detection", "early")},
        )  # fmt: skip

    def rows(self, *, k0: float, n_faulty: int, last: float, events: Sequence[EventTimes], n_cases: int) -> Floats:
        """Constant rows of one scenario, (n_rows, n_cases)."""
        named: dict[str, Floats] = {"k0": np.array(k0), "n_faulty": np.array(float(n_faulty)), "last": np.array(last)}
        nothing = EventTimes(NEVER, NEVER, (0.0,) * self.n_sites)
        for j in range(self.n_events):
            event = events[j] if j < len(events) else nothing
            named[f"event_{j}"] = np.array([event.first, event.last, *event.own])
        packed: Floats = self.constants.pack(**named)
        return np.repeat(packed[:, np.newaxis], n_cases, axis=1)

    def start(self, n_cases: int) -> Floats:
        """Nothing seen yet."""
        x = self.states.unpack(state := self.states.zeros(n_cases))
        for name in ("first_alarm", "detection", *(n for n in self.states.fields if n.startswith("event_"))):
            getattr(x, name)[...] = NEVER
        return state

    def step(self, state: Rows, verdict: Verdict, constants: Rows, sample: Rows, alive: Rows) -> Rows:
        """Score after one more sample; flights that have departed or ended keep theirs."""
        x, c = self.states.unpack(state), self.constants.unpack(constants)
        declared = verdict.declared * 1.0  # a plug-in may declare with booleans, whose sum would be a logical or
        n = total(declared)
        active = alive & (sample <= c.last)
        faulty = active & (sample >= c.k0)
        healthy = active & (sample < c.k0)
        # 0 for verdicts of 0 and 1 only; what is anything else, or not a number, is not repaired but said
        odd = total(np.abs(declared * (declared - 1.0)))
        sound = (np.abs(verdict.ratio) < np.inf) & (odd == 0.0)
        events = self._events(x, c, declared, sample, active)
        return self.states.pack(
            first_alarm=_first(x.first_alarm, faulty & (n > 0.0), sample),
            detection=_first(x.detection, faulty & (n == c.n_faulty), sample),
            over_declared=np.where(faulty & (n > c.n_faulty), 1.0, x.over_declared),
            false_alarm=np.where(healthy & (n > 0.0), 1.0, x.false_alarm),
            margin_healthy=np.where(healthy, np.maximum(x.margin_healthy, verdict.ratio), x.margin_healthy),
            margin_faulty=np.where(faulty, np.maximum(x.margin_faulty, verdict.ratio), x.margin_faulty),
            nonfinite=np.where(active & ~sound, 1.0, x.nonfinite),
            declared=np.where(active, declared, x.declared),
            **events,
        )

    def _events(self, x: Rows, c: Rows, declared: Rows, sample: Rows, active: Rows) -> Mapping[str, Rows]:
        """First alarm and detection of every fault, on its own sites and in its own interval, and alarms before it."""
        after = {}
        events = [self.event.unpack(getattr(c, f"event_{j}")) for j in range(self.n_events)]
        for j, event in enumerate(events):
            within = active & (sample >= event.first) & (sample <= event.last)
            hits, own = total(declared * event.own), total(event.own)
            # a site that another fault has made faulty is rightly declared before this one
            others = [np.where(sample >= other.first, other.own, 0.0) for i, other in enumerate(events) if i != j]
            innocent = event.own * (1.0 - reduce(np.maximum, others, np.zeros_like(event.own)))
            early = active & (sample < event.first) & (total(declared * innocent) > 0.0)
            after[f"early_{j}"] = np.where(early, 1.0, getattr(x, f"early_{j}"))
            after[f"event_alarm_{j}"] = _first(getattr(x, f"event_alarm_{j}"), within & (hits > 0.0), sample)
            after[f"event_detection_{j}"] = _first(getattr(x, f"event_detection_{j}"), within & (hits == own), sample)
        return after


def _first(number: Rows, condition: Rows, sample: Rows) -> Rows:
    """Sample number at which the condition was first true."""
    return np.where(condition, np.minimum(number, sample), number)
