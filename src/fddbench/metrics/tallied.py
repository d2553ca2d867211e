"""Summaries of flights of which only tallies are there: the same counts, rates and quantiles as those of all rows.

What needs every row is left out or bounded on the safe side: a share or rate that pools points or levels counts as if all
flights of an aircraft told the same, ``n_eff`` its runs less one (`fddbench.metrics.clustered`); estimates have no median.
Flights that scenarios share are those of the scenario that is watched longest (`tallied_alarms`).
"""

from collections.abc import Collection, Iterator
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.metrics.alarms import ALARMS
from fddbench.metrics.clustered import quantile_ratio
from fddbench.metrics.intervals import beta_interval, poisson_rate
from fddbench.metrics.shares import percents, pools
from fddbench.metrics.summary import COUNTED, OF_FAULTS, SUMMARY

__all__ = ["summarize_tallies", "tallied_alarms"]

Line = dict[str, Any]

_QUANTILES = {"median": 0.5, "p95": 0.95, "max": 1.0}
_CELL = ["scenario", "manoeuvre", "point", "level"]
_US_PER_H = 3_600_000_000


def summarize_tallies(tallies: pd.DataFrame, *, in_sample: Collection[str] = ()) -> pd.DataFrame:
    """Table of `fddbench.metrics.summary.SUMMARY` columns, as `fddbench.metrics.summary.summarize` makes it of rows.

    Parameters
    ----------
    tallies : DataFrame
        Columns of `fddbench.results.tallies.TALLIES`; scenarios and detectors in the order that the table is to have.
    in_sample : collection of str
        Detectors whose designs were tuned on these very flights.
    """
    lines = [
        {"scenario": scenario, "detector": detector, "in_sample": detector in in_sample} | _line(group)
        for (scenario, detector), group in _groups(tallies, ["scenario", "detector"])
    ]
    return _frame(lines, SUMMARY)


def tallied_alarms(tallies: pd.DataFrame, *, in_sample: Collection[str] = ()) -> pd.DataFrame:
    """Table of `fddbench.metrics.alarms.ALARMS` columns: of each manoeuvre and point the scenario that is watched longest.

    What scenarios share until their onsets is one flight, so that the healthy scenario stands for it where there is one.
    """
    lines = []
    for (detector,), group in _groups(tallies, ["detector"]):
        flown = group[group["status"] == "ok"]
        who = {"detector": detector, "in_sample": detector in in_sample, "runs": _runs(flown)}
        lines.append(who | {"pools": pools(flown, "manoeuvre", "point")} | _alarms(flown))
    return _frame(lines, ALARMS)


def _groups(tallies: pd.DataFrame, by: list[str]) -> Iterator[tuple[tuple[str, ...], pd.DataFrame]]:
    """Groups by their keys: scenarios as they appear, in each the detectors as they appear in all."""
    order = [list(tallies[name].unique()) for name in by]
    found: dict[Any, pd.DataFrame] = dict(list(tallies.groupby(by, sort=False)))
    for key in sorted(found, key=lambda key: [values.index(k) for values, k in zip(order, key, strict=True)]):
        yield key, found[key]


def _frame(lines: list[Line], schema: pa.Schema) -> pd.DataFrame:
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=schema).to_pandas(types_mapper=pd.ArrowDtype)
    return found


def _line(group: pd.DataFrame) -> Line:
    flown = group[group["status"] == "ok"]
    infeasible = int(group["rows"][group["status"] == "infeasible"].sum())
    healthy, n_rows, n_flown = not group["faulty"].any(), int(group["rows"].sum()), int(flown["rows"].sum())
    counts: Line = {
        "healthy": healthy,
        "pools": pools(group, "point", "level"),
        "flights": n_rows,
        "flown": n_flown,
        "infeasible": infeasible,
        "failed": n_rows - n_flown - infeasible,
        "departed": int(flown["rows"][flown["departed"]].sum()),
        "detection_time_limit_s": _extreme(group["detection_time_limit_min_s"], "min"),
        "normalized_detection_time_max": _extreme(flown["normalized_detection_time_max"], "max"),
        "changes_max": _extreme(flown["changes_max"], "max"),
        "margin_healthy_max": _extreme(flown["margin_healthy_max"], "max"),
    }
    return counts | _outcomes(flown, healthy=healthy) | _alarms(flown) | _times(flown)


def _outcomes(flown: pd.DataFrame, *, healthy: bool) -> Line:
    """Counts of outcomes, and the shares of the decided flights."""
    sure = flown[flown["outcome"] != "undecided"]
    sure = sure if healthy else sure[sure["faulty"]]
    line: Line = {"decided": int(sure["rows"].sum())}
    for name in COUNTED:
        n = int(flown["rows"][flown["outcome"] == name].sum())
        applies = name == "false_alarm" or (healthy if name not in OF_FAULTS else not healthy) or n > 0
        line[name] = n if applies else None
    if not healthy:
        for name in ("right", "wrong_site"):
            line |= _share(name, int(sure["rows"][sure["outcome"] == name].sum()), line["decided"], _runs(sure))
        for name in ("isolated", "over_declared"):
            said = flown[flown[name].notna()]
            line[name] = int(said["rows"][said[name].astype(bool)].sum()) if len(said) else None
    return line


def _runs(rows: pd.DataFrame) -> int:
    """Runs that there are at least: the most flights of one place."""
    return int(rows.groupby(["detector", *_CELL])["rows"].sum().max()) if len(rows) else 0


def _share(name: str, hits: int, trials: int, runs: int) -> Line:
    """Share in percent, its interval by run; see `fddbench.metrics.shares.share`."""
    if not trials:
        return percents(name, None, None, None)
    if runs < 2:
        return percents(name, hits / trials, None, None)
    # as many as runs tell that agree in themselves: p (1 - p) / v is then runs - 1
    effective = trials if trials <= runs else runs - 1
    shrunk = effective * quantile_ratio(trials, runs, 0.95) ** 2
    low, high = beta_interval(min(hits / trials * shrunk, shrunk), shrunk)
    return percents(name, hits / trials, float(low), float(high))


def _alarms(flown: pd.DataFrame) -> Line:
    """False alarms of distinct flights, as of `fddbench.metrics.exposure`."""
    cells = flown.groupby(_CELL, sort=False)["healthy_us"].sum().reset_index()
    # of equals the first: their flights are the same until the onset
    longest = (
        cells.loc[cells.groupby(["manoeuvre", "point"], sort=False)["healthy_us"].idxmax()] if len(cells) else cells
    )
    own = flown.merge(longest[_CELL], on=_CELL) if len(flown) else flown
    alarmed = own[own["outcome"] == "false_alarm"]
    flights, d = int(own["watched"].sum()), int(alarmed["watched"].sum())
    runs = int(own.groupby(_CELL)["watched"].sum().max()) if flights else 0
    hours = int(own["healthy_us"].sum()) / _US_PER_H
    line = {
        "distinct_flights": flights,
        "alarms": d,
        **_share("alarms", d, flights, runs),
        "exposure_h": hours,
        "false_alarm_per_hour": d / hours if hours else None,
        "false_alarm_low_per_hour": None,
        "false_alarm_high_per_hour": None,
    }
    if not hours or runs < 2:
        return line
    kappa = quantile_ratio(flights, runs, 0.95) ** 2 / _design_effect(own, alarmed, flights, runs)
    low, high = poisson_rate(kappa * d, kappa * hours)
    return line | {"false_alarm_low_per_hour": float(low), "false_alarm_high_per_hour": float(high)}


def _design_effect(own: pd.DataFrame, alarmed: pd.DataFrame, flights: int, runs: int) -> float:
    """What alarms that come early take from the exposure, at least 1, as if all flights of a run did the same."""
    d, total, effect = int(alarmed["watched"].sum()), int(own["healthy_us"].sum()), 1.0
    if d and flights > 1:
        # sum of (d_f - D/T t_f)^2 over the flights f, of whole numbers
        rate = d / total
        spread = d - 2.0 * rate * int(alarmed["healthy_us"].sum()) + rate**2 * float(sum(own["healthy_us2"]))
        effect = max(1.0, flights / (flights - 1) * spread / d)
    return effect if flights <= runs else effect * flights / (runs - 1)


def _times(flown: pd.DataFrame) -> Line:
    """Quantiles of the detection times: values at which the counts pass the shares, as of the inverted distribution."""
    found = flown[flown["detection_time_s"].notna()].sort_values("detection_time_s")
    line: Line = {"detections": int(found["rows"].sum())}
    if len(found):
        times, upto = (
            found["detection_time_s"].to_numpy(dtype=np.float64),
            found["rows"].cumsum().to_numpy(dtype=np.int64),
        )
        for name, share in _QUANTILES.items():
            # the first value at or below which at least this share lies
            place = int(np.searchsorted(upto, _at_least(share, int(upto[-1]))))
            line[f"detection_time_{name}_s"] = float(times[place])
    return line


def _at_least(share: float, n: int) -> int:
    """How many values lie at or below a quantile of n: NumPy's ``inverted_cdf``."""
    at = share * n
    return max(int(np.ceil(at)), 1)


def _extreme(values: "pd.Series[float]", which: str) -> float | None:
    present = values[values.notna()]
    return float(getattr(present, which)()) if len(present) else None
