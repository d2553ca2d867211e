"""Everything that can be found wrong with a folder of results without flying: for who audits it, and writes nothing."""

from collections.abc import Iterator
from pathlib import Path

import pyarrow.parquet as pq

from fddbench.errors import ResultsError
from fddbench.results import manifest
from fddbench.results.folder import changed_files, provenance_of
from fddbench.results.kept import kept_in
from fddbench.results.manifest import Shard
from fddbench.results.ours import TABLES
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.shards import open_table
from fddbench.results.tallies import TALLIES
from fddbench.results.whole import holdings

__all__ = ["wrong_with"]


def wrong_with(folder: Path) -> Iterator[str]:
    """What is damaged, missing or foreign, in words with its place; nothing for a sound and whole folder.

    Raises
    ------
    ResultsError
        It is no folder of results, or nobody can say what it should hold: no provenance, no list.
    """
    provenance = provenance_of(folder)
    keeps_all = kept_in(provenance) is None
    for name in changed_files(folder):
        yield f"{folder / name} is not the file of these results, or is gone"
    found = manifest.survey(folder)
    yield from (f"manifest.jsonl, {text}" for text in found.wrong)
    for shard in found.shards:
        if shard.fingerprint not in provenance["fingerprints"]:
            yield f"{folder / shard.rows} was flown by a campaign or program that the folder does not list"
        yield from _wrong_shard(folder, shard, keeps_all=keeps_all)
    known = {name for shard in found.shards for name, _ in shard.files}
    for which in TABLES:
        stray = sorted(f"{which}/{path.name}" for path in (folder / which).glob("*.parquet"))
        yield from (f"{folder / name} is not listed: nobody reads it" for name in stray if name not in known)
    try:
        whole = holdings(folder)
    except ResultsError as error:
        yield str(error)
        return
    if whole.partial:
        yield f"it is not whole: {whole.sentence}"


def _wrong_shard(folder: Path, shard: Shard, *, keeps_all: bool) -> Iterator[str]:
    """What is wrong with the files of a line, and whether they hold what it says."""
    schemas = {"rows": rows_schema(()), "events": EVENTS, "tallies": TALLIES}
    for name, sha256 in shard.files:
        schema = schemas[name.split("/")[0]]
        try:
            table = open_table(folder / name, sha256, schema=schema, fingerprint=shard.fingerprint)
        except ResultsError as error:
            yield str(error).split("; ")[0]
            continue
        n = _stands_for(table, name, keeps_all=keeps_all)
        if n is not None and n != shard.n_rows:
            yield f"{folder / name} has {n} rows, its line says {shard.n_rows}"


def _stands_for(table: pq.ParquetFile, name: str, *, keeps_all: bool) -> int | None:
    """Rows that a table has or counts, where these must be all of its shard."""
    if name.startswith("tallies/"):
        return int(sum(table.read(columns=["rows"])["rows"].to_pylist()))
    return table.metadata.num_rows if name.startswith("rows/") and keeps_all else None
