"""Reads the tables of a folder of results, by its manifest."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import PartialResultsWarning, ResultsError, warn
from fddbench.results.filters import Condition, Filter, filter_of, listed, require_columns
from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.manifest import shards
from fddbench.results.schema import CASE, EVENTS, Explained, rows_schema
from fddbench.results.shards import open_table, read_columns
from fddbench.results.stages import Numbering
from fddbench.results.whole import holdings

__all__ = [
    "as_of_today",
    "column_names",
    "files",
    "load",
    "load_events",
    "named",
    "read_events",
    "read_in_parts",
    "read_rows",
    "warn_if_partial",
    "without_rows",
]

_MANY = 50_000  # rows: about 10 MB of what a summary needs
_ADDRESS = ("scenario", "point", "level", "run")
"""Columns that name a flight; ``case``, made of them when rows are read, is their text: jam_a/3/0/17."""
_KEYS = (*_ADDRESS, "detector", "event")
"""Columns that sort a table that has them."""


def load(
    folder: str | Path,
    columns: Sequence[str] | None = None,
    filters: Sequence[Condition] | None = None,
    *,
    fair: bool = False,
) -> pd.DataFrame:
    """Rows of a campaign, one per case and detector, in the order of cases and of the campaign's detectors.

    Arrow-backed, so that null stays null; the columns explain themselves in ``fddbench.results.schema`` and in
    ``rows.attrs["columns"]``.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    columns : sequence of str, optional
        Only these; a large campaign then takes a fraction of the memory.
    filters : sequence of (column, operator, value), optional
        Only rows that meet all of these, ``[("detector", "in", ["glr", "cusum"]), ("p_mass_kg", "<", 190e3)]``; operators are
        ``= == != < <= > >= in``, ``not in``; null meets none but ``("detection_time_s", "=", None)``. The rows that do not
        meet them are never together in memory.
    fair : bool
        Only rows that rates may be taken of: where a campaign does not keep all, those of the runs that it keeps whole.

    Warns
    -----
    PartialResultsWarning
        The folder does not hold all flights of its campaign, or its campaign does not keep all rows.

    Raises
    ------
    ResultsError
        No folder of results, one whose list or shard is damaged, one of another schema, or a filter that is none.
    """
    rows = read_rows(Path(folder), columns, filters, fair=fair)
    warn_if_partial(Path(folder), fair=fair)
    return rows


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a campaign, one per case, detector and fault of scenarios with several or ending faults; may be empty.

    Warns and raises as `load`.
    """
    events = read_events(Path(folder))
    warn_if_partial(Path(folder))
    return events


def read_rows(
    folder: Path,
    columns: Sequence[str] | None = None,
    filters: Sequence[Condition] | None = None,
    *,
    fair: bool = False,
) -> pd.DataFrame:
    """Rows as of `load`, for those who say themselves whether they are all.

    Raises
    ------
    ResultsError
        As `load`.
    """
    known = column_names(folder)
    if not known:
        raise without_rows(folder)
    if columns is not None:
        require_columns(columns, known)
    chosen = filter_of([*listed([] if filters is None else filters), *(_fair(folder) if fair else [])], known)
    return _sorted(folder, "rows", columns, chosen)


def _fair(folder: Path) -> list[Condition]:
    """Conditions of rows that rates may be taken of."""
    kept = kept_of(folder)
    return [] if kept is None else [("run", "<", kept.runs)]


def column_names(folder: Path) -> list[str]:
    """Names of the columns of the rows, ``case`` first; none where there is no shard."""
    known = provenance_of(folder).get("columns")
    if known:
        return [CASE.name, *known]
    for path, sha256, fingerprint in files(folder, "rows"):
        own = open_table(path, sha256, schema=rows_schema(()), fingerprint=fingerprint)
        return [CASE.name, *own.schema_arrow.names]
    return []


def read_in_parts(folder: Path, columns: Sequence[str]) -> Iterator[pd.DataFrame]:
    """Rows as of `read_rows` of a folder that keeps all: at once, or where they are many those of one detector at a time.

    Raises
    ------
    ResultsError
        As `load`.
    """
    if sum(shard.n_rows for shard in shards(folder)) <= _MANY:
        yield _sorted(folder, "rows", columns)
        return
    for detector in provenance_of(folder)["designs_sha256"]:
        yield _sorted(folder, "rows", columns, filter_of([("detector", "=", detector)], ["detector"]))


def read_events(folder: Path, columns: Sequence[str] | None = None, *, fair: bool = False) -> pd.DataFrame:
    """Events as of `load_events`, for those who say themselves whether they are all; only some columns; `fair` as of `load`.

    Raises
    ------
    ResultsError
        As `load`.
    """
    return _sorted(folder, "events", columns, filter_of(_fair(folder), EVENTS.names) if fair else None)


def named(table: pa.Table) -> pa.Table:
    """The table with the names of its flights as its first column, ``case``."""
    parts = [pc.cast(table[name], pa.string()) for name in _ADDRESS]
    return table.add_column(0, CASE, pc.binary_join_element_wise(*parts, "/"))


def warn_if_partial(folder: Path, *, fair: bool = False, counted: bool = False) -> None:
    """Warn where a folder does not hold all flights of its campaign, or does not keep all rows, unless all are counted."""
    found, kept = holdings(folder), kept_of(folder)
    if kept is not None and not counted:
        n = sum(shard.n_rows for shard in shards(folder))
        what = f"only {kept.first} are used" if fair else f"only {kept} are kept"
        warn(f"{folder}: of {n} rows {what}; fddbench.summary(folder) counts all", PartialResultsWarning)
    if found.partial:
        warn(
            f"{folder} is partial, it holds {found.sentence}; run the campaign again to fly the rest",
            PartialResultsWarning,
        )


def _sorted(folder: Path, which: str, columns: Sequence[str] | None = None, only: Filter | None = None) -> pd.DataFrame:
    """Table sorted by scenario, point, level, run, detector and event, of some rows or of all."""
    wanted = None if columns is None else sorted({*columns, *_ADDRESS} - {CASE.name})
    table = _read(folder, which, wanted, only)
    names = table.column_names if wanted is None else wanted
    left = dict(zip(table.column_names, table.columns, strict=True))
    fields = {field.name: field for field in table.schema}
    del table
    places = _places(folder, {name: left[name] for name in _KEYS if name in left})
    # column by column, each released when it is in order, so that no two tables are in memory
    ordered = [left.pop(name).take(places) for name in names]
    in_order = pa.table(ordered, schema=pa.schema([fields[name] for name in names]))
    if columns is None or CASE.name in columns:
        in_order = named(in_order)
    chosen = in_order if columns is None else in_order.select(list(columns))
    frame: pd.DataFrame = chosen.to_pandas(types_mapper=pd.ArrowDtype)
    about = {field.name: (field.metadata or {}).get(b"about", b"").decode() for field in chosen.schema}
    frame.attrs["columns"] = Explained(about)
    return frame


def _places(folder: Path, keys: Mapping[str, pa.ChunkedArray]) -> pa.Array:
    """Places of the rows in order: scenarios and detectors as the campaign has them."""
    provenance, by = provenance_of(folder), dict(keys)
    for name, key in (("scenario", "flights"), ("detector", "designs_sha256")):
        order: Any = provenance.get(key) or pc.unique(keys[name]).to_pylist()
        by[name] = pc.index_in(keys[name], value_set=pa.array(list(order), pa.string()))
    return pc.sort_indices(pa.table(by), sort_keys=[(name, "ascending") for name in by])


def _read(folder: Path, which: str, wanted: Sequence[str] | None, chosen: Filter | None) -> pa.Table:
    """Columns of all shards, those that sort among them, one shard after the other; of some rows or of all.

    Raises
    ------
    ResultsError
        As `load`, and there are no rows yet.
    """
    schema = {"rows": rows_schema(()), "events": EVENTS}[which]
    provenance = provenance_of(folder)
    numbering, all_names = Numbering(provenance), provenance.get("columns") if which == "rows" else None
    tables = []
    for path, sha256, fingerprint in files(folder, which):
        file = open_table(path, sha256, schema=schema, fingerprint=fingerprint)
        all_names = all_names or file.schema_arrow.names
        own = set(file.schema_arrow.names)
        if own - set(all_names) or (own != set(all_names) and "columns" not in provenance):
            raise _different(folder)
        asked = [name for name in (chosen.names if chosen else ()) if name != CASE.name]
        names = all_names if wanted is None else [*dict.fromkeys((*wanted, *asked, *_keys_in(all_names)))]
        there, points = [n for n in names if n in own or n not in all_names], numbering.points_of(fingerprint)
        for group in range(file.num_row_groups) if chosen else (None,):
            table = read_columns(path, file, there, group).replace_schema_metadata(None)
            table = as_of_today(table, names, points)
            tables.append(_chosen(table, chosen) if chosen else table)
    if not tables and which == "rows":
        raise without_rows(folder)
    try:
        return pa.concat_tables(tables or [EVENTS.empty_table()])
    except pa.ArrowException as error:
        raise _different(folder) from error


def _chosen(table: pa.Table, chosen: Filter) -> pa.Table:
    """Rows that meet conditions, perhaps on the names of flights."""
    if CASE.name in chosen.names:
        return chosen.rows_of(named(table)).drop_columns([CASE.name])
    return chosen.rows_of(table)


def as_of_today(table: pa.Table, names: Sequence[str], points: npt.NDArray[np.int64] | None) -> pa.Table:
    """A shard's table as the campaign of today numbers it: its points, and null for what only later flights vary."""
    if points is not None:
        place = table.schema.get_field_index("point")
        table = table.set_column(place, table.schema.field(place), pa.array(points[table["point"].to_numpy()]))
    for name in names:
        if name not in table.column_names:
            known = rows_schema((), [name]) if re.match(r"f\d+_", name) else rows_schema((), (), [name])
            table = table.append_column(known.field(name), pa.nulls(len(table), pa.float64()))
    return table.select(list(names))


def _keys_in(names: Sequence[str]) -> list[str]:
    return [name for name in _KEYS if name in names]


def without_rows(folder: Path) -> ResultsError:
    """What is said of a folder without any."""
    return ResultsError(f"{folder} holds no rows yet; run the campaign first")


def _different(folder: Path) -> ResultsError:
    return ResultsError(f"the shards of {folder} have different columns; fly the campaign anew with --fresh")


def files(folder: Path, which: str) -> Iterator[tuple[Path, str, str]]:
    """File, sha256 and fingerprint of each shard that has such a table."""
    listed = provenance_of(folder)["fingerprints"]
    for shard in shards(folder):
        if shard.fingerprint not in listed:
            raise ResultsError(
                f"{folder / shard.rows} was flown by a campaign or program that the folder does not list; fly the campaign "
                "anew with --fresh"
            )
        for name, sha256 in shard.files:
            if name.startswith(f"{which}/"):
                yield folder / name, sha256, shard.fingerprint
