"""One channel of a log: times and values, checked."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["Series", "checked"]

Place = Callable[[int], str]
"""Where a row of a file stands, for messages."""


@dataclass(frozen=True, eq=False)
class Series:
    """Rows of a channel.

    Attributes
    ----------
    time_s, values : (n_rows,) arrays
        Rising times [s], finite values in the unit of the log.
    skipped : int
        Rows without a value that were left out.
    place : callable
        Where a row stood in its file.
    """

    time_s: Floats
    values: Floats
    skipped: int
    place: Place


def checked(time_s: Floats, values: Floats, *, column: str, time: str, missing: str, place: Place) -> Series:
    """Series of rows as they stand in the file.

    Raises
    ------
    FddbenchError
        A time or a value is no number, or times do not rise: with the place, how many are so, and what to do.
    """
    _require_finite(time_s, time, place, "remove the row")
    there = np.isfinite(values)
    if missing == "refuse":
        cure = "fill it, or leave such rows out of their channel with `missing: skip`"
        _require_finite(np.where(np.isinf(values), 0.0, values), column, place, cure)
    _require_finite(np.where(np.isnan(values), 0.0, values), column, place, "remove the row")
    rows = np.flatnonzero(there)
    if len(rows) < 2:
        raise FddbenchError(f"{place(0)}: {column} has {len(rows)} usable rows; a channel needs two or more")
    kept = time_s[rows]
    falls = np.flatnonzero(np.diff(kept) <= 0.0)
    if len(falls):
        row = int(falls[0]) + 1
        same = kept[row] == kept[row - 1]
        what = "is there twice" if same else f"lies before that of the row before it, {kept[row - 1]:.10g}"
        cure = "leave each time once" if same else "sort the rows, or cut the log where its clock was set back"
        more = f" ({len(falls)} rows are so)" if len(falls) > 1 else ""
        raise FddbenchError(f"{place(int(rows[row]))}: {time} = {kept[row]:.10g} s {what}; {cure}{more}")
    return Series(
        time_s=kept, values=values[rows], skipped=len(values) - len(rows), place=lambda at: place(int(rows[at]))
    )


def _require_finite(numbers: Floats, column: str, place: Place, cure: str) -> None:
    wrong = np.flatnonzero(~np.isfinite(numbers))
    if len(wrong):
        row = int(wrong[0])
        what = "is empty or not-a-number" if np.isnan(numbers[row]) else "is infinite"
        raise FddbenchError(f"{place(row)}: {column} {what}; {cure} ({len(wrong)} of {len(numbers)} rows are so)")
