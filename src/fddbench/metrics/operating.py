"""Operating curves: false alarms against what is missed and how long it takes, for every value of a swept gain."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.metrics import distinct
from fddbench.metrics.alarms import alarm_columns, of_flights
from fddbench.metrics.shares import column, decided, flown_of, pools, share, share_columns

__all__ = ["NEEDS", "OPERATING", "OperatingPoint", "operating_curve"]

NEEDS = (*distinct.NEEDS, "scenario", "level", "outcome", "n_faulty", "detection_time_s")
"""Columns of the rows that `operating_curve` reads."""

_SHARES = {
    "missed": "faults not found in time (missed or late), of the decided flights",
    "wrong_site": "wrong_site, of the decided flights",
    "right": "right, of the decided flights",
}

OPERATING = pa.schema(
    [
        column("design", pa.string(), "name of the design that is swept"),
        column("gain", pa.string(), "key of the gain"),
        column("factor", pa.bool_(), "the value is a factor on what the design says [-]"),
        column("value", pa.float64(), "value of the gain, or the factor; null: the design says a list"),
        column("as_designed", pa.bool_(), "the point of the design itself"),
        column("detector", pa.string(), "name of the detector in the rows"),
        column("scenario", pa.string(), "name of the scenario, each with a fault"),
        column("pools", pa.string(), "what shares of outcomes pool beside runs, such as 4 points; null: nothing"),
        column("decided", pa.int64(), "flights whose outcome is decided"),
        *(field for name, about in _SHARES.items() for field in share_columns(name, about)),
        column("detections", pa.int64(), "flights with a detection time"),
        column("detection_time_median_s", pa.float64(), "their median [s], an observed value"),
        *alarm_columns(),
    ]
)


@dataclass(frozen=True, kw_only=True)
class OperatingPoint:
    """A detector on a curve: which gain of which design is swept, and where on it the detector stands."""

    design: str
    gain: str
    factor: bool
    value: float | None
    as_designed: bool
    detector: str


def operating_curve(rows: pd.DataFrame, points: Sequence[OperatingPoint]) -> pd.DataFrame:
    """One line per point of a curve and scenario with faults; columns of `OPERATING`, Arrow-backed.

    False alarms are those of all distinct flights of the detector, in whichever scenario, so they are the same in each of its
    lines; shares and times are those of the scenario. Intervals are by run.

    Parameters
    ----------
    rows : DataFrame
        As ``fddbench.load`` gives them, with the columns `NEEDS`.
    points : sequence of OperatingPoint
        Detectors in the order of the curves.
    """
    of = rows.groupby("detector", sort=False).indices
    lines = [line for point in points if point.detector in of for line in _lines(point, rows.iloc[of[point.detector]])]
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=OPERATING).to_pandas(types_mapper=pd.ArrowDtype)
    found.attrs["columns"] = {field.name: field.metadata[b"about"].decode() for field in OPERATING}
    return found


def _lines(point: OperatingPoint, rows: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """Lines of one detector, scenario by scenario."""
    flown = flown_of(rows)
    alarms = of_flights(flown)
    who = {name: getattr(point, name) for name in OperatingPoint.__dataclass_fields__}
    faulty = flown[np.asarray(flown["n_faulty"] > 0, dtype=bool)]
    for scenario, group in faulty.groupby("scenario", sort=False):
        outcome, sure = np.asarray(group["outcome"], dtype=object), decided(group)
        hits = {"missed": np.isin(outcome.astype(str), ["missed", "late"])}
        hits |= {name: outcome == name for name in ("wrong_site", "right")}
        line = {"scenario": scenario, "pools": pools(group, "point", "level"), "decided": int(sure.sum())}
        for name, hit in hits.items():
            line |= share(name, hit[sure], group["run"][sure])
        time_s = group["detection_time_s"].dropna().to_numpy(dtype=np.float64)
        line["detections"] = len(time_s)
        if len(time_s):
            line["detection_time_median_s"] = float(np.quantile(time_s, 0.5, method="inverted_cdf"))
        yield who | line | alarms
