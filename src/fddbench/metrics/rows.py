"""From score states at the end of a flight to the columns of rows and events."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.interfaces import Floats
from fddbench.metrics.scoring import NEVER, Scoring

__all__ = ["Truth", "event_columns", "score_columns", "statuses"]

Columns = dict[str, pa.Array]
Cases = npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What is true of the cases of a batch.

    Attributes
    ----------
    faulty_sites : sequence of tuple of str
        Distinct faulty sites in site order, one entry a scenario.
    limit_s : sequence of float or None
        Detection time limit [s]; None: healthy flight. One entry a scenario.
    scenario : (n_cases,) array of int
        Position of each case's scenario in both.
    """

    faulty_sites: Sequence[tuple[str, ...]]
    limit_s: Sequence[float | None]
    scenario: Cases


def statuses(
    scoring: Scoring,
    score: Floats,
    constants: Floats,
    *,
    departed: Floats,
    infeasible: Sequence[str],
    errors: Sequence[str],
) -> tuple[list[str], list[str | None]]:
    """Status and reason of every case; of several the first in this order: infeasible, error, diverged, nonfinite."""
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    status: list[str] = ["ok"] * score.shape[1]
    reason: list[str | None] = [None] * score.shape[1]
    left = (departed <= c.last) & (x.detection == NEVER)
    rest = np.array([bool(a or b) for a, b in zip(infeasible, errors, strict=True)], dtype=bool)
    for i in np.flatnonzero(rest | left | (x.nonfinite > 0.0)).tolist():
        if infeasible[i]:
            status[i], reason[i] = "infeasible", infeasible[i]
        elif errors[i]:
            status[i], reason[i] = "error", errors[i]
        elif left[i]:
            status[i], reason[i] = "diverged", f"the flight departed at sample {departed[i]:.0f}"
        else:
            status[i], reason[i] = (
                "nonfinite",
                "the detector's residual is not a finite number, or its verdict not 0 or 1",
            )
    return status, reason


def score_columns(
    scoring: Scoring,
    score: Floats,
    constants: Floats,
    *,
    truth: Truth,
    sites: Sequence[str],
    status: Sequence[str],
    departed: Floats,
    sample_s: float,
) -> Columns:
    """Score columns of one detector, one entry a case; all null where the status is not ok."""
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    ok = np.array([name == "ok" for name in status], dtype=bool)
    n_faulty = np.array([len(names) for names in truth.faulty_sites], dtype=np.int64)[truth.scenario]
    of_fault = ok & (n_faulty > 0)
    limit_s = np.array([np.nan if limit is None else limit for limit in truth.limit_s])[truth.scenario]
    end = np.minimum(c.last, departed - 1.0)
    n_declared = np.round(np.where(ok, x.declared.sum(axis=0), 0.0)).astype(np.int64)
    bits = 2 ** np.arange(len(sites), dtype=np.int64)
    declared = (bits[:, np.newaxis] * (x.declared > 0.0)).sum(axis=0)
    faulty = np.array([sum(int(bits[sites.index(s)]) for s in names) for names in truth.faulty_sites], dtype=np.int64)
    faulty = faulty[truth.scenario]
    columns: Columns = {
        "flight_s": _nullable(_seconds(end, sample_s), ok),
        "n_faulty": pa.array(n_faulty),
        "faulty_sites": _texts(["+".join(names) or None for names in truth.faulty_sites], truth.scenario),
        "onset_s": _nullable(_seconds(c.k0, sample_s), n_faulty > 0),
        "n_declared": _nullable(n_declared, ok),
        "declared_sites": _names(declared, sites, ok & (declared > 0)),
        "false_alarm": _nullable(x.false_alarm > 0.0, ok),
        "margin_healthy": _nullable(x.margin_healthy, ok & (c.k0 > 0.0)),
        "classified": _nullable(n_declared == n_faulty, of_fault),
        "isolated": _nullable(declared == faulty, of_fault),
        "false_isolation": _nullable((declared & ~faulty) != 0, of_fault),
        "over_declared": _nullable(x.over_declared > 0.0, of_fault),
        "margin_faulty": _nullable(x.margin_faulty, of_fault),
    }
    times = _times(x.first_alarm, x.detection, k0=c.k0, end=end, limit_s=limit_s, sample_s=sample_s, valid=of_fault)
    return columns | times | {"detection_time_limit_s": _nullable(limit_s, ~np.isnan(limit_s))}


def _nullable(values: Any, valid: Any) -> pa.Array:
    """Values, null where not valid."""
    return pa.array(np.asarray(values), mask=~np.asarray(valid, dtype=bool), from_pandas=False)


def _texts(known: Sequence[str | None], positions: Cases, valid: Any = True) -> pa.Array:
    """Texts by their positions in a few known ones, null where not valid."""
    return pa.array(known, pa.string()).take(_nullable(positions, np.broadcast_to(valid, positions.shape)))


def _names(codes: Cases, sites: Sequence[str], valid: Any) -> pa.Array:
    """Names joined by + of sites given as bits, null where not valid."""
    known, positions = np.unique(codes, return_inverse=True)
    names = ["+".join(site for i, site in enumerate(sites) if code >> i & 1) for code in known.tolist()]
    return _texts(names, positions, valid)


def _seconds(samples: Floats, sample_s: float) -> Floats:
    """Times of sample numbers [s], without the digits that binary fractions add."""
    rounded: Floats = np.round(samples * sample_s, 9)
    return rounded


def _times(
    alarm: Floats,
    detection: Floats,
    *,
    k0: Floats,
    end: Floats,
    limit_s: Floats,
    sample_s: float,
    valid: npt.NDArray[np.bool_],
) -> Columns:
    """Times from the onset, and whether the requirement was met; a flight that ended too early is censored."""
    found = detection < NEVER
    time_s = _seconds(np.where(found, detection - k0, 0.0), sample_s)
    censored = ~found & (_seconds(end - k0, sample_s) < limit_s)
    with np.errstate(invalid="ignore"):
        late = ~found | (time_s > limit_s)
    return {
        "first_alarm_time_s": _nullable(
            _seconds(np.where(alarm < NEVER, alarm - k0, 0.0), sample_s), valid & (alarm < NEVER)
        ),
        "detection_time_s": _nullable(time_s, valid & found),
        "detection_time_limit_s": _nullable(limit_s, valid),
        "normalized_detection_time": _nullable(time_s / np.where(valid, limit_s, 1.0), valid & found),
        "detected": _nullable(alarm < NEVER, valid),
        "missed": _nullable(late, valid & ~censored),
        "censored": _nullable(censored, valid),
    }


def event_columns(
    scoring: Scoring,
    score: Floats,
    constants: Floats,
    *,
    cases: Cases,
    event: int,
    limit_s: float,
    end: Floats,
    sample_s: float,
    valid: npt.NDArray[np.bool_],
) -> Columns:
    """Times of one fault of some cases, scored on its own sites and interval; all null where not valid.

    `cases` are positions in the batch, `end` the last sample of their flights that was scored, (n,).
    """
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    interval, found = c.events[event], x.events[event]
    times = _times(
        found.alarm[cases],
        found.detection[cases],
        k0=interval.first[cases],
        end=np.minimum(interval.last[cases], end),
        limit_s=np.full(len(cases), limit_s),
        sample_s=sample_s,
        valid=valid,
    )
    return times | {"false_alarm": _nullable(found.early[cases] > 0.0, valid)}
