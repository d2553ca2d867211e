"""What the aircraft of a campaign tell of a share or of a rate, an entry an aircraft (run), in the order of the runs.

The rows of an aircraft, all its scenarios, points and levels, make one bounded number: they share aircraft and air and are no
independent flights. What no rate counts (undecided, infeasible) neither wins nor loses. A flight that failed counts against
either verdict: nobody knows what it would have been.
"""

from dataclasses import dataclass
from math import inf
from typing import Protocol

from fddbench.interfaces import Floats
from fddbench.metrics.anytime import bets, edge, first_crossing, numbers_needed

__all__ = ["Evidence", "Rate", "Share", "aircraft_needed", "ends", "known_at"]


class Evidence(Protocol):
    """Numbers of aircraft that bear on a value with a limit."""

    @property
    def value(self) -> float | None:
        """The value as it is estimated; None where the flights do not tell."""

    def scaled(self, part: float, limit: float) -> float:
        """Values there can be, on a scale from 0 to 1."""

    def gains(self, limit: float, *, more: bool) -> Floats:
        """Gains of a bet that the value is more (or less) than the limit, (n_runs,), at least -1; on average <= 0 if not."""

    def mean(self, limit: float, *, more: bool) -> float:
        """Where the boundary lies in the range of the bounded number [0 to 1]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Share:
    """Hits of the rows of each aircraft, (n_runs,) each.

    The share is that of all hits in all decided rows; its aircraft have ``rows`` rows each, and
    ``E[hits] / E[decided] <= p`` is the same as ``E[hits - p decided] <= 0``.

    Attributes
    ----------
    hits, decided, failed : (n_runs,) arrays
        Rows that count, rows that have a part in the share, and rows that failed.
    rows : int
        Rows of an aircraft.
    """

    hits: Floats
    decided: Floats
    failed: Floats
    rows: int

    @property
    def value(self) -> float | None:
        """Hits of decided rows [-]."""
        decided = float(self.decided.sum())
        return float(self.hits.sum()) / decided if decided else None

    def scaled(self, part: float, limit: float) -> float:
        """See `Evidence`."""
        del limit
        return part

    def gains(self, limit: float, *, more: bool) -> Floats:
        """See `Evidence`."""
        counted, part = (self.hits, limit) if more else (self.decided - self.hits, 1.0 - limit)
        found: Floats = (counted / part - self.decided - self.failed) / self.rows
        return found

    def mean(self, limit: float, *, more: bool) -> float:
        """See `Evidence`."""
        return limit if more else 1.0 - limit


@dataclass(frozen=True, kw_only=True, eq=False)
class Rate:
    """Alarms and exposure of the distinct flights of each aircraft, (n_runs,) each.

    ``E[alarms] / E[hours] <= r`` is the same as ``E[alarms - r hours] <= 0``; an aircraft has at most `flights` alarms, since a
    flight is watched until its first, and at most `most_hours` of healthy flight.

    Attributes
    ----------
    alarms, hours, failed, failed_hours : (n_runs,) arrays
        Flights with a false alarm, healthy flight up to it [h], flights that failed and their planned healthy flight [h].
    flights : int
        Distinct flights of an aircraft.
    most_hours : float
        Their longest healthy flight together, as planned [h].
    """

    alarms: Floats
    hours: Floats
    failed: Floats
    failed_hours: Floats
    flights: int
    most_hours: float

    @property
    def value(self) -> float | None:
        """Alarms over exposure [1/h]."""
        hours = float(self.hours.sum())
        return float(self.alarms.sum()) / hours if hours else None

    def scaled(self, part: float, limit: float) -> float:
        """See `Evidence`; the limit lies in the middle, infinity at the end."""
        return limit * part / (1.0 - part) if part < 1.0 else inf

    def gains(self, limit: float, *, more: bool) -> Floats:
        """See `Evidence`; `limit` in [1/h]."""
        balance = self.alarms - limit * self.hours
        if more:
            found: Floats = (balance / limit - self.failed_hours) / self.most_hours
        else:
            found = (-balance - self.failed) / self.flights
        return found

    def mean(self, limit: float, *, more: bool) -> float:
        """See `Evidence`."""
        less = self.flights / (self.flights + limit * self.most_hours)
        return 1.0 - less if more else less


def known_at(evidence: Evidence, limit: float, confidence: float, *, more: bool) -> int | None:
    """Aircraft after which the value is known to be more (or less) than the limit, None while it is not."""
    return first_crossing(evidence.gains(limit, more=more), bets(evidence.mean(limit, more=more)), confidence)


def aircraft_needed(evidence: Evidence, limit: float, confidence: float) -> int | None:
    """Aircraft in all after which either is known, if they go on as they were; None for never."""
    needed = [
        numbers_needed(evidence.gains(limit, more=more), bets(evidence.mean(limit, more=more)), confidence)
        for more in (True, False)
    ]
    return min((n for n in needed if n is not None), default=None)


def ends(evidence: Evidence, limit: float, confidence: float) -> tuple[float, float]:
    """Interval of the value at any look; each end holds at the confidence, and stands on the bets that judge the limit.

    So the lower end reaches the limit when the value is judged to be more, and the upper end when it is judged to be less.
    """

    def refuted(at: float, *, more: bool) -> bool:
        staked = bets(evidence.mean(limit, more=more))
        return first_crossing(evidence.gains(at, more=more), staked, confidence) is not None

    low = edge(lambda part: refuted(evidence.scaled(part, limit), more=True))
    high = edge(lambda part: refuted(evidence.scaled(1.0 - part, limit), more=False))
    return evidence.scaled(low, limit), evidence.scaled(1.0 - high, limit)
