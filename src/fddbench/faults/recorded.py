"""A recorded series in a file: read, checked, and put on the clock of a flight."""

from dataclasses import dataclass
from io import BytesIO
from typing import Any, Literal

import numpy as np
import pandas as pd

from fddbench.blocks.table import Table
from fddbench.errors import FddbenchError, reason_of
from fddbench.interfaces import Floats

__all__ = ["Recorded", "read_recorded"]

MOST_SAMPLES = 100_000
"""Longest recording on the clock of a flight [samples]: it becomes a part of the program that flies."""


@dataclass(frozen=True)
class Recorded:
    """Times since the first row [s] and values, in the unit of the sites.

    Attributes
    ----------
    time_s, value : Table
        As they stand in the file, (n_rows,) each.
    name : str
        Of the file, for messages.
    """

    time_s: Table
    value: Table
    name: str

    @property
    def length_s(self) -> float:
        """From the first row to the last [s]."""
        return float(self.time_s.values[-1])

    def on_clock(self, sample_s: float, between: Literal["linear", "previous"]) -> Floats:
        """Values at samples 0, 1, … up to the last that lies in the recording, (n_samples,).

        A row counts as read at a sample if it lies at most a millionth of a sample after it.
        """
        times_s, values = self.time_s.values, self.value.values
        at_s = np.arange(int(self.length_s / sample_s + 1e-6) + 1) * sample_s
        row = np.searchsorted(times_s, at_s + 1e-6 * sample_s, side="right") - 1
        if between == "previous":
            return values[row]
        after = np.minimum(row + 1, len(times_s) - 1)
        width_s = np.where(after > row, times_s[after] - times_s[row], 1.0)
        share = np.clip((at_s - times_s[row]) / width_s, 0.0, 1.0)
        return values[row] + share * (values[after] - values[row])


def read_recorded(name: str, content: bytes, column: str) -> Recorded:
    """Series of a CSV or Parquet file with the columns ``time_s`` and `column`; others are let be.

    Parameters
    ----------
    name : str
        Of the file; its ending says what it is.
    column : str
        Of the values, e.g. ``"value_deg_s"``.

    Raises
    ------
    FddbenchError
        It cannot be read, lacks a column, holds something else than finite numbers, or its times do not rise.
    """
    table = _table(name, content)
    missing = [each for each in ("time_s", column) if each not in table.columns]
    if missing:
        raise FddbenchError(
            f"{name} has no column {' and no column '.join(missing)}; it has {', '.join(map(str, table.columns)) or 'none'}. "
            f"A recorded series has the columns time_s and {column}, the unit being that of the sites; rename or convert"
        )
    time_s, value = (_numbers(name, table, each) for each in ("time_s", column))
    if len(time_s) < 2:
        raise FddbenchError(f"{name} has {len(time_s)} rows; a series needs two or more")
    falls = np.flatnonzero(np.diff(time_s) <= 0.0)
    if len(falls):
        row = int(falls[0]) + 1
        raise FddbenchError(
            f"{_place(name, row)}: time_s = {time_s[row]:.10g} does not lie after the row before it, {time_s[row - 1]:.10g}; "
            "sort the rows and leave each time once"
        )
    return Recorded(time_s=Table.of(time_s - time_s[0]), value=Table.of(value), name=name)


def _table(name: str, content: bytes) -> pd.DataFrame:
    try:
        if name.endswith(".parquet"):
            return pd.read_parquet(BytesIO(content))
        # as text: Python makes of it the number that is written, to the last bit
        table = pd.read_csv(BytesIO(content), dtype=str, keep_default_na=False, skipinitialspace=True, index_col=False)
        return table.rename(columns=str.strip)
    except Exception as error:  # pandas and pyarrow raise many kinds
        raise FddbenchError(
            f"{name} cannot be read: {reason_of(error)}. It must be a CSV file with one line of names, or Parquet"
        ) from error


def _numbers(name: str, table: pd.DataFrame, column: str) -> Floats:
    """A column as finite numbers."""
    found = np.array([_number(each) for each in table[column]], dtype=float)
    wrong = np.flatnonzero(~np.isfinite(found))
    if len(wrong):
        row = int(wrong[0])
        raise FddbenchError(
            f"{_place(name, row)}: {column} is {str(table[column].iloc[row])!r:.60}, it must be a finite number; remove the "
            f"row or fill it ({len(wrong)} of {len(found)} rows are so)"
        )
    return found


def _number(cell: Any) -> float:
    try:
        return float(cell)
    except (TypeError, ValueError):
        return np.nan


def _place(name: str, row: int) -> str:
    """Where a row stands, from 0: a line of a CSV file counts the one of names."""
    return f"{name} row {row}" if name.endswith(".parquet") else f"{name}:{row + 2}"
