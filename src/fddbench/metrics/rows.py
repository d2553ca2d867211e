"""From score states at the end of a flight to the columns of rows and events."""

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.interfaces import NEVER, Floats
from fddbench.metrics.estimate import bias_and_rms
from fddbench.metrics.found import BEFORE, in_flight
from fddbench.metrics.outcome import Ends, Judged, judged, seconds
from fddbench.metrics.score import ScoreConstants, ScoreState
from fddbench.metrics.scoring import SITES, Scoring

__all__ = ["event_columns", "score_columns", "statuses"]

Columns = dict[str, pa.Array]
Cases = npt.NDArray[np.int64]
Booleans = npt.NDArray[np.bool_]

_ENDED = re.compile(r"(?:given up: on each of the first \d+ flights )?(memory|timeout|crashed): ")
_NONFINITE = "the detector's residual or estimate is not a finite number, or its verdict not 0 or 1"


def statuses(
    scoring: Scoring, score: Floats, *, infeasible: Sequence[str], errors: Sequence[str]
) -> tuple[list[str], list[str | None]]:
    """Status and reason of every case; of several the first in this order: infeasible, error or its like, nonfinite."""
    nonfinite = scoring.states.unpack(score).nonfinite > 0.0
    status: list[str] = ["ok"] * score.shape[1]
    reason: list[str | None] = [None] * score.shape[1]
    told = np.array([bool(a or b) for a, b in zip(infeasible, errors, strict=True)], dtype=bool)
    for i in np.flatnonzero(told | nonfinite).tolist():
        if infeasible[i]:
            status[i], reason[i] = "infeasible", infeasible[i]
        elif errors[i]:
            status[i], reason[i] = _status_of(errors[i]), errors[i]
        else:
            status[i], reason[i] = "nonfinite", _NONFINITE
    return status, reason


def _status_of(reason: str) -> str:
    """Status of a row whose detector did not come to an end; the reason opens with it, unless it is an error."""
    found = _ENDED.match(reason)
    return found[1] if found else "error"


def score_columns(
    scoring: Scoring, score: Floats, constants: Floats, *, limit_s: Floats, status: Sequence[str], departed: Floats
) -> Columns:
    """Score columns of one detector, one entry a case; null where the status is not ok, but for what is true of the flight.

    Parameters
    ----------
    scoring : Scoring
        Of the detector.
    score, constants : (n_rows, n_cases) arrays
        Its score after the flight, and the constants of the scoring.
    limit_s : (n_cases,) array
        Detection time limit from the first onset [s]; not-a-number for a healthy flight.
    status : sequence of str
        Of each case.
    departed : (n_cases,) array
        Sample at which the flight departed, `NEVER` if it did not.
    """
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    ends, ok = Ends(last=c.last, departed=departed), np.array([name == "ok" for name in status], dtype=bool)
    faulty = c.k0 < NEVER
    flown = ok & faulty & (ends.scored >= c.k0)
    return (
        _truth(scoring, c, limit_s)
        | _outcome(scoring, x, c, limit_s=limit_s, ends=ends, ok=ok)
        | _declared(scoring, x, c, ok=ok, flown=flown)
        | {
            "flight_s": _nullable(seconds(np.maximum(ends.scored, 0.0), scoring.sample_s), ok),
            "departed_s": _nullable(seconds(np.where(ends.left, departed, 0.0), scoring.sample_s), ok & ends.left),
            "margin_healthy": _nullable(x.margin_healthy, ok & (ends.scored >= 0.0) & (c.k0 > 0.0)),
            "margin_faulty": _nullable(x.margin_faulty, flown),
        }
    )


def _truth(scoring: Scoring, c: ScoreConstants, limit_s: Floats) -> Columns:
    """What is true of a flight whatever became of it."""
    faulty = c.faulty_from < NEVER
    watched = np.array([[site in scoring.watches] for site in scoring.sites])
    some = faulty.any(axis=0)
    return {
        "n_faulty": pa.array(faulty.sum(axis=0).astype(np.int64)),
        "faulty_sites": _names(faulty, scoring.sites, some),
        "onset_s": _nullable(seconds(c.k0, scoring.sample_s), some),
        "detection_time_limit_s": _nullable(np.round(limit_s, 9), some),
        "watched": _nullable(~(faulty & ~watched).any(axis=0), some),
    }


def _outcome(
    scoring: Scoring, x: ScoreState, c: ScoreConstants, *, limit_s: Floats, ends: Ends, ok: Booleans
) -> Columns:
    """Outcome and the times that it stands on."""
    sample_s, start, faulty = scoring.sample_s, c.k0, c.k0 < NEVER
    of_faults, first, last = _faults(x, c)
    within = np.where(faulty, np.round(limit_s, 9), 1.0)
    met = judged(of_faults, first=first, last=last, start=start, limit_s=within, ends=ends, sample_s=sample_s)
    false_alarm, wrong = x.false_alarm < NEVER, (x.wrong < NEVER) & scoring.isolates
    outcome = np.select([false_alarm, ~faulty, wrong], ["false_alarm", "quiet", "wrong_site"], met.outcome)
    columns: Columns = {
        "outcome": pa.array(outcome.tolist(), pa.string(), mask=~ok),
        "false_alarm_time_s": _nullable(seconds(x.false_alarm, sample_s), ok & false_alarm),
        "alarm_time_s": _nullable(seconds(x.raised - start, sample_s), ok & (x.raised < NEVER)),
        "wrong_site_time_s": _nullable(seconds(x.wrong - start, sample_s), ok & wrong),
    }
    return (
        columns
        | _detection(met, start=start, limit_s=within, sample_s=sample_s, valid=ok & faulty)
        | _estimate(x, c, ends, ok & _comparable(scoring, c.faulty_from < NEVER))
    )


def _detection(met: Judged, *, start: Floats, limit_s: Floats, sample_s: float, valid: Booleans) -> Columns:
    """Detection time, and its share of the limit."""
    valid = valid & (met.at < NEVER) & (met.at > BEFORE)
    time_s = seconds(np.where(valid, met.at - start, 0.0), sample_s)
    return {
        "detection_time_s": _nullable(time_s, valid),
        "normalized_detection_time": _nullable(time_s / limit_s, valid),
    }


def _declared(scoring: Scoring, x: ScoreState, c: ScoreConstants, *, ok: Booleans, flown: Booleans) -> Columns:
    """What is declared at the end, and what is wrong with it."""
    declared = (x.declared > 0.0) & scoring.isolates
    exact = (declared == (c.faulty_from < NEVER)).all(axis=0)
    decides = flown & scoring.isolates
    return {
        "n_declared": _nullable(declared.sum(axis=0).astype(np.int64), ok),
        "declared_sites": _names(declared, scoring.sites, ok & declared.any(axis=0)),
        "isolated": _nullable(exact, decides),
        "over_declared": _nullable(x.over_declared > 0.0, decides),
        "changes": _nullable(np.round(x.changes).astype(np.int64), flown),
    }


def _faults(x: ScoreState, c: ScoreConstants) -> tuple[Floats, Floats, Floats]:
    """Numbers, first and last samples of all faults, (n_faults, n_cases) each."""
    none = np.zeros((0, len(c.k0)))
    columns = ([one.found for one in x.faults], [one.first for one in c.faults], [one.last for one in c.faults])
    found, first, last = (np.concatenate([none, *(row[np.newaxis] for row in rows)]) for rows in columns)
    return found, first, last


def _estimate(x: ScoreState, c: ScoreConstants, ends: Ends, valid: Booleans) -> Columns:
    """Error of the estimate over all faults that were found."""
    none = np.zeros(len(c.k0))
    sums = [one.sums for one in x.faults if isinstance(one.sums, tuple)]
    if not sums:
        return {name: _nullable(none, none > 0.0) for name in ("estimate_bias", "estimate_rms")}
    found, first, _ = _faults(x, c)
    found = in_flight(found, first=first, last_scored=ends.scored)
    count, first_sum, second_sum = (np.stack(rows) for rows in zip(*sums, strict=True))
    n, bias, rms = bias_and_rms((count, first_sum, second_sum), found=found)
    valid = valid & (n > 0.0)
    return {"estimate_bias": _nullable(bias, valid), "estimate_rms": _nullable(rms, valid)}


def _comparable(scoring: Scoring, faulty: Booleans) -> Booleans:
    """Where the errors of the estimates of these sites, (n_sites, n_cases), have one unit."""
    if scoring.estimates != SITES:
        return np.ones(faulty.shape[1], dtype=bool)
    of_unit = [faulty[[unit == one for one in scoring.units]].any(axis=0) for unit in dict.fromkeys(scoring.units)]
    one_unit: Booleans = np.sum(of_unit, axis=0) <= 1
    return one_unit


def event_columns(
    scoring: Scoring,
    score: Floats,
    constants: Floats,
    *,
    event: int,
    limit_s: Floats,
    departed: Floats,
    valid: Booleans,
) -> Columns:
    """Outcome, times and estimate of one fault of every case by itself, null where not valid.

    `event` numbers the fault in its flight from 0; `limit_s`, (n_cases,), counts from its own onset [s].
    """
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    x, c = replace(x, faults=(x.faults[event],)), replace(c, faults=(c.faults[event],))
    ends, within, start = Ends(last=c.last, departed=departed), np.round(limit_s, 9), c.faults[0].first
    found, first, last = _faults(x, c)
    met = judged(found, first=first, last=last, start=start, limit_s=within, ends=ends, sample_s=scoring.sample_s)
    columns: Columns = {
        "outcome": pa.array(met.outcome.tolist(), pa.string(), mask=~valid),
        "detection_time_limit_s": pa.array(within),
    }
    return (
        columns
        | _detection(met, start=start, limit_s=within, sample_s=scoring.sample_s, valid=valid)
        | _estimate(x, c, ends, valid & _comparable(scoring, c.faults[0].own > 0.0))
    )


def _nullable(values: Any, valid: Any) -> pa.Array:
    """Values, null where not valid."""
    return pa.array(np.asarray(values), mask=~np.asarray(valid, dtype=bool), from_pandas=False)


def _names(chosen: Booleans, sites: Sequence[str], valid: Booleans) -> pa.Array:
    """Names joined by + of the chosen sites, (n_sites, n_cases), null where not valid."""
    bits = 2 ** np.arange(len(sites), dtype=np.int64)
    known, positions = np.unique((bits[:, np.newaxis] * chosen).sum(axis=0), return_inverse=True)
    names = ["+".join(site for i, site in enumerate(sites) if code >> i & 1) for code in known.tolist()]
    return pa.array(names, pa.string()).take(_nullable(positions, valid))
