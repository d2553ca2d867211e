"""Logs as tables: CSV with one line of names, and Parquet; one column is the time."""

import re
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fddbench.benchmarks.recorded.mapping import TimeOf
from fddbench.benchmarks.recorded.reading.series import Series, checked
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.interfaces import Floats
from fddbench.units import converts, unit_of_name

__all__ = ["CsvLog", "ParquetLog"]

_EMPTY = {"", "nan", "null", "none", "na", "n/a"}


class _Table:
    """A table that is read whole, its columns made numbers when they are asked for."""

    def __init__(self, path: Path, time: TimeOf, table: pd.DataFrame, first_line: int) -> None:
        self.path, self.time, self.table, self.first_line = path, time, table, first_line
        self.columns = tuple(map(str, table.columns))
        twice = sorted({name for name in self.columns if self.columns.count(name) > 1})
        if twice:
            raise FddbenchError(f"{path}: the column {twice[0]} is there twice; rename one")
        if not len(table):
            raise FddbenchError(f"{path}: no rows; a log needs two or more")
        self._require(time.column, " (the time; the mapping names another with `time: {column: …}`)")

    def place(self, row: int) -> str:
        """Where a row stands: a line of a CSV file, counted as editors do, or a row of a Parquet file, from 0."""
        return f"{self.path}:{row + self.first_line}" if self.first_line else f"{self.path} row {row}"

    def _require(self, column: str, more: str = "") -> None:
        if column not in self.columns:
            known = ", ".join(self.columns[:40]) + (", …" if len(self.columns) > 40 else "")
            hint = did_you_mean(column, self.columns)
            raise FddbenchError(
                " ".join(filter(None, [f"{self.path}: no column {column}{more}.", hint, f"It has {known}"]))
            )

    @cached_property
    def time_s(self) -> Floats:
        """Times of the rows [s]."""
        unit = self.time.unit or unit_of_name(self.time.column) or "s"
        return self._numbers(self.time.column) * converts(unit, "s")

    def series(self, column: str, missing: str) -> Series:
        """A channel, see `fddbench.benchmarks.recorded.reading.LogFile`."""
        self._require(column)
        values = self._numbers(column)
        return checked(self.time_s, values, column=column, time=self.time.column, missing=missing, place=self.place)

    def _numbers(self, column: str) -> Floats:
        """A column; not-a-number where a cell is empty.

        Raises
        ------
        FddbenchError
            A cell is text.
        """
        cells = self.table[column]
        if pd.api.types.is_bool_dtype(cells.dtype) or pd.api.types.is_numeric_dtype(cells.dtype):
            found: Floats = cells.to_numpy(dtype=np.float64, na_value=np.nan)
            return found
        if pd.api.types.is_datetime64_any_dtype(cells.dtype) or pd.api.types.is_timedelta64_dtype(cells.dtype):
            raise FddbenchError(f"{self.path}: {column} is a date; write it as seconds since the start")
        numbers = np.array([_number(cell) for cell in cells], dtype=object)
        wrong = [row for row, number in enumerate(numbers) if number is None]
        if wrong:
            cell, comma = (
                str(cells.iloc[wrong[0]]),
                "; decimals are written with a point"
                * (re.fullmatch(r"-?\d+,\d+", str(cells.iloc[wrong[0]])) is not None),
            )
            raise FddbenchError(
                f"{self.place(wrong[0])}: {column} is {cell!r:.40}, it must be a number{comma}; correct or remove the row "
                f"({len(wrong)} of {len(numbers)} rows are so)"
            )
        return numbers.astype(np.float64)


def _number(cell: Any) -> float | None:
    """A cell as the number that is written, to the last bit; not-a-number for none, None for text."""
    if cell is None:
        return np.nan
    text = str(cell).strip()
    if text.lower() in _EMPTY or text == "<NA>":
        return np.nan
    try:
        return float(text) if "_" not in text else None
    except ValueError:
        return None


class CsvLog(_Table):
    """A CSV file; lines before the names that begin with # are its header."""

    def __init__(self, path: Path, time: TimeOf) -> None:
        header = 0
        with path.open(encoding="utf-8-sig", errors="strict", newline="") as file:
            for line in file:
                if line.strip() and not line.startswith("#"):
                    break
                header += 1
            else:
                raise FddbenchError(f"{path}: empty; a log has a line of names and two rows or more")
        wide = line.count(",") + 1
        if wide == 1 and (";" in line or "\t" in line):
            raise FddbenchError(f"{path}:{header + 1}: columns are separated by commas here; write the file so")
        table = pd.read_csv(
            path, skiprows=header, dtype=str, keep_default_na=False, skipinitialspace=True, index_col=False,
            header=None, skip_blank_lines=False, encoding="utf-8-sig",
        )  # fmt: skip
        names = [str(name).strip() for name in table.iloc[0]]
        table = table.iloc[1:].reset_index(drop=True)
        while len(table) and all(
            cell == "" or cell is None for cell in table.iloc[-1].where(table.iloc[-1].notna(), "")
        ):
            table = table.iloc[:-1]
        table.columns = pd.Index(names)
        super().__init__(path, time, table, header + 2)


class ParquetLog(_Table):
    """A Parquet file."""

    def __init__(self, path: Path, time: TimeOf) -> None:
        super().__init__(path, time, pd.read_parquet(path), 0)
