"""Everything that can be found wrong with a folder of results without flying: for who audits it, and writes nothing."""

from collections.abc import Iterator
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results import manifest
from fddbench.results.folder import changed_files, provenance_of
from fddbench.results.manifest import Shard
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.shards import open_table
from fddbench.results.whole import holdings

__all__ = ["wrong_with"]


def wrong_with(folder: Path) -> Iterator[str]:
    """What is damaged, missing or foreign, in words with its place; nothing for a sound and whole folder.

    Raises
    ------
    ResultsError
        It is no folder of results, or nobody can say what it should hold: no provenance, no list.
    """
    listed = provenance_of(folder)["fingerprints"]
    for name in changed_files(folder):
        yield f"{folder / name} is not the file of these results, or is gone"
    found = manifest.survey(folder)
    yield from (f"manifest.jsonl, {text}" for text in found.wrong)
    for shard in found.shards:
        yield from _wrong_shard(folder, shard, listed)
    known = {name for shard in found.shards for name in (shard.rows, shard.events) if name}
    for which in ("rows", "events"):
        stray = sorted(f"{which}/{path.name}" for path in (folder / which).glob("*.parquet"))
        yield from (f"{folder / name} is not listed: nobody reads it" for name in stray if name not in known)
    try:
        whole = holdings(folder)
    except ResultsError as error:
        yield str(error)
        return
    if whole.partial:
        yield f"it is not whole: {whole.sentence}"


def _wrong_shard(folder: Path, shard: Shard, listed: list[str]) -> Iterator[str]:
    """What is wrong with the files of a line, and whether they hold what it says."""
    if shard.fingerprint not in listed:
        yield f"{folder / shard.rows} was flown by a campaign or program that the folder does not list"
    files = (
        (shard.rows, shard.rows_sha256, rows_schema(())),
        (shard.events, shard.events_sha256, EVENTS),
    )
    for name, sha256, schema in files:
        if name is None or sha256 is None:
            continue
        try:
            table = open_table(folder / name, sha256, schema=schema, fingerprint=shard.fingerprint)
        except ResultsError as error:
            yield str(error).split("; ")[0]
            continue
        if name == shard.rows and table.metadata.num_rows != sum(shard.statuses.values()):
            yield f"{folder / name} has {table.metadata.num_rows} rows, its line says {sum(shard.statuses.values())}"
