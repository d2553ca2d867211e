"""Reads the tables of a folder of results, by its manifest."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from fddbench.errors import PartialResultsWarning, ResultsError, warn
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import shards
from fddbench.results.schema import CASE, EVENTS, rows_schema
from fddbench.results.shards import open_table, read_columns
from fddbench.results.whole import holdings

__all__ = ["load", "load_events", "named", "read_events", "read_in_parts", "read_rows"]

_AT_ONCE = 3  # columns
_MANY = 50_000  # rows: about 10 MB of what a summary needs
_ADDRESS = ("scenario", "point", "level", "run")
"""Columns that name a flight; ``case``, made of them when rows are read, is their text: jam_a/3/0/17."""


@dataclass(frozen=True, kw_only=True)
class _Opened:
    """Table of a shard, ready to be read, and which of its rows are wanted; None: all."""

    path: Path
    file: pq.ParquetFile
    wanted: pa.ChunkedArray | None = None

    def read(self, names: Sequence[str]) -> pa.Table:
        """Some columns of its wanted rows."""
        table = read_columns(self.path, self.file, names).replace_schema_metadata(None)
        return table if self.wanted is None else table.filter(self.wanted)

    def of(self, detector: str) -> "_Opened":
        """The rows of one detector only."""
        return replace(self, wanted=pc.equal(self.read(["detector"])["detector"], detector))


def load(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows of a campaign, one per case and detector, in the order of cases and of the campaign's detectors.

    Arrow-backed, so that null stays null; the columns explain themselves in ``fddbench.results.schema`` and in
    ``rows.attrs["columns"]``.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    columns : sequence of str, optional
        Only these; a large campaign then takes a fraction of the memory.

    Warns
    -----
    PartialResultsWarning
        The folder does not hold all flights of its campaign.

    Raises
    ------
    ResultsError
        No folder of results, one whose list or shard is damaged, or one of another schema.
    """
    rows = read_rows(Path(folder), columns)
    _warn(Path(folder))
    return rows


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a campaign, one per case, detector and fault of scenarios with several or ending faults; may be empty.

    Warns and raises as `load`.
    """
    events = read_events(Path(folder))
    _warn(Path(folder))
    return events


def read_rows(folder: Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows as of `load`, for those who say themselves whether they are all.

    Raises
    ------
    ResultsError
        As `load`.
    """
    opened = _rows(folder)
    return _sorted(opened, folder, opened[0].file.schema_arrow, columns)


def read_in_parts(folder: Path, columns: Sequence[str]) -> Iterator[pd.DataFrame]:
    """Rows as of `read_rows`: all at once, or where they are many those of one detector after the other.

    Raises
    ------
    ResultsError
        As `load`.
    """
    opened = _rows(folder)
    detectors = list(provenance_of(folder)["designs_sha256"])
    if sum(each.file.metadata.num_rows for each in opened) <= _MANY:
        yield _sorted(opened, folder, opened[0].file.schema_arrow, columns)
        return
    for detector in detectors:
        yield _sorted([each.of(detector) for each in opened], folder, opened[0].file.schema_arrow, columns)


def read_events(folder: Path) -> pd.DataFrame:
    """Events as of `load_events`, for those who say themselves whether they are all.

    Raises
    ------
    ResultsError
        As `load`.
    """
    return _sorted(_opened(folder, "events", EVENTS), folder, EVENTS)


def named(table: pa.Table) -> pa.Table:
    """The table with the names of its flights as its first column, ``case``."""
    parts = [pc.cast(table[name], pa.string()) for name in _ADDRESS]
    return table.add_column(0, CASE, pc.binary_join_element_wise(*parts, "/"))


def _warn(folder: Path) -> None:
    found = holdings(folder)
    if found.partial:
        warn(
            f"{folder} is partial, it holds {found.sentence}; run the campaign again to fly the rest",
            PartialResultsWarning,
        )


def _rows(folder: Path) -> list[_Opened]:
    """Rows of all shards, ready to be read.

    Raises
    ------
    ResultsError
        There are none yet.
    """
    opened = _opened(folder, "rows", rows_schema(()))
    if not opened:
        raise ResultsError(f"{folder} holds no rows yet; run the campaign first")
    return opened


def _opened(folder: Path, which: str, schema: pa.Schema) -> list[_Opened]:
    """Tables of all shards that have one, ready to be read."""
    listed = provenance_of(folder)["fingerprints"]
    found = []
    for shard in shards(folder):
        if shard.fingerprint not in listed:
            raise ResultsError(
                f"{folder / shard.rows} was flown by a campaign or program that the folder does not list; fly the campaign "
                "anew with --fresh"
            )
        files = {"rows": (shard.rows, shard.rows_sha256), "events": (shard.events, shard.events_sha256)}
        name, sha256 = files[which]
        if name is not None and sha256 is not None:
            path = folder / name
            file = open_table(path, sha256, schema=schema, fingerprint=shard.fingerprint)
            found.append(_Opened(path=path, file=file))
    return found


def _sorted(
    opened: Sequence[_Opened], folder: Path, schema: pa.Schema, columns: Sequence[str] | None = None
) -> pd.DataFrame:
    """Sorted by scenario, point, level, run, detector and event; read a few columns at a time, for each is held twice."""
    if any(set(each.file.schema_arrow.names) != set(schema.names) for each in opened):
        raise ResultsError(f"the shards of {folder} have different columns; fly the campaign anew with --fresh")
    names = schema.names if columns is None else sorted({*columns, *_ADDRESS} - {CASE.name})
    keys = _read(opened, folder, schema, [name for name in (*_ADDRESS, "detector", "event") if name in schema.names])
    provenance = provenance_of(folder)
    for name, listed in (("scenario", "flights"), ("detector", "designs_sha256")):
        order: Any = provenance.get(listed) or pc.unique(keys[name]).to_pylist()
        place = pc.index_in(keys[name], value_set=pa.array(list(order), pa.string()))
        keys = keys.set_column(keys.column_names.index(name), name, place)
    places = pc.sort_indices(keys, sort_keys=[(name, "ascending") for name in keys.column_names])
    del keys
    parts = [
        _read(opened, folder, schema, names[j : j + _AT_ONCE]).take(places) for j in range(0, len(names), _AT_ONCE)
    ]
    fields = [field for part in parts for field in part.schema]
    in_order = pa.table([column for part in parts for column in part.columns], schema=pa.schema(fields))
    if columns is None or CASE.name in columns:
        in_order = named(in_order)
    chosen = in_order if columns is None else in_order.select(list(columns))
    frame: pd.DataFrame = chosen.to_pandas(types_mapper=pd.ArrowDtype)
    frame.attrs["columns"] = {field.name: (field.metadata or {}).get(b"about", b"").decode() for field in chosen.schema}
    return frame


def _read(opened: Sequence[_Opened], folder: Path, schema: pa.Schema, names: Sequence[str]) -> pa.Table:
    """Some columns of all shards, one after the other."""
    empty = pa.schema([schema.field(name) for name in names if name in schema.names]).empty_table()
    tables = [each.read(names) for each in opened]
    try:
        return pa.concat_tables(tables or [empty])
    except pa.ArrowException as error:
        raise ResultsError(
            f"the shards of {folder} have different columns; fly the campaign anew with --fresh"
        ) from error
