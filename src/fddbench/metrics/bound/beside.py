"""The bound beside each score: which one a detector has, and where a score exceeds it."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
import pyarrow as pa

from fddbench.metrics.shares import column

__all__ = ["BESIDE", "breaches", "with_bounds"]

BESIDE = pa.schema(
    [
        column(
            "bound_d", pa.float64(), "median detectability of the faults to the ideal test [-], see `fddbench.bounds`"
        ),
        column(
            "bound_percent", pa.float64(), "largest share of right flights: P_D of the ideal test that knows most [%]"
        ),
    ]
)
"""What a line of a summary gets from the bounds; null where none is stated."""


def with_bounds(summary: pd.DataFrame, bounds: pd.DataFrame) -> pd.DataFrame:
    """A summary with the columns `BESIDE`, of the first model of each scenario, that which knows most.

    A detector that only detects stands beside the probability of an alarm.

    Parameters
    ----------
    summary, bounds : DataFrame
        As `fddbench.metrics.summary.summarize` and `fddbench.bounds` give them.
    """
    best = {line["scenario"]: line for line in reversed(_stated(bounds))}
    lines = []
    for line in summary.to_dict("records"):
        own, only_detects = best.get(line["scenario"]), pd.isna(line["isolated"])
        d, share = ("d_health", "p_detect") if only_detects else ("d", "p_d")
        lines.append({} if own is None else {"bound_d": own[d], "bound_percent": 100.0 * own[share]})
    more = pa.Table.from_pylist(lines, schema=BESIDE).to_pandas(types_mapper=pd.ArrowDtype)
    found: pd.DataFrame = pd.concat([summary.reset_index(drop=True), more], axis=1)
    return found


def breaches(summary: pd.DataFrame, bounds: pd.DataFrame) -> list[str]:
    """Sentences about scores that exceed a bound by more than their interval, and which assumption does not hold there.

    Under the model that knows most what is left to doubt is the one decision of the ideal test: a detector may alarm more often
    than that. Under the others it is the model: the aircraft is better known than it supposes.
    """
    knows_most: dict[str, str] = {}
    found = []
    for bound in _stated(bounds):
        best = knows_most.setdefault(bound["scenario"], bound["model"]) == bound["model"]
        for line in summary[(summary["scenario"] == bound["scenario"]).to_numpy(dtype=bool)].to_dict("records"):
            percent = 100.0 * bound["p_detect" if pd.isna(line["isolated"]) else "p_d"]
            if not pd.isna(line["right_low_percent"]) and line["right_low_percent"] > percent:
                fails = _decision(line, bound) if best else f"“{bound['about']}”; the aircraft is better known"
                found.append(
                    f"{line['detector']} in {line['scenario']}: {line['right_percent']:.1f} % right, at least "
                    f"{line['right_low_percent']:.1f} %, where “{bound['model']}” allows {percent:.1f} %. "
                    f"What fails is: {fails}."
                )
    return found


def _decision(line: Mapping[Any, Any], bound: Mapping[Any, Any]) -> str:
    """The assumption of one decision of few false alarms, and what the detector had."""
    return f"a false alarm in {bound['p_fa']:g} of decisions; it had {line['alarms']} in {line['distinct_flights']} flights"


def _stated(bounds: pd.DataFrame) -> list[dict[Any, Any]]:
    """Lines with a bound, in their order."""
    return bounds[bounds["model"].notna().to_numpy(dtype=bool)].to_dict("records")
