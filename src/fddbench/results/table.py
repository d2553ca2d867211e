"""Reads the tables of a folder of results, by its manifest."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import PartialResultsWarning, ResultsError, warn
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import shards
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.shards import read_table
from fddbench.results.whole import holdings

__all__ = ["load", "load_events", "read_events", "read_rows"]


def load(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows of a campaign, one per case and detector, in the order of cases and of the campaign's detectors.

    Arrow-backed, so that null stays null; the columns explain themselves in ``fddbench.results.schema``.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    columns : sequence of str, optional
        Only these, ``case`` and ``detector`` among them; a large campaign then takes a fraction of the memory.

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
    tables = _tables(folder, "rows", rows_schema(()), columns)
    if not tables:
        raise ResultsError(f"{folder} holds no rows yet; run the campaign first")
    return _sorted(tables, folder, ["case"])


def read_events(folder: Path) -> pd.DataFrame:
    """Events as of `load_events`, for those who say themselves whether they are all.

    Raises
    ------
    ResultsError
        As `load`.
    """
    tables = [EVENTS.empty_table(), *_tables(folder, "events", EVENTS)]
    return _sorted(tables, folder, ["case", "event"])


def _warn(folder: Path) -> None:
    found = holdings(folder)
    if found.partial:
        warn(
            f"{folder} is partial, it holds {found.sentence}; run the campaign again to fly the rest",
            PartialResultsWarning,
        )


def _tables(folder: Path, which: str, schema: pa.Schema, columns: Sequence[str] | None = None) -> list[pa.Table]:
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
            options = {"schema": schema, "fingerprint": shard.fingerprint, "columns": columns}
            found.append(read_table(folder / name, sha256, **options))
    return found


def _sorted(tables: list[pa.Table], folder: Path, by: list[str]) -> pd.DataFrame:
    """Sorted by the first column, the detectors' order and the other columns; in Arrow, which copies once."""
    try:
        table = pa.concat_tables([each.replace_schema_metadata(None) for each in tables])
    except pa.ArrowException as error:
        raise ResultsError(
            f"the shards of {folder} have different columns; fly the campaign anew with --fresh"
        ) from error
    names = pa.array(list(provenance_of(folder)["designs_sha256"]), pa.string())
    keys = table.select(by).append_column("_rank", pc.index_in(table["detector"], value_set=names))
    in_order = pc.sort_indices(keys, sort_keys=[(name, "ascending") for name in (by[0], "_rank", *by[1:])])
    frame: pd.DataFrame = table.take(in_order).to_pandas(types_mapper=pd.ArrowDtype)
    return frame
