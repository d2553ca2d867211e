"""The list of what a folder of results holds; a shard that is not listed does not exist.

A line is written whole, with its own checksum. A last line without its end is an append that a crash cut off: its flights are
flown again. Any other line that is not as it was written is damage, which nobody reads over.
"""

import json
import os
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from fddbench.errors import ResultsError
from fddbench.results.shards import write_bytes

__all__ = ["SHARD_FILE", "Shard", "Survey", "append", "keep", "shards", "survey"]

_NAME = "manifest.jsonl"
SHARD_FILE = re.compile(r"(rows|events|tallies)/[0-9-]+\.parquet")
"""Names of shards in a folder of results."""


@dataclass(frozen=True, kw_only=True)
class Shard:
    """One finished chunk.

    Attributes
    ----------
    cases : tuple of (first, count)
        Runs of case numbers in it.
    rows, rows_sha256 : str
        File of rows inside the folder, and its sha256.
    events, events_sha256 : str or None
        File of events, None when the chunk has none.
    statuses : mapping of str to int
        Rows by status.
    fingerprint : str
        Of the campaign and the program that flew it.
    detectors : tuple of str
        Those that it has rows of; empty: all of its campaign.
    tallies, tallies_sha256 : str or None
        File of what is counted of all its rows, where its campaign does not keep all; see `fddbench.results.tallies`.
    """

    cases: tuple[tuple[int, int], ...]
    rows: str
    rows_sha256: str
    events: str | None
    events_sha256: str | None
    statuses: dict[str, int]
    fingerprint: str
    detectors: tuple[str, ...] = ()
    tallies: str | None = None
    tallies_sha256: str | None = None

    @property
    def files(self) -> tuple[tuple[str, str], ...]:
        """Its files by their names in the folder, each with its sha256: the rows first."""
        named = (
            (self.rows, self.rows_sha256),
            (self.events, self.events_sha256),
            (self.tallies, self.tallies_sha256),
        )
        return tuple((name, sha256) for name, sha256 in named if name is not None and sha256 is not None)

    @property
    def n_rows(self) -> int:
        """Rows that were flown, kept or not."""
        return sum(self.statuses.values())

    @property
    def numbers(self) -> set[int]:
        """Case numbers in it, in the plan of the campaign that flew it."""
        return {case for first, count in self.cases for case in range(first, first + count)}


@dataclass(frozen=True)
class Survey:
    """What a manifest says: the shards it lists, and in words what is wrong with it otherwise."""

    shards: tuple[Shard, ...]
    wrong: tuple[str, ...] = field(default=())


def append(folder: Path, shard: Shard) -> None:
    """Add one line, durably."""
    # never through a link: what it points to is somebody else's
    handle = os.open(folder / _NAME, os.O_WRONLY | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0))
    try:
        with os.fdopen(handle, "ab") as file:
            file.write(_line(shard))
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        error.filename = error.filename or str(folder / _NAME)
        raise


def keep(folder: Path, kept: Sequence[Shard]) -> None:
    """List these shards only, in one step; what is not listed any more is flown again."""
    write_bytes(folder / _NAME, b"".join(map(_line, kept)))


def shards(folder: Path) -> tuple[Shard, ...]:
    """What is listed; a last line cut off by a crash is no line.

    Raises
    ------
    ResultsError
        The list is missing, or a line of it is not as it was written.
    """
    found = survey(folder)
    if found.wrong:
        more = f" (and {len(found.wrong) - 1} more like it)" if len(found.wrong) > 1 else ""
        raise ResultsError(
            f"{folder / _NAME}, {found.wrong[0]}{more}. Nothing is read from a list that is damaged: put the file back, or "
            "run the campaign again on this folder, it flies again what is lost"
        )
    return found.shards


def survey(folder: Path) -> Survey:
    """What is listed and what is wrong, without a refusal, for who mends it.

    Raises
    ------
    ResultsError
        There is no list at all.
    """
    try:
        *lines, _cut_off = (folder / _NAME).read_bytes().split(b"\n")
    except OSError as error:
        raise ResultsError(
            f"{folder / _NAME} cannot be read ({error.strerror}), so nobody knows what {folder} holds; put it back, or fly "
            "everything anew with --fresh"
        ) from error
    found: list[Shard] = []
    wrong: list[str] = []
    listed: dict[tuple[str, tuple[str, ...]], set[int]] = {}
    for number, line in enumerate(lines, start=1):
        shard = _shard(line)
        if shard is None:
            wrong.append(f"line {number}: it is not the line that was written")
            continue
        numbers, taken = shard.numbers, listed.setdefault((shard.fingerprint, shard.detectors), set())
        if numbers & taken:
            wrong.append(f"line {number}: it lists flights that an earlier line has (case {min(numbers & taken)})")
        else:
            found.append(shard)
            taken |= numbers
    return Survey(tuple(found), tuple(wrong))


def _line(shard: Shard) -> bytes:
    """Line of a shard, ended, with the sha256 of the rest of it."""
    content: dict[str, Any] = asdict(shard)
    if not shard.detectors:  # as it was before folders could grow
        del content["detectors"]
    if shard.tallies is None:
        del content["tallies"], content["tallies_sha256"]
    text = json.dumps(content)
    return json.dumps(content | {"line_sha256": sha256(text.encode()).hexdigest()}).encode() + b"\n"


def _shard(line: bytes) -> Shard | None:
    """Shard of a line, None for one that is not as it was written or names files elsewhere."""
    try:
        entry = json.loads(line)
        del entry["line_sha256"]
        entry["cases"] = tuple((int(first), int(count)) for first, count in entry["cases"])
        entry["detectors"] = tuple(str(name) for name in entry.get("detectors", ()))
        shard = Shard(**entry)
        sound = all(SHARD_FILE.fullmatch(name) for name, _ in shard.files) and _line(shard) == line + b"\n"
        return shard if sound else None
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None
