"""Reads the tables of a folder of results, by its manifest."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import shards
from fddbench.results.schema import CASE, EVENTS
from fddbench.results.shards import read_table

__all__ = ["load", "load_events", "named"]

_ADDRESS = ("scenario", "point", "level", "run")
"""Columns that name a flight; ``case``, made of them when rows are read, is their text: jam_a/3/0/17."""


def load(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows of a campaign, one per case and detector, in the order of the campaign's scenarios, cases and detectors.

    Arrow-backed, so that null stays null. ``frame.attrs["columns"]`` says what each column means, as `fddbench.columns` does;
    ``case`` names the flight, ``jam_a/3/0/17``, as messages do and as `fddbench.signals` takes it.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    columns : sequence of str, optional
        Only these; a large campaign then takes a fraction of the memory.

    Raises
    ------
    ResultsError
        No folder of results, or a shard that is damaged.
    """
    path = Path(folder)
    tables = _tables(path, "rows", None if columns is None else {*columns, *_ADDRESS, "detector"} - {"case"})
    if not tables:
        raise ResultsError(f"{path} holds no rows yet; run the campaign first")
    return _sorted(pa.concat_tables(tables, promote_options="default"), path, columns)


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a campaign, one per case, detector and fault of scenarios with several or ending faults; may be empty."""
    path = Path(folder)
    return _sorted(pa.concat_tables([EVENTS.empty_table(), *_tables(path, "events")]), path)


def named(table: pa.Table) -> pa.Table:
    """The table with the names of its flights as its first column, ``case``."""
    parts = [pc.cast(table[name], pa.string()) for name in _ADDRESS]
    return table.add_column(0, CASE, pc.binary_join_element_wise(*parts, "/"))


def _tables(folder: Path, which: str, columns: Collection[str] | None = None) -> Sequence[pa.Table]:
    provenance_of(folder)
    found = []
    for shard in shards(folder):
        listed = {"rows": (shard.rows, shard.rows_sha256), "events": (shard.events, shard.events_sha256)}
        name, sha256 = listed[which]
        if name is not None and sha256 is not None:
            found.append(read_table(folder / name, sha256, None if columns is None else sorted(columns)))
    return found


def _sorted(table: pa.Table, folder: Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Sorted by scenario, point, level, run, detector and event; in Arrow, which copies once."""
    provenance = provenance_of(folder)
    keys = table.select([name for name in ("point", "level", "run", "event") if name in table.column_names])
    for name, listed in (("scenario", "scenarios"), ("detector", "designs_sha256")):
        order: Any = provenance.get(listed) or pc.unique(table[name]).to_pylist()
        keys = keys.append_column(name, pc.index_in(table[name], value_set=pa.array(list(order), pa.string())))
    by = [name for name in (*_ADDRESS, "detector", "event") if name in keys.column_names]
    in_order = named(table.take(pc.sort_indices(keys, sort_keys=[(name, "ascending") for name in by])))
    chosen = in_order if columns is None else in_order.select(list(columns))
    frame: pd.DataFrame = chosen.to_pandas(types_mapper=pd.ArrowDtype)
    frame.attrs["columns"] = {field.name: (field.metadata or {}).get(b"about", b"").decode() for field in chosen.schema}
    return frame
