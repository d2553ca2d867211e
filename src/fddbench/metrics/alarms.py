"""False alarms of distinct flights, of a scenario's and of a detector's: counts, rate per hour, share of flights."""

from collections.abc import Collection

import pandas as pd
import pyarrow as pa

from fddbench.metrics.distinct import NEEDS, distinct_flights
from fddbench.metrics.exposure import alarm_rate
from fddbench.metrics.shares import column, flown_of, percents, pools, share_columns

__all__ = ["ALARMS", "alarm_columns", "of_flights", "summarize_alarms"]


def alarm_columns() -> list[pa.Field]:
    """Columns of `of_flights`."""
    return [
        column("distinct_flights", pa.int64(), "flights until their onsets, each once however many scenarios share it"),
        column("alarms", pa.int64(), "those with a false alarm"),
        *share_columns("alarms", "distinct flights with a false alarm; needs no constant rate"),
        column("exposure_h", pa.float64(), "healthy flight up to the first alarm [h]"),
        column("false_alarm_per_hour", pa.float64(), "alarms over exposure: mean rate until the first alarm [1/h]"),
        column("false_alarm_low_per_hour", pa.float64(), "lower end of its 95 % interval, by run [1/h]"),
        column("false_alarm_high_per_hour", pa.float64(), "upper end [1/h]"),
    ]


ALARMS = pa.schema(
    [
        column("detector", pa.string(), "name of the design"),
        column("in_sample", pa.bool_(), "the design was tuned on flights of this campaign and seed"),
        column("pools", pa.string(), "what the line pools beside runs, such as 2 manoeuvres; null: nothing"),
        column("runs", pa.int64(), "independent runs that the flights come from"),
        *alarm_columns(),
    ]
)


def of_flights(flown: pd.DataFrame) -> dict[str, int | float | None]:
    """False alarms of the distinct flights among rows of one detector with status ok."""
    flights = distinct_flights(flown)
    rate = alarm_rate(flights.alarm, flights.time_s, flights.run)
    return {
        "distinct_flights": rate.flights,
        "alarms": rate.alarms,
        **percents("alarms", rate.share.share, rate.share.low, rate.share.high),
        "exposure_h": rate.exposure_h,
        "false_alarm_per_hour": rate.per_hour,
        "false_alarm_low_per_hour": rate.low,
        "false_alarm_high_per_hour": rate.high,
    }


def summarize_alarms(rows: pd.DataFrame, *, in_sample: Collection[str] = ()) -> pd.DataFrame:
    """One line per detector in order of appearance, over all its distinct flights; columns of `ALARMS`."""
    lines = []
    for detector, group in rows[list(NEEDS)].groupby("detector", sort=False):
        flown = flown_of(group)
        who = {"detector": detector, "in_sample": detector in in_sample, "runs": flown["run"].nunique()}
        lines.append(who | {"pools": pools(flown, "manoeuvre", "point")} | of_flights(flown))
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=ALARMS).to_pandas(types_mapper=pd.ArrowDtype)
    return found
