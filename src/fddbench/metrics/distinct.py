"""Which rows are the same flight: scenarios and levels fly the same aircraft in the same air until their onsets."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["NEEDS", "DistinctFlights", "distinct_flights"]

NEEDS = (
    *("point", "run", "manoeuvre", "detector"),
    *("status", "onset_s", "flight_s", "false_alarm_time_s"),
)
"""Columns of the rows that `distinct_flights` reads; those of the first line say which flight it is."""

_SAME = NEEDS[:4]


@dataclass(frozen=True, kw_only=True)
class DistinctFlights:
    """One entry per flight and detector, in the order in which they first appear in the rows.

    Attributes
    ----------
    row : (n_flights,) array of int
        Position of the row that stands for the flight; its other columns are those of the flight.
    alarm : (n_flights,) array of bool
        Whether there was a false alarm.
    time_s : (n_flights,) array
        Time to it, or to the end of the healthy stretch [s].
    run : (n_flights,) array
        Run of the flight, as the rows name it.
    """

    row: npt.NDArray[np.int64]
    alarm: npt.NDArray[np.bool_]
    time_s: Floats
    run: npt.NDArray[Any]


def distinct_flights(rows: Mapping[str, Any] | Any) -> DistinctFlights:
    """Flights of a table of results, each counted once for every detector.

    Rows that share (point, run, manoeuvre, detector) are one flight until their onsets. The row with status ok and the
    longest healthy stretch (to the onset, to the end of a healthy flight, or to the departure, whichever is first) stands
    for it; of equals the first. What has no ok row was not flown, and a flight that is faulty from sample 0 on was never
    watched: neither is listed. Cost: one sort, about a second for a million rows.

    Parameters
    ----------
    rows : DataFrame or mapping of str to (n_rows,) arrays
        With the columns `NEEDS`; nulls are ``pd.NA``, None or NaN. Times in seconds.

    Returns
    -------
    DistinctFlights
        Positions, alarms, times and runs, (n_flights,) each.

    Raises
    ------
    FddbenchError
        A column is missing, or an ok row does not say how long it flew.

    Examples
    --------
    One aircraft flown healthy for 60 s and with a fault at 20 s; the detector alarms at 30 s:

    >>> flights = distinct_flights({
    ...     "point": [0, 0], "run": [7, 7], "manoeuvre": ["level", "level"], "detector": ["a", "a"],
    ...     "status": ["ok", "ok"], "onset_s": [20.0, None], "flight_s": [60.0, 60.0], "false_alarm_time_s": [None, 30.0],
    ... })
    >>> flights.row, flights.alarm, flights.time_s
    (array([1]), array([ True]), array([30.]))
    """
    import pandas as pd

    missing = [name for name in NEEDS if name not in rows]
    if missing:
        raise FddbenchError(f"need the columns {', '.join(NEEDS)}; these are missing: {', '.join(missing)}")
    ok = np.flatnonzero(np.asarray(pd.Series(rows["status"]) == "ok", dtype=bool))
    onset, flown, alarm = (_numbers(rows[name])[ok] for name in NEEDS[5:])
    if np.any(np.isnan(flown)):
        raise FddbenchError("need flight_s in every row with status ok: how long a flight was watched is its exposure")
    healthy = np.fmin(onset, flown)
    watched = (healthy > 0.0) | ~np.isnan(alarm)
    ok, healthy, alarm = ok[watched], healthy[watched], alarm[watched]
    flight = _numbered([pd.factorize(pd.Series(rows[name]))[0][ok] for name in _SAME])
    # the flight first, then the longest; lexsort is stable, so of equals the first row
    order = np.lexsort((-healthy, flight))
    chosen = order[np.flatnonzero(np.diff(flight[order], prepend=-1))]
    time_s, row = np.fmin(alarm, healthy)[chosen], ok[chosen]
    run = np.asarray(pd.Series(rows["run"]))[row]
    return DistinctFlights(row=row, alarm=~np.isnan(alarm[chosen]), time_s=time_s, run=run)


def _numbers(column: Any) -> Floats:
    import pandas as pd

    values: Floats = pd.to_numeric(pd.Series(column)).to_numpy(dtype=np.float64, na_value=np.nan)
    return values


def _numbered(codes: list[npt.NDArray[np.int64]]) -> npt.NDArray[np.int64]:
    """Number of each different combination of codes, (n,), counted in order of appearance."""
    import pandas as pd

    number = np.zeros(len(codes[0]), dtype=np.int64)
    for code in codes:  # numbered anew after each column, so that the product never overflows
        number = pd.factorize(number * (code.max(initial=0) + 2) + code + 1)[0]
    return number
