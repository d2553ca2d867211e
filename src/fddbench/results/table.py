"""Reads the tables of a folder of results, by its manifest."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import shards
from fddbench.results.schema import EVENTS
from fddbench.results.shards import read_table

__all__ = ["load", "load_events"]


def load(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows of a campaign, one per case and detector, in the order of cases and of the campaign's detectors.

    Arrow-backed, so that null stays null. ``frame.attrs["columns"]`` says what each column means, as `fddbench.columns` does.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    columns : sequence of str, optional
        Only these, ``case`` and ``detector`` among them; a large campaign then takes a fraction of the memory.

    Raises
    ------
    ResultsError
        No folder of results, or a shard that is damaged.
    """
    path = Path(folder)
    tables = _tables(path, "rows", columns)
    if not tables:
        raise ResultsError(f"{path} holds no rows yet; run the campaign first")
    return _sorted(pa.concat_tables(tables), path, ["case"])


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a campaign, one per case, detector and fault of scenarios with several or ending faults; may be empty."""
    path = Path(folder)
    return _sorted(pa.concat_tables([EVENTS.empty_table(), *_tables(path, "events")]), path, ["case", "event"])


def _tables(folder: Path, which: str, columns: Sequence[str] | None = None) -> Sequence[pa.Table]:
    provenance_of(folder)
    found = []
    for shard in shards(folder):
        listed = {"rows": (shard.rows, shard.rows_sha256), "events": (shard.events, shard.events_sha256)}
        name, sha256 = listed[which]
        if name is not None and sha256 is not None:
            found.append(read_table(folder / name, sha256, columns))
    return found


def _sorted(table: pa.Table, folder: Path, by: list[str]) -> pd.DataFrame:
    """Sorted by the first column, the detectors' order and the other columns; in Arrow, which copies once."""
    order: Any = provenance_of(folder).get("designs_sha256")
    names = pa.array(list(order) if isinstance(order, dict) else [], pa.string())
    keys = table.select(by).append_column("_rank", pc.index_in(table["detector"], value_set=names))
    in_order = pc.sort_indices(keys, sort_keys=[(name, "ascending") for name in (by[0], "_rank", *by[1:])])
    frame: pd.DataFrame = table.take(in_order).to_pandas(types_mapper=pd.ArrowDtype)
    frame.attrs["columns"] = {field.name: (field.metadata or {}).get(b"about", b"").decode() for field in table.schema}
    return frame
