"""Requirements on detectors, judged: pass, fail, or undecided and how many flights a decision would take.

A judgement holds at any look (`fddbench.metrics.anytime`): a campaign may be judged after every run, extended and resumed until
it is decided, and a requirement that is not met passes in at most ``1 - confidence`` of the campaigns, one that is met fails in
at most as many. What passes, or fails, stays so when more runs are flown. Each requirement has its own error; that all pass
though one is not met has at most the same.

Measured at 95 % for a right share of at least 98 %, looked at after each of 1500 aircraft, of scenarios that hang together by
the correlation rho, in that every aircraft has a share of its own (beta) or some fail or pass in all scenarios alike
(``python -m tests.bench.requirements 10000``, +- 0.5 %)::

    scenarios            false pass, 98 %   false fail, 98 %   passed, 99 %   aircraft, median
    1                          3.0 %              2.3 %            77.5 %           923
    9, rho 0.05, beta          0.5                2.5             100.0             462
    9, rho 0.05, alike         0.5                2.6             100.0             455
    9, rho 0.5, beta           2.6                2.2              94.7             595
    9, rho 0.5, alike          2.5                2.4              92.1             675
"""

from dataclasses import dataclass

import pyarrow as pa

from fddbench.metrics.shares import column

__all__ = ["AT_LEAST", "JUDGEMENTS", "MEASURES", "NEEDS", "OF_FAULTS", "Judgement", "PlannedFlights", "Requirement"]

MEASURES = {
    "right_share": "right of the decided flights",
    "wrong_site_share": "flights of the decided ones in which a healthy site was declared",
    "normalized_detection_time": "right or late flights with this time over their limit at most, of the decided ones",
    "false_alarm_share": "distinct flights with a false alarm",
    "false_alarms_per_hour": "false alarms of distinct flights over their exposure",
}
"""What can be required, and what it counts."""

AT_LEAST = frozenset({"right_share", "normalized_detection_time"})
"""Measures of which more is better; of a normalised time the share within it is judged."""

OF_FAULTS = frozenset({"right_share", "wrong_site_share", "normalized_detection_time"})
"""Measures of flights with faults."""

NEEDS = (
    *("scenario", "point", "level", "run", "manoeuvre", "detector", "status", "outcome"),
    *("normalized_detection_time", "onset_s", "flight_s", "false_alarm_time_s"),
)
"""Columns of the rows that are read."""


@dataclass(frozen=True, kw_only=True)
class Requirement:
    """What is required.

    Attributes
    ----------
    name : str
        How it is called.
    of : str
        One of `MEASURES`.
    limit : float
        Least share, or largest share or rate [1/h].
    within : float or None
        Of a normalised time: the time over its limit that the share `limit` of the flights must keep [-].
    scenarios : tuple of str
        Names of those that count.
    confidence : float
        One less the probability of a false pass, and of a false fail.
    """

    name: str
    of: str
    limit: float
    within: float | None = None
    scenarios: tuple[str, ...]
    confidence: float = 0.95

    @property
    def at_least(self) -> bool:
        """Whether the value must be at least the limit, else at most."""
        return self.of in AT_LEAST


@dataclass(frozen=True, kw_only=True)
class PlannedFlights:
    """Flights of a scenario as its campaign plans them.

    Attributes
    ----------
    points, levels, runs : int
        Its cases are their product.
    healthy_h : float
        Longest healthy flight until the onset, or to the end [h].
    """

    points: int
    levels: int
    runs: int
    healthy_h: float


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """A requirement on a detector, judged.

    Attributes
    ----------
    name, detector : str
        Of the requirement, and of the design that it is on.
    of : str
        What is required, one of `MEASURES`.
    group : str
        Which part of the flights, ``"scenario jam_a"``, ``"gust_scale 2"``; "" for all.
    scenarios : tuple of str
        Those that count.
    verdict : {"pass", "fail", "undecided"}
        What the flights say of it.
    value : float or None
        Share [-] or rate [1/h] over the runs used; None where no flight counts. Of a normalised time the share within it.
    low, high : float
        Ends of its interval, which holds at any look; each end for itself at the confidence, infinity for no upper end.
    at_least : bool
        Whether the value must be at least the limit, else at most.
    limit, within, confidence : float
        As of `Requirement`.
    runs_used, runs_planned : int
        Aircraft that the judgement stands on, the first ones of the campaign without a gap, and those that are planned.
    decided_at : int or None
        Aircraft after which it was decided.
    runs_needed, flights_needed : int or None
        Aircraft and flights that a decision would take besides at the present rate; 0 when decided, None for never.
    failed : int
        Flights that failed; they count against either verdict.
    in_sample : bool
        The design was tuned on flights of this campaign and seed.
    """

    name: str
    detector: str
    of: str
    group: str
    scenarios: tuple[str, ...]
    verdict: str
    value: float | None
    low: float
    high: float
    at_least: bool
    limit: float
    within: float | None
    confidence: float
    runs_used: int
    runs_planned: int
    decided_at: int | None
    runs_needed: int | None
    flights_needed: int | None
    failed: int
    in_sample: bool = False


JUDGEMENTS = pa.schema(
    [
        column("name", pa.string(), "name of the requirement"),
        column("detector", pa.string(), "name of the design that it is on"),
        column("of", pa.string(), "what is required"),
        column("group", pa.string(), "part of the flights that is judged by itself; empty: all"),
        column("scenarios", pa.string(), "scenarios that count, joined by commas"),
        column("verdict", pa.string(), "pass, fail or undecided; it holds at any look"),
        column("value", pa.float64(), "share [-] or rate [1/h] over the runs used; null: no flight counts"),
        column("low", pa.float64(), "lower end of its interval, at any look, at the confidence by itself"),
        column("high", pa.float64(), "upper end; infinity: none"),
        column("at_least", pa.bool_(), "the value must be at least the limit, else at most"),
        column("limit", pa.float64(), "least share, or largest share or rate [1/h]"),
        column(
            "within", pa.float64(), "time over its limit that the share of the flights must keep [-]; null: no time"
        ),
        column("confidence", pa.float64(), "one less the probability of a false pass, and of a false fail"),
        column("runs_used", pa.int64(), "first runs of the campaign that are whole: what is judged"),
        column("runs_planned", pa.int64(), "runs of the campaign"),
        column("decided_at", pa.int64(), "runs after which it was decided; null: not yet"),
        column("runs_needed", pa.int64(), "runs that a decision would take besides at the present rate; null: never"),
        column("flights_needed", pa.int64(), "flights of them"),
        column("failed", pa.int64(), "flights that failed; they count against either verdict"),
        column("in_sample", pa.bool_(), "the design was tuned on flights of this campaign and seed"),
    ]
)
