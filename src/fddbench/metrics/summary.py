"""One line per scenario and detector: counts, rates with exact intervals, detection times."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from fddbench.interfaces import Floats
from fddbench.metrics.intervals import clopper_pearson, poisson_rate

__all__ = ["NEEDS", "SUMMARY", "rate_with_interval", "summarize", "true_detection"]

Value = int | float | str | bool | None
Booleans = npt.NDArray[np.bool_]

_RATES = {
    "true_detection": "classified, not missed, no false alarm; in a healthy scenario: no false alarm",
    "over_declared": "flights in which more sites were declared than are faulty; null: healthy scenario",
    "false_alarm": "flights with a declaration before the onset, in a healthy scenario at any time",
    "missed": "flights detected late or never, of those not censored; null: healthy scenario",
    "isolated": "flights that end with exactly the faulty sites declared; null: healthy scenario",
}


NEEDS = (
    *("scenario", "detector", "status", "n_faulty", "onset_s", "flight_s"),
    *("classified", "over_declared", "false_alarm", "missed", "isolated", "censored"),
    *("detection_time_s", "detection_time_limit_s", "normalized_detection_time", "margin_healthy"),
)
"""Columns of the rows that `summarize` reads."""


def _column(name: str, kind: pa.DataType, about: str) -> pa.Field:
    return pa.field(name, kind, metadata={"about": about})


def _rate_columns(name: str, about: str) -> list[pa.Field]:
    count = _column(name, pa.int64(), about)
    trials = _column(f"{name}_trials", pa.int64(), "flown flights that this rate is a share of")
    shares = [
        _column(f"{name}{over}{end}_percent", pa.float64(), f"{what} [%], of {base}")
        for over, base in (("", "the trials"), ("_all", "all cases, flown or not"))
        for end, what in (("", "share"), ("_low", "lower end of the exact 95 % interval"), ("_high", "upper end"))
    ]
    return [count, trials, *shares]


SUMMARY = pa.schema(
    [
        _column("scenario", pa.string(), "name of the scenario"),
        _column("detector", pa.string(), "name of the design"),
        _column("healthy", pa.bool_(), "no faulty site in this scenario"),
        _column("flights", pa.int64(), "all cases"),
        _column("flown", pa.int64(), "cases with status ok: what the rates are taken over"),
        _column("infeasible", pa.int64(), "cases that cannot be flown"),
        _column("failed", pa.int64(), "cases with any other status"),
        *[field for name, about in _RATES.items() for field in _rate_columns(name, about)],
        _column("censored", pa.int64(), "flights that ended before the limit without detection; null: healthy"),
        _column("exposure_h", pa.float64(), "fault-free flight: up to the onset, of a healthy flight all [h]"),
        _column("false_alarm_per_hour", pa.float64(), "false alarms over the exposure [1/h]"),
        _column("false_alarm_low_per_hour", pa.float64(), "lower end of its exact (Garwood) 95 % interval [1/h]"),
        _column("false_alarm_high_per_hour", pa.float64(), "upper end [1/h]"),
        _column("detections", pa.int64(), "flights with a detection time: what its quantiles are taken over"),
        _column("detection_time_median_s", pa.float64(), "their median [s], an observed value"),
        _column("detection_time_p95_s", pa.float64(), "their 95 % quantile [s], an observed value"),
        _column("detection_time_max_s", pa.float64(), "their maximum [s]"),
        _column("detection_time_limit_s", pa.float64(), "requirement [s], the smallest in the scenario"),
        _column("normalized_detection_time_max", pa.float64(), "largest detection time over its limit [-]"),
        _column("margin_healthy_max", pa.float64(), "largest residual over threshold while healthy [-]"),
    ]
)


def summarize(rows: pd.DataFrame) -> pd.DataFrame:
    """Table of `SUMMARY` columns, Arrow-backed: scenarios in order of appearance, in each the detectors likewise.

    Parameters
    ----------
    rows : DataFrame
        As ``fddbench.load`` gives them, with the columns `NEEDS`; nulls are ``pd.NA`` or None.

    Returns
    -------
    DataFrame
        One line per scenario and detector. Where nothing was flown counts are 0 and rates null.
    """
    groups = dict(list(rows.groupby(["scenario", "detector"], sort=False)))
    pairs = [(scenario, detector) for scenario in rows["scenario"].unique() for detector in rows["detector"].unique()]
    lines = [{"scenario": a, "detector": b} | _line(groups[a, b]) for a, b in pairs if (a, b) in groups]
    summary: pd.DataFrame = pa.Table.from_pylist(lines, schema=SUMMARY).to_pandas(types_mapper=pd.ArrowDtype)
    return summary


def true_detection(flown: pd.DataFrame) -> Booleans:
    """Which flown flights are true detections, (n_rows,): a censored flight is none."""
    quiet = ~_flags(flown, "false_alarm")
    healthy = _numbers(flown, "n_faulty") == 0
    detected = _flags(flown, "classified") & ~_flags(flown, "missed") & quiet
    return np.where(healthy, quiet, detected)


def rate_with_interval(name: str, hits: int, trials: int) -> dict[str, Value]:
    """Share and exact 95 % interval in percent under ``<name>_percent``, ``_low_percent``, ``_high_percent``."""
    keys = (f"{name}_percent", f"{name}_low_percent", f"{name}_high_percent")
    if trials == 0:
        return dict.fromkeys(keys)
    low, high = clopper_pearson(hits, trials)
    return dict(zip(keys, (100.0 * hits / trials, 100.0 * float(low), 100.0 * float(high)), strict=True))


def _line(group: pd.DataFrame) -> dict[str, Value]:
    ok = np.asarray(group["status"] == "ok", dtype=bool)
    infeasible = int(np.sum(np.asarray(group["status"] == "infeasible", dtype=bool)))
    flown = group[ok]
    healthy = bool(np.all(_numbers(group, "n_faulty") == 0))
    counts: dict[str, Value] = {
        "healthy": healthy,
        "flights": len(group),
        "flown": len(flown),
        "infeasible": infeasible,
        "failed": len(group) - len(flown) - infeasible,
        "censored": None if healthy else int(_flags(flown, "censored").sum()),
    }
    return counts | _rates(flown, len(group), healthy) | _per_hour(flown) | _times(flown)


def _rates(flown: pd.DataFrame, flights: int, healthy: bool) -> dict[str, Value]:
    hits = {name: int(_flags(flown, name).sum()) for name in _RATES if name != "true_detection"}
    hits["true_detection"] = int(true_detection(flown).sum())
    line: dict[str, Value] = {}
    for name, n in hits.items():
        if healthy and name in ("over_declared", "missed", "isolated"):
            continue
        trials = len(flown) - (int(_flags(flown, "censored").sum()) if name == "missed" else 0)
        line |= {name: n, f"{name}_trials": trials}
        line |= rate_with_interval(name, n, trials) | rate_with_interval(f"{name}_all", n, flights)
    return line


def _per_hour(flown: pd.DataFrame) -> dict[str, Value]:
    exposure_s = np.fmin(_numbers(flown, "onset_s"), _numbers(flown, "flight_s"))
    hours = float(np.nansum(exposure_s)) / 3600.0
    if hours == 0.0:
        return {"exposure_h": 0.0}
    events = int(_flags(flown, "false_alarm").sum())
    low, high = poisson_rate(events, hours)
    return {
        "exposure_h": hours,
        "false_alarm_per_hour": events / hours,
        "false_alarm_low_per_hour": float(low),
        "false_alarm_high_per_hour": float(high),
    }


def _times(flown: pd.DataFrame) -> dict[str, Value]:
    time_s = _present(_numbers(flown, "detection_time_s"))
    quantiles = {"median": 0.5, "p95": 0.95, "max": 1.0}
    line: dict[str, Value] = {"detections": len(time_s)}
    if len(time_s):
        at = np.quantile(time_s, list(quantiles.values()), method="inverted_cdf")
        line |= {f"detection_time_{name}_s": float(t) for name, t in zip(quantiles, at, strict=True)}
    return line | {
        "detection_time_limit_s": _extreme(np.min, _numbers(flown, "detection_time_limit_s")),
        "normalized_detection_time_max": _extreme(np.max, _numbers(flown, "normalized_detection_time")),
        "margin_healthy_max": _extreme(np.max, _numbers(flown, "margin_healthy")),
    }


def _extreme(which: Callable[[Floats], np.float64], values: Floats) -> float | None:
    present = _present(values)
    return float(which(present)) if len(present) else None


def _present(values: Floats) -> Floats:
    return values[~np.isnan(values)]


def _numbers(table: pd.DataFrame, column: str) -> Floats:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan)


def _flags(table: pd.DataFrame, column: str) -> Booleans:
    return np.asarray(_numbers(table, column) == 1.0, dtype=bool)
