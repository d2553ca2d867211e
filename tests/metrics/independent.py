"""The contract's scores of one flight, written a second time: whole sequences, plain Python, nothing of the package.

It looks at everything at once and backwards, which no step can; whoever scores inside the flight is compared with it.
Sites are names, samples whole numbers. Where the contract leaves something open, the choice is said beside it.
"""

from dataclasses import dataclass, field
from math import sqrt

BEFORE = "declared_before"


@dataclass(frozen=True, kw_only=True)
class Flight:
    """What flew and what a detector said.

    `faults`: one tuple a fault of (site, first faulty sample, last one or None: to the end of the flight).
    `declared`: sites declared at each sample; `alarm`: whether the detector says so itself, besides any declared site.
    `departed`: sample at which the flight left its limits, not scored any more. `requirement`: samples allowed for a set
    of sites. `estimate`, `added`: of each signal (a site, or one voted signal) at each sample, what the detector
    estimates and what the faults really added.
    """

    faults: tuple
    declared: tuple
    alarm: tuple = ()
    isolates: bool = True
    departed: int | None = None
    sites: tuple = ("r1", "r2", "r3")
    requirement: object = field(default=lambda sites: 5)
    sample_s: float = 1.0
    residual: tuple = ()
    estimate: dict | None = None
    added: dict | None = None
    watches: tuple | None = None

    # --- the letters of the contract ---
    @property
    def last(self):
        """Last scored sample; -1 where the flight departed at once."""
        end = len(self.declared) - 1
        return end if self.departed is None else min(end, self.departed - 1)

    @property
    def k0(self):
        return min((first for fault in self.faults for _, first, _ in fault), default=None)

    @property
    def k1(self):
        return max((first for fault in self.faults for _, first, _ in fault), default=None)

    def F(self, k):
        """Sites that have been faulty at some sample up to k."""
        return {site for fault in self.faults for site, first, _ in fault if first <= k}

    def D(self, k):
        return set(self.declared[k]) if k >= 0 else set()

    def A(self, k):
        return k >= 0 and (bool(self.D(k)) or bool(self.alarm and self.alarm[k]))

    def raised(self, k):
        return self.A(k) and not self.A(k - 1)

    def samples(self, first, last):
        """Scored samples from first to last, both included."""
        return range(max(first, 0), min(last, self.last) + 1)

    def named(self, sites):
        return "+".join(site for site in self.sites if site in sites) or None


def onset(fault):
    return min(first for _, first, _ in fault)


def end(fault, last):
    """Last faulty sample, or the last of the flight."""
    return last if any(to is None for *_, to in fault) else min(last, max(to for *_, to in fault))


def is_over(fault, last):
    """Its last faulty sample has been flown."""
    return all(to is not None and to <= last for *_, to in fault)


def found(flight, fault):
    """Sample at which a fault was found, `BEFORE`, or None.

    A fault that the flight did not reach is not found, although a site that an earlier fault made faulty may already be
    declared: nothing of it was flown.
    """
    first, stop = onset(fault), end(fault, flight.last)
    if stop < first:
        return None
    return _by_sites(flight, fault, first, stop) if flight.isolates else _by_alarm(flight, first, stop)


def _by_sites(flight, fault, first, stop):
    own = {site for site, *_ in fault}
    since = stop + 1
    while since > 0 and own <= flight.D(since - 1) <= flight.F(since - 1):
        since -= 1
    if since > stop:
        return None
    return BEFORE if since < first or flight.D(since) == flight.D(since - 1) else since


def _by_alarm(flight, first, stop):
    """An alarm that stood at the onset, was let go and is raised again while the fault lasts finds it by that."""
    for k in range(first, stop + 1):
        if flight.raised(k):
            return k
    return BEFORE if flight.A(first) and flight.A(first - 1) else None


def limit(flight, faults):
    """Samples from the first onset of these faults: to their last onset, and the requirement for their sites."""
    firsts = [first for fault in faults for _, first, _ in fault]
    return max(firsts) - min(firsts) + flight.requirement({site for fault in faults for site, *_ in fault})


def judged(flight, faults):
    """(`right`, `late`, `missed`, `undecided` or `declared_before`, sample of detection or None) of faults together."""
    start, within = min(onset(fault) for fault in faults), limit(flight, faults)
    samples = [found(flight, fault) for fault in faults]
    if None not in samples:
        at = max((k for k in samples if k != BEFORE), default=None)
        if at is None:
            return BEFORE, None
        return ("right" if at <= start + within else "late"), at
    lost = [fault for fault, k in zip(faults, samples, strict=True) if k is None]
    limit_passed = flight.last >= start + within
    over = any(is_over(fault, flight.last) for fault in lost)
    departed = flight.departed is not None and flight.departed < len(flight.declared) and flight.departed > start
    return ("missed" if limit_passed or over or departed else "undecided"), None


def score(flight):
    """Score columns of one flight with status ok, and under `events` those of each of its faults."""
    return _alarms(flight) | _decision(flight) | _final(flight) | _margins(flight) | _estimate(flight) | _events(flight)


def _first(samples, condition):
    return next((k for k in samples if condition(k)), None)


def _seconds(flight, k, start):
    return None if k is None else round((k - start) * flight.sample_s, 9)


def _alarms(flight):
    """Healthy flight: its whole length lies before the onset."""
    k0 = len(flight.declared) if flight.k0 is None else flight.k0
    before, after = flight.samples(0, k0 - 1), flight.samples(k0, flight.last)
    first = _first(before, flight.A)
    outside = _first(after, lambda k: not flight.D(k) <= flight.F(k)) if flight.isolates else None
    return {
        "false_alarm_time_s": _seconds(flight, first, 0),
        "alarm_time_s": _seconds(flight, _first(after, flight.raised), k0),
        "wrong_site_time_s": _seconds(flight, outside, k0),
    }


def _decision(flight):
    alarms = _alarms(flight)
    if flight.k0 is None:
        outcome = "quiet" if alarms["false_alarm_time_s"] is None else "false_alarm"
        return {"outcome": outcome} | dict.fromkeys(
            ("detection_time_s", "detection_time_limit_s", "normalized_detection_time")
        )
    outcome, at = judged(flight, flight.faults)
    if alarms["wrong_site_time_s"] is not None:
        outcome = "wrong_site"
    if alarms["false_alarm_time_s"] is not None:
        outcome = "false_alarm"
    within = limit(flight, flight.faults)
    return {
        "outcome": outcome,
        "detection_time_s": _seconds(flight, at, flight.k0),
        "detection_time_limit_s": _seconds(flight, within, 0),
        "normalized_detection_time": None if at is None else (at - flight.k0) / within,
    }


def _final(flight):
    """A detector that only detects declares no sites: 0 and null, and nothing that compares sites."""
    k0, last = flight.k0, flight.last
    faulty = set() if k0 is None else flight.F(flight.k1)
    at_end = flight.D(last) if flight.isolates else set()
    flown = k0 is not None and last >= k0
    watched = flight.samples(k0, last) if flown else ()
    said = flight.D if flight.isolates else flight.A
    left = flight.departed is not None and flight.departed < len(flight.declared)
    return {
        "flight_s": _seconds(flight, max(last, 0), 0),
        "departed_s": _seconds(flight, flight.departed, 0) if left else None,
        "watched": None if k0 is None else faulty <= set(flight.watches or flight.sites),
        "onset_s": _seconds(flight, k0, 0),
        "n_faulty": len(faulty),
        "faulty_sites": flight.named(faulty),
        "n_declared": len(at_end),
        "declared_sites": flight.named(at_end),
        "isolated": at_end == faulty if flown and flight.isolates else None,
        "over_declared": (
            any(len(flight.D(k)) > len(flight.F(k)) for k in watched) if flown and flight.isolates else None
        ),
        "changes": sum(said(k) != said(k - 1) for k in watched) if flown else None,
    }


def _margins(flight):
    k0 = len(flight.declared) if flight.k0 is None else flight.k0
    if not flight.residual:
        return {"margin_healthy": None, "margin_faulty": None}
    return {
        "margin_healthy": max((flight.residual[k] for k in flight.samples(0, k0 - 1)), default=None),
        "margin_faulty": max((flight.residual[k] for k in flight.samples(k0, flight.last)), default=None),
    }


def _estimate(flight):
    """Bias and rms of estimate minus truth, in the unit of the estimate.

    Of each fault that was found: on its own sites that the detector estimates (or on the voted signal), from 1 s after
    its detection to its end; all of these together. A fault declared before it began has no detection to count from.
    """
    return _errors(flight, flight.faults)


def _errors(flight, faults):
    """Bias and rms over some of its faults."""
    errors = []
    for fault in faults if flight.estimate is not None else ():
        at = found(flight, fault)
        if at not in (None, BEFORE):
            own = {site for site, *_ in fault} & set(flight.watches or flight.sites)
            signals = [name for name in flight.estimate if name in own or name not in flight.sites]
            window = flight.samples(at + round(1.0 / flight.sample_s), end(fault, flight.last))
            errors += [flight.estimate[name][k] - flight.added[name][k] for k in window for name in signals]
    if not errors:
        return {"estimate_bias": None, "estimate_rms": None}
    mean = sum(errors) / len(errors)
    return {"estimate_bias": mean, "estimate_rms": sqrt(sum(e * e for e in errors) / len(errors))}


def _events(flight):
    events = []
    for fault in flight.faults:
        outcome, at = judged(flight, [fault])
        within = limit(flight, [fault])
        events.append(
            _errors(flight, [fault])
            | {
                "sites": flight.named({site for site, *_ in fault}),
                "onset_s": _seconds(flight, onset(fault), 0),
                "detection_time_s": _seconds(flight, at, onset(fault)),
                "detection_time_limit_s": _seconds(flight, within, 0),
                "normalized_detection_time": None if at is None else (at - onset(fault)) / within,
                "outcome": outcome,
            }
        )
    return {"events": events}
