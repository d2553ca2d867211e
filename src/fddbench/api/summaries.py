"""The summary of a folder of results by any columns, and as a file for a paper."""

import io
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from pyarrow import parquet

from fddbench.api.tables import in_sample, overview
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.metrics.summary import NEEDS, summarize
from fddbench.reporting.formats import present
from fddbench.reporting.paper import paper_table, to_html, to_latex, to_markdown
from fddbench.results import table
from fddbench.results.kept import kept_of

__all__ = ["FORMATS", "summary", "written"]

_BINS, _FEW = 5, 12
_ALWAYS = ("scenario", "detector")


def summary(folder: str | Path, by: str | Sequence[str] = (), *, bins: int = _BINS) -> pd.DataFrame:
    """One line per scenario and detector, and per value of any columns: outcomes, rates with intervals, detection times.

    The columns are those of `fddbench.metrics.summary.SUMMARY`, after `by`.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    by : str or sequence of str
        Columns of the rows to split by, ``"p_mass_kg"``, ``"run"``, ``"declared_sites"``, … A number of more than 12 values
        is cut into parts of about equally many flights, named by their ends.
    bins : int
        How many.

    Raises
    ------
    FddbenchError
        No folder of results, or no such column.

    Examples
    --------
    >>> summary("results/yaw_rate_gusts", by="p_gust_scale_ratio")  # doctest: +SKIP
    """
    asked = [by] if isinstance(by, str) else list(dict.fromkeys(by))
    columns = [name for name in asked if name not in _ALWAYS]
    if bins < 2:
        raise FddbenchError(f"bins = {bins}: at least 2 parts")
    own = in_sample(folder)
    if not columns:
        if kept_of(Path(folder)) is not None:
            counted = overview(Path(folder))[0]
            table.warn_if_partial(Path(folder), counted=True)
            return counted
        return summarize(table.load(folder, ["case", *NEEDS]), in_sample=own)
    rows = table.load(folder, fair=True)
    for name in columns:
        if name not in rows.columns:
            raise FddbenchError(
                " ".join(
                    filter(
                        None,
                        [f"the rows have no column {name!r}.", did_you_mean(name, list(rows.columns)), _known(rows)],
                    )
                )
            )
    parts = pd.DataFrame({name: _parted(rows[name], bins) for name in columns})
    found = []
    for values, group in rows.groupby([parts[name] for name in columns], sort=False, dropna=False):
        lines = summarize(group, in_sample=own)
        for name, value in zip(reversed(columns), reversed(values), strict=True):
            one = value if present(value) else None
            lines.insert(0, name, pd.Series([one] * len(lines), index=lines.index, dtype=parts[name].dtype))
        found.append(lines)
    if not found:
        return summarize(rows, in_sample=own)
    return _ordered(pd.concat(found, ignore_index=True), columns, parts)


def _known(rows: pd.DataFrame) -> str:
    return f"Known: {', '.join(map(str, rows.columns))}"


def _parted(values: "pd.Series[Any]", bins: int) -> "pd.Series[Any]":
    """Values as they are, or as the names of the parts that they lie in."""
    if not pd.api.types.is_numeric_dtype(values) or pd.api.types.is_bool_dtype(values) or values.nunique() <= _FEW:
        return values
    numbers = values.to_numpy(dtype=np.float64, na_value=np.nan)
    edges = np.unique(np.nanquantile(numbers, np.linspace(0.0, 1.0, bins + 1)))
    place = np.clip(np.searchsorted(edges, numbers, side="right") - 1, 0, max(len(edges) - 2, 0))
    names = [f"{low:.6g} … {high:.6g}" for low, high in pairwise(edges)]
    texts = [None if np.isnan(number) else names[i] for number, i in zip(numbers, place.tolist(), strict=True)]
    return pd.Series(texts, index=values.index, dtype=pd.ArrowDtype(pa.string()))


def _ordered(lines: pd.DataFrame, columns: list[str], parts: pd.DataFrame) -> pd.DataFrame:
    """Scenarios and detectors in their order, in each the values from small to large."""
    ranks = []
    for name in reversed(columns):
        known = sorted(parts[name].dropna().unique(), key=_first_number)
        ranks.append(
            lines[name].map({value: i for i, value in enumerate(known)}).to_numpy(dtype=float, na_value=np.inf)
        )
    ranks += [pd.factorize(lines[name])[0] for name in ("detector", "scenario")]
    return lines.iloc[np.lexsort(ranks)].reset_index(drop=True)


def _first_number(value: object) -> tuple[float, str]:
    """Sorts numbers and names of parts by their lower end, other text by itself."""
    try:
        return float(str(value).split(" … ")[0]), ""
    except ValueError:
        return np.inf, str(value)


def written(folder: str | Path, how: str, *, by: str | Sequence[str] = ()) -> bytes:
    """Summary of a folder of results as the content of a file.

    Parameters
    ----------
    how : str
        One of `FORMATS`.

    Raises
    ------
    FddbenchError
        As `summary`, or another format.
    """
    if how not in FORMATS:
        raise FddbenchError(f"no table is written as {how!r}; known: {', '.join(FORMATS)}")
    columns = [by] if isinstance(by, str) else list(dict.fromkeys(by))
    return FORMATS[how](summary(folder, by), [name for name in columns if name not in _ALWAYS])


def _csv(lines: pd.DataFrame, by: Sequence[str]) -> bytes:
    del by
    return lines.to_csv(index=False).encode()


def _parquet(lines: pd.DataFrame, by: Sequence[str]) -> bytes:
    del by
    stream = io.BytesIO()
    parquet.write_table(pa.Table.from_pandas(lines, preserve_index=False), stream)
    return stream.getvalue()


FORMATS: Mapping[str, Callable[[pd.DataFrame, Sequence[str]], bytes]] = {
    "csv": _csv,
    "parquet": _parquet,
    "latex": lambda lines, by: to_latex(paper_table(lines, by)).encode(),
    "markdown": lambda lines, by: to_markdown(paper_table(lines, by)).encode(),
    "html": lambda lines, by: to_html(paper_table(lines, by)).encode(),
}
"""What a summary can be written as."""
