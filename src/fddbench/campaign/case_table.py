"""A table of explicit cases beside a campaign: a row a run, a column a parameter."""

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from fddbench.campaign.reading.document import Address, Document
from fddbench.errors import FddbenchError, Mistake, did_you_mean, reason_of
from fddbench.interfaces import Floats, Parameter

__all__ = ["AT", "CaseTable", "read_case_table"]

AT: Address = ("dispersions", "monte_carlo", "table")
_FIRST_ROW = 2  # of a CSV file, as an editor counts: the names stand in line 1

CaseTable = dict[str, Floats]
"""Values by name of the parameter, (n_rows,) each."""


def read_case_table(
    document: Document, folder: Path, parameters: tuple[Parameter, ...]
) -> tuple[CaseTable, dict[str, bytes], list[Mistake]]:
    """Table that a campaign names, the file that travels with it, and what is wrong with it; nothing where it names none."""
    name = document.get(*AT)
    if not isinstance(name, str):
        return {}, {}, []
    path = folder / name
    if Path(name).name != name or Path(name).suffix not in (".csv", ".parquet"):
        message = f"a table is a file beside the campaign that ends in .csv or .parquet, got {name!r}"
        return {}, {}, [document.mistake(AT, message)]
    try:
        content = path.read_bytes()
        columns = _columns(name, content)
    except OSError as error:
        return {}, {}, [document.mistake(AT, f"cannot read {path}: {error.strerror}; put the file beside the campaign")]
    except FddbenchError as error:
        return {}, {}, [document.mistake(AT, str(error))]
    wrong = [document.mistake(AT, f"{name}: {text}") for text in _wrong(document, columns, parameters)]
    return columns, {name: content}, wrong


def _columns(name: str, content: bytes) -> CaseTable:
    """Columns of a table as numbers."""
    import pandas as pd

    try:
        if name.endswith(".parquet"):
            table = pd.read_parquet(BytesIO(content))
        else:
            # as text: Python makes of it the number that is written, to the last bit
            table = pd.read_csv(
                BytesIO(content), dtype=str, keep_default_na=False, skipinitialspace=True, skip_blank_lines=False
            )
    except Exception as error:  # pandas and pyarrow raise many kinds
        raise FddbenchError(f"{name} cannot be read: {reason_of(error)}") from error
    return {str(column).strip(): _numbers(name, str(column), list(table[column])) for column in table.columns}


def _numbers(name: str, column: str, cells: list[Any]) -> Floats:
    found = np.empty(len(cells))
    for row, cell in enumerate(cells):
        try:
            found[row] = float(cell)
        except (TypeError, ValueError):
            raise FddbenchError(
                f"{name}, line {row + _FIRST_ROW}: {column.strip()} is {str(cell)!r:.40}, every row needs a number here"
            ) from None
    return found


def _wrong(document: Document, columns: CaseTable, parameters: tuple[Parameter, ...]) -> Iterator[str]:
    known = {one.name: one for one in parameters}
    n_rows = len(next(iter(columns.values()), ()))
    runs = document.get("dispersions", "monte_carlo", "runs")
    if not n_rows:
        yield "it has no row; a row is a run"
    elif isinstance(runs, int) and runs > n_rows:
        yield f"it has {n_rows} rows, a row a run, and runs is {runs}; ask for at most {n_rows} runs, or write more rows"
    for column, values in columns.items():
        if column not in known:
            hint = " ".join(filter(None, [did_you_mean(column, known), f"Known: {', '.join(known)}"]))
            yield f"no parameter is called {column!r}. {hint}"
            continue
        twice = [b for b in ("grid", "sequence", "monte_carlo") if column in document.mapping("dispersions", b)]
        if twice:
            yield f"{column} is dispersed in {twice[0]} as well; keep it in one place"
        low, high = known[column].low, known[column].high
        outside = np.flatnonzero(~((values >= low) & (values <= high)))  # what is no number lies nowhere
        if len(outside):
            row = int(outside[0])
            more = f" ({len(outside)} rows are so)" if len(outside) > 1 else ""
            yield f"line {row + _FIRST_ROW}: {column} must be within {low:g} to {high:g}, got {values[row]:g}{more}"
