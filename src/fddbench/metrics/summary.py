"""One line per scenario and detector: outcomes, rates with their intervals, false alarms, detection times."""

from collections.abc import Callable, Collection
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from fddbench.interfaces import Floats
from fddbench.metrics import distinct
from fddbench.metrics.alarms import alarm_columns, of_flights
from fddbench.metrics.shares import column, decided, flown_of, pools, share, share_columns

__all__ = ["COUNTED", "NEEDS", "OF_FAULTS", "SUMMARY", "summarize"]

Value = int | float | str | bool | None

COUNTED = {
    "wrong_site": "flights in which a site was declared that has not been faulty",
    "right": "flights in which all faults were found in time",
    "late": "flights in which all faults were found, after the limit",
    "missed": "flights in which a fault was not found",
    "undecided": "flights that ended before the limit without a detection; no part of any rate",
    "false_alarm": "flights with an alarm before the onset, in a healthy flight at any time",
    "quiet": "healthy flights without an alarm",
}
"""Outcomes and what they count; they are exclusive and add up to the flown flights."""

OF_FAULTS = ("wrong_site", "right", "late", "missed", "undecided")
"""Those that a faulty flight can have beside a false alarm."""
_FLAGS = {
    "isolated": "flights that end with exactly the faulty sites declared; null: healthy, or only detects",
    "over_declared": "flights in which more sites were declared than had been faulty; null: healthy, or only detects",
}

NEEDS = (
    *dict.fromkeys(
        (*distinct.NEEDS, "scenario", "level", "outcome", "n_faulty", "departed_s", "isolated", "over_declared")
    ),
    *("detection_time_s", "detection_time_limit_s", "normalized_detection_time", "changes"),
    *("estimate_bias", "estimate_rms", "margin_healthy"),
)
"""Columns of the rows that `summarize` reads."""


SUMMARY = pa.schema(
    [
        column("scenario", pa.string(), "name of the scenario"),
        column("detector", pa.string(), "name of the design"),
        column("healthy", pa.bool_(), "no faulty site in this scenario"),
        column("in_sample", pa.bool_(), "the design was tuned on flights of this campaign and seed"),
        column("pools", pa.string(), "what the line pools beside runs, such as 4 points; null: nothing"),
        column("flights", pa.int64(), "all cases"),
        column("flown", pa.int64(), "cases with status ok"),
        column("infeasible", pa.int64(), "cases that cannot be flown"),
        column("failed", pa.int64(), "cases with any other status"),
        column("departed", pa.int64(), "flown flights that left the limits of their model before their end"),
        column("decided", pa.int64(), "flown flights but the undecided ones: what shares of outcomes are taken over"),
        *[column(name, pa.int64(), about) for name, about in COUNTED.items()],
        *share_columns("right", "right of the decided flights; healthy: null"),
        *share_columns("wrong_site", "wrong_site of the decided flights; healthy: null"),
        *[column(name, pa.int64(), about) for name, about in _FLAGS.items()],
        *alarm_columns(),
        column("detections", pa.int64(), "flights with a detection time: what its quantiles are taken over"),
        column("detection_time_median_s", pa.float64(), "their median [s], an observed value"),
        column("detection_time_p95_s", pa.float64(), "their 95 % quantile [s], an observed value"),
        column("detection_time_max_s", pa.float64(), "their maximum [s]"),
        column("detection_time_limit_s", pa.float64(), "requirement [s], the smallest in the scenario"),
        column("normalized_detection_time_max", pa.float64(), "largest detection time over its limit [-]"),
        column("changes_max", pa.int64(), "most changes of a declaration since the onset; 1 is clean"),
        column("estimate_bias_median", pa.float64(), "median bias of the estimate, in the unit of the site"),
        column("estimate_rms_median", pa.float64(), "median rms error of the estimate, in the unit of the site"),
        column("margin_healthy_max", pa.float64(), "largest residual over threshold while healthy [-]"),
    ]
)


def summarize(rows: pd.DataFrame, *, in_sample: Collection[str] = ()) -> pd.DataFrame:
    """Table of `SUMMARY` columns, Arrow-backed: scenarios in order of appearance, in each the detectors likewise.

    Shares of a scenario at one point and level have the exact interval; one that pools points or levels says so and is
    clustered by run. A single run has shares and no intervals.

    Parameters
    ----------
    rows : DataFrame
        As ``fddbench.load`` gives them, with the columns `NEEDS`; nulls are ``pd.NA`` or None.
    in_sample : collection of str
        Detectors whose designs were tuned on these very flights.

    Returns
    -------
    DataFrame
        One line per scenario and detector. Where nothing was flown counts are 0 and rates null.
    """
    rows = rows[list(NEEDS)]
    # places, not groups: all groups at once would be a second table
    groups = rows.groupby(["scenario", "detector"], sort=False).indices
    pairs = [(scenario, detector) for scenario in rows["scenario"].unique() for detector in rows["detector"].unique()]
    lines = [
        {"scenario": a, "detector": b, "in_sample": b in in_sample} | _line(rows.iloc[groups[a, b]])
        for a, b in pairs
        if (a, b) in groups
    ]
    summary: pd.DataFrame = pa.Table.from_pylist(lines, schema=SUMMARY).to_pandas(types_mapper=pd.ArrowDtype)
    return summary


def _line(group: pd.DataFrame) -> dict[str, Value]:
    infeasible = int(np.sum(np.asarray(group["status"] == "infeasible", dtype=bool)))
    flown = flown_of(group)
    healthy = bool(np.all(_numbers(group, "n_faulty") == 0))
    counts: dict[str, Value] = {
        "healthy": healthy,
        "pools": pools(group, "point", "level"),
        "flights": len(group),
        "flown": len(flown),
        "infeasible": infeasible,
        "failed": len(group) - len(flown) - infeasible,
        "departed": int(np.sum(~np.isnan(_numbers(flown, "departed_s")))),
    }
    counts["detection_time_limit_s"] = _extreme(np.min, _numbers(group, "detection_time_limit_s"))
    return counts | _outcomes(flown, healthy=healthy) | of_flights(flown) | _times(flown) | _quality(flown)


def _outcomes(flown: pd.DataFrame, *, healthy: bool) -> dict[str, Value]:
    """Counts of outcomes, and the shares of the decided flights."""
    outcome, sure = np.asarray(flown["outcome"], dtype=object), decided(flown)
    # where some flights have a fault in what they fly and some do not, rates are of those that have one
    faulty = _numbers(flown, "n_faulty") > 0
    sure = sure if healthy else sure & faulty
    line: dict[str, Value] = {"decided": int(sure.sum())}
    for name in COUNTED:
        applies = (
            name == "false_alarm"
            or (healthy if name not in OF_FAULTS else not healthy)
            or bool((outcome == name).any())
        )
        line[name] = int(np.sum(outcome == name)) if applies else None
    if not healthy:
        for name in ("right", "wrong_site"):
            line |= share(name, (outcome == name)[sure], flown["run"][sure])
        for name in _FLAGS:
            said = _present(_numbers(flown, name))
            line[name] = int(np.sum(said)) if len(said) else None
    return line


def _times(flown: pd.DataFrame) -> dict[str, Value]:
    time_s = _present(_numbers(flown, "detection_time_s"))
    quantiles = {"median": 0.5, "p95": 0.95, "max": 1.0}
    line: dict[str, Value] = {"detections": len(time_s)}
    if len(time_s):
        at = np.quantile(time_s, list(quantiles.values()), method="inverted_cdf")
        line |= {f"detection_time_{name}_s": float(t) for name, t in zip(quantiles, at, strict=True)}
    return line | {"normalized_detection_time_max": _extreme(np.max, _numbers(flown, "normalized_detection_time"))}


def _quality(flown: pd.DataFrame) -> dict[str, Value]:
    """Flicker, the error of the estimate, and the margin while healthy."""
    changes = _extreme(np.max, _numbers(flown, "changes"))
    return {
        "changes_max": None if changes is None else int(changes),
        "estimate_bias_median": _extreme(np.median, _numbers(flown, "estimate_bias")),
        "estimate_rms_median": _extreme(np.median, _numbers(flown, "estimate_rms")),
        "margin_healthy_max": _extreme(np.max, _numbers(flown, "margin_healthy")),
    }


def _extreme(which: Callable[[Floats], Any], values: Floats) -> float | None:
    present = _present(values)
    return float(which(present)) if len(present) else None


def _present(values: Floats) -> Floats:
    return values[~np.isnan(values)]


def _numbers(table: pd.DataFrame, name: str) -> npt.NDArray[np.float64]:
    return table[name].to_numpy(dtype=np.float64, na_value=np.nan)
