"""From score states at the end of a flight to the columns of rows and events."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.metrics.scoring import NEVER, Scoring

__all__ = ["Truth", "event_columns", "score_columns", "statuses"]

Columns = dict[str, list[Any]]


@dataclass(frozen=True, kw_only=True)
class Truth:
    """What is true of every case of a batch, one entry a case.

    Attributes
    ----------
    faulty_sites : sequence of tuple of str
        Distinct faulty sites in site order.
    limit_s : sequence of float or None
        Detection time limit [s]; None: healthy flight.
    """

    faulty_sites: Sequence[tuple[str, ...]]
    limit_s: Sequence[float | None]


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
    n_faulty = np.array([len(faulty) for faulty in truth.faulty_sites], dtype=np.int64)
    of_fault = ok & (n_faulty > 0)
    limit_s = np.array([np.nan if limit is None else limit for limit in truth.limit_s])
    end = np.minimum(c.last, departed - 1.0)
    n_declared = np.round(np.where(ok, x.declared.sum(axis=0), 0.0)).astype(np.int64)
    bits = 2 ** np.arange(len(sites), dtype=np.int64)
    declared = (bits[:, np.newaxis] * (x.declared > 0.0)).sum(axis=0)
    faulty = np.array([sum(int(bits[sites.index(s)]) for s in names) for names in truth.faulty_sites], dtype=np.int64)
    columns: Columns = {
        "flight_s": _nullable(_seconds(end, sample_s), ok),
        "n_faulty": n_faulty.tolist(),
        "faulty_sites": ["+".join(names) or None for names in truth.faulty_sites],
        "onset_s": _nullable(_seconds(c.k0, sample_s), n_faulty > 0),
        "n_declared": _nullable(n_declared, ok),
        "declared_sites": _nullable(_names(declared, sites), ok & (declared > 0)),
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


def _nullable(values: Any, valid: Any) -> list[Any]:
    """Plain Python values, None where not valid."""
    found = np.asarray(values).astype(object)
    found[~np.asarray(valid, dtype=bool)] = None
    return list(found)


def _names(codes: npt.NDArray[np.int64], sites: Sequence[str]) -> npt.NDArray[np.object_]:
    """Names joined by + of sites given as bits."""
    known = {
        code: "+".join(site for i, site in enumerate(sites) if code >> i & 1) for code in np.unique(codes).tolist()
    }
    return np.array([known[code] for code in codes.tolist()], dtype=object)


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
    case: int,
    event: int,
    limit_s: float,
    end: float,
    sample_s: float,
) -> dict[str, Any]:
    """Times of one fault of one case, scored on its own sites and interval; the case must have the status ok.

    `end` is the last sample of the flight that was scored.
    """
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    interval = scoring.event.unpack(getattr(c, f"event_{event}"))
    last = np.minimum(interval.last[case : case + 1], end)
    alarm, detection = (getattr(x, f"{name}_{event}")[case : case + 1] for name in ("event_alarm", "event_detection"))
    columns = _times(
        alarm,
        detection,
        k0=interval.first[case : case + 1],
        end=last,
        limit_s=np.array([limit_s]),
        sample_s=sample_s,
        valid=np.array([True]),
    )
    early = bool(getattr(x, f"early_{event}")[case] > 0.0)
    return {name: values[0] for name, values in columns.items()} | {"false_alarm": early}
