"""From score states at the end of a flight to the columns of rows and events."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

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
    """Status and reason of every case."""
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    status, reason = [], []
    for i in range(score.shape[1]):
        left = departed[i] <= c.last[i]
        if infeasible[i]:
            found: tuple[str, str | None] = ("infeasible", infeasible[i])
        elif errors[i]:
            found = ("error", errors[i])
        elif left and x.detection[i] == NEVER:
            found = ("diverged", f"the flight departed at sample {departed[i]:.0f}")
        elif x.nonfinite[i] > 0.0:
            found = ("nonfinite", "the detector's residual or verdict is not a finite number")
        else:
            found = ("ok", None)
        status.append(found[0])
        reason.append(found[1])
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
    columns: Columns = {}
    for i in range(score.shape[1]):
        faulty = truth.faulty_sites[i]
        found = _truth_of(faulty, truth.limit_s[i], onset_s=_seconds(c.k0[i], sample_s) if faulty else None)
        declared = tuple(site for site, on in zip(sites, x.declared[:, i], strict=True) if on > 0.0)
        end = min(float(c.last[i]), float(departed[i]))
        if status[i] == "ok":
            number = {name: float(getattr(x, name)[i]) for name in scoring.states.fields if name != "declared"}
            found |= _common(number, declared, k0=float(c.k0[i]), end=end, sample_s=sample_s)
            if faulty:
                found |= _of_fault(
                    number, declared, faulty, truth.limit_s[i] or 0.0, k0=float(c.k0[i]), end=end, sample_s=sample_s
                )
        for name in _NAMES:
            columns.setdefault(name, []).append(found.get(name))
    return columns


_NAMES = (
    "flight_s", "n_faulty", "faulty_sites", "onset_s", "n_declared", "declared_sites", "first_alarm_time_s",
    "detection_time_s", "detection_time_limit_s", "normalized_detection_time", "detected", "classified", "isolated",
    "false_isolation", "over_declared", "missed", "censored", "false_alarm", "margin_healthy", "margin_faulty",
)  # fmt: skip


def _seconds(samples: float, sample_s: float) -> float:
    """Time of a sample number [s], without the digits that binary fractions add."""
    return round(samples * sample_s, 9)


def _truth_of(faulty: tuple[str, ...], limit_s: float | None, *, onset_s: float | None) -> dict[str, Any]:
    return {
        "n_faulty": len(faulty),
        "faulty_sites": "+".join(faulty) or None,
        "onset_s": onset_s,
        "detection_time_limit_s": limit_s,
    }


def _common(
    x: Mapping[str, float], declared: tuple[str, ...], *, k0: float, end: float, sample_s: float
) -> dict[str, Any]:
    """Columns that healthy and faulty flights share."""
    return {
        "flight_s": _seconds(end, sample_s),
        "n_declared": len(declared),
        "declared_sites": "+".join(declared) or None,
        "false_alarm": x["false_alarm"] > 0.0,
        "margin_healthy": x["margin_healthy"] if k0 > 0.0 else None,
    }


def _of_fault(
    x: Mapping[str, float], declared: tuple[str, ...], faulty: tuple[str, ...], limit_s: float,
    *, k0: float, end: float, sample_s: float,
) -> dict[str, Any]:  # fmt: skip
    """Columns that a healthy flight does not have."""
    return {
        **_times(x["first_alarm"], x["detection"], k0=k0, end=end, limit_s=limit_s, sample_s=sample_s),
        "classified": len(declared) == len(faulty),
        "isolated": declared == faulty,
        "false_isolation": any(site not in faulty for site in declared),
        "over_declared": x["over_declared"] > 0.0,
        "margin_faulty": x["margin_faulty"],
    }


def _times(alarm: float, detection: float, *, k0: float, end: float, limit_s: float, sample_s: float) -> dict[str, Any]:
    """Times from the onset, and whether the requirement was met; a flight that ended too early is censored."""
    detected_s = None if detection == NEVER else _seconds(detection - k0, sample_s)
    censored = detected_s is None and _seconds(end - k0, sample_s) < limit_s
    return {
        "first_alarm_time_s": None if alarm == NEVER else _seconds(alarm - k0, sample_s),
        "detection_time_s": detected_s,
        "detection_time_limit_s": limit_s,
        "normalized_detection_time": None if detected_s is None else detected_s / limit_s,
        "detected": alarm != NEVER,
        "missed": None if censored else detected_s is None or detected_s > limit_s,
        "censored": censored,
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
    """Times of one fault of one case, scored on its own sites and interval; the case must have the status ok."""
    x, c = scoring.states.unpack(score), scoring.constants.unpack(constants)
    interval = scoring.event.unpack(getattr(c, f"event_{event}"))
    first, last = float(interval.first[case]), min(float(interval.last[case]), end)
    alarm, detection = (float(getattr(x, f"{name}_{event}")[case]) for name in ("event_alarm", "event_detection"))
    return _times(alarm, detection, k0=first, end=last, limit_s=limit_s, sample_s=sample_s)
