"""The list of what a folder of results holds; a shard that is not listed does not exist."""

import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from fddbench.results.shards import file_sha256, write_bytes

__all__ = ["Shard", "append", "keep", "shards"]

_NAME = "manifest.jsonl"


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
    lines = path.read_text(encoding="utf-8").split("\n") if path.is_file() else []
    found = [shard for shard in map(_shard, lines) if shard is not None]
    return tuple(shard for shard in found if not intact or _intact(folder, shard))


def _shard(line: str) -> Shard | None:
    try:
        entry = json.loads(line)
        entry["cases"] = tuple((int(first), int(count)) for first, count in entry["cases"])
        return Shard(**entry)
    except (ValueError, TypeError, KeyError):
        return None


def _intact(folder: Path, shard: Shard) -> bool:
    files: Sequence[tuple[str | None, str | None]] = (
        (shard.rows, shard.rows_sha256),
        (shard.events, shard.events_sha256),
    )
    return all(name is None or file_sha256(folder / name) == sha256 for name, sha256 in files)
