"""The list of what a folder of results holds; a shard that is not listed does not exist."""

import json
import os
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from fddbench.results.shards import file_sha256, write_bytes

__all__ = ["Shard", "append", "keep", "shards"]

_NAME = "manifest.jsonl"
_FILE = re.compile(r"(rows|events)/[0-9-]+\.parquet")


@dataclass(frozen=True, kw_only=True)
class Shard:
    """One finished chunk.

    Attributes
    ----------
    cases : tuple of (first, count)
        Runs of case numbers in it.
    rows, rows_sha256 : str
        File of rows inside the folder, and its fingerprint.
    events, events_sha256 : str or None
        File of events, None when the chunk has none.
    statuses : mapping of str to int
        Rows by status.
    """

    cases: tuple[tuple[int, int], ...]
    rows: str
    rows_sha256: str
    events: str | None
    events_sha256: str | None
    statuses: dict[str, int]


def append(folder: Path, shard: Shard) -> None:
    """Add one line, durably."""
    with (folder / _NAME).open("a", encoding="utf-8") as file:
        file.write(json.dumps(asdict(shard)) + "\n")
        file.flush()
        os.fsync(file.fileno())


def keep(folder: Path, kept: Sequence[Shard]) -> None:
    """List these shards only, in one step; what is not listed any more is flown again."""
    write_bytes(folder / _NAME, "".join(json.dumps(asdict(shard)) + "\n" for shard in kept).encode())


def shards(folder: Path, *, intact: bool = False) -> tuple[Shard, ...]:
    """What is listed; a last line cut off by a crash is no line.

    Parameters
    ----------
    folder : Path
        Folder of results.
    intact : bool
        Only shards whose files are there with the right fingerprint.
    """
    path = folder / _NAME
    lines = path.read_bytes().split(b"\n") if path.is_file() else []
    found: list[Shard] = []
    taken: set[int] = set()
    for shard in map(_shard, lines):
        if shard is not None and (not intact or _intact(folder, shard)):
            cases = {case for first, count in shard.cases for case in range(first, first + count)}
            if not cases & taken:
                found.append(shard)
                taken |= cases
    return tuple(found)


def _shard(line: bytes) -> Shard | None:
    """Shard of a line, None for one that is damaged or names files elsewhere."""
    try:
        entry = json.loads(line)
        entry["cases"] = tuple((int(first), int(count)) for first, count in entry["cases"])
        shard = Shard(**entry)
        names = (shard.rows, *([shard.events] if shard.events is not None else []))
        return shard if all(_FILE.fullmatch(name) for name in names) else None
    except (ValueError, TypeError, KeyError, AttributeError):
        return None


def _intact(folder: Path, shard: Shard) -> bool:
    files: Sequence[tuple[str | None, str | None]] = (
        (shard.rows, shard.rows_sha256),
        (shard.events, shard.events_sha256),
    )
    return all(name is None or file_sha256(folder / name) == sha256 for name, sha256 in files)
