"""Few large files instead of many small ones: the shards of a folder joined, row by row as they are.

A shard is small so that little is flown again after a crash; a folder of a million flights then has a thousand. Joined shards
are written aside, the list of the folder is replaced in one step, and only then the small ones go: whatever moment a crash
comes at, the list names files that are there.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.errors import ResultsError
from fddbench.results import manifest
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import Shard
from fddbench.results.ours import TABLES
from fddbench.results.schema import EVENTS, FAILED, rows_schema
from fddbench.results.shards import file_sha256, open_table, read_columns, write_table, write_tables
from fddbench.results.tallies import TALLIES, added

__all__ = ["ENOUGH", "Compacted", "compact", "remove_unlisted", "require_sound"]

Cases = npt.NDArray[np.int64]

ENOUGH, _MOST = 100_000, 1_000_000
"""Rows from which on a shard is large, and that a joined one has about at most."""


@dataclass(frozen=True, kw_only=True)
class Compacted:
    """How many shards a folder had and has, and of how many rows."""

    before: int
    after: int
    rows: int


def compact(folder: Path, *, most: int = _MOST, only: str = "", least: int = 0) -> Compacted:
    """Join the small shards of a folder that were flown by one program for the same detectors; large ones keep their bytes.

    Few shards with failed rows stay as they are, so that ``--retry-failed`` has few flights to fly again.

    Parameters
    ----------
    folder : Path
        Folder of results, locked.
    most : int
        Rows that a joined shard has at most.
    only : str
        A fingerprint: leave the shards of others alone.
    least : int
        Rows in all of shards that belong together, below which they stay as they are.

    Raises
    ------
    ResultsError
        The list or a shard is damaged; nothing is written then.
    """
    listed = provenance_of(folder)["fingerprints"]
    before = manifest.shards(folder)
    after: list[Shard] = []
    for alike in _alike(before):
        ours = alike[0].fingerprint in listed and only in ("", alike[0].fingerprint)
        small = _sound([shard for shard in alike if ours and shard.n_rows < min(ENOUGH, most)])
        small = small if sum(each.n_rows for each in small) >= least else []
        require_sound(folder, small)
        joined = {shard.rows for shard in small}
        kept = [shard for shard in alike if shard.rows not in joined]
        after += kept + [_joined(folder, group) for group in _groups(small, most)]
    if len(after) < len(before):
        manifest.keep(folder, after)
        there = {name for shard in after for name, _ in shard.files}
        for name in {name for shard in before for name, _ in shard.files} - there:
            (folder / name).unlink(missing_ok=True)
    return Compacted(before=len(before), after=len(after), rows=sum(each.n_rows for each in after))


def require_sound(folder: Path, found: Sequence[Shard]) -> None:
    """Refuse damaged shards before anything is written.

    Raises
    ------
    ResultsError
        A file is not the one that was written.
    """
    for shard in found:
        for name, sha256 in shard.files:
            if file_sha256(folder / name) != sha256:
                raise ResultsError(
                    f"{folder / name} is damaged or gone; run the campaign again on this folder, it flies again what is lost"
                )


def _sound(found: list[Shard]) -> list[Shard]:
    """Shards without failed rows, where these are most: who flies the others again is to fly few flights."""
    sound = [shard for shard in found if not FAILED & {status for status, n in shard.statuses.items() if n}]
    return sound if 2 * len(sound) > len(found) else found


def _alike(listed: Sequence[Shard]) -> Iterator[list[Shard]]:
    """Shards of one fingerprint and the same detectors, in the order of their first flights."""
    kinds: dict[tuple[str, tuple[str, ...]], list[Shard]] = {}
    for shard in listed:
        kinds.setdefault((shard.fingerprint, shard.detectors), []).append(shard)
    for alike in kinds.values():
        yield sorted(alike, key=lambda shard: shard.cases)


def _groups(shards: Sequence[Shard], most: int) -> Iterator[list[Shard]]:
    """Shards one after the other while their rows are not too many, about equally many in every group."""
    total = sum(each.n_rows for each in shards)
    share = total / max(-(-total // most), 1)
    group = list[Shard]()
    for shard in shards:
        if group and sum(each.n_rows for each in group) + shard.n_rows / 2 > share:
            yield group
            group = []
        group.append(shard)
    if group:
        yield group


def _joined(folder: Path, group: list[Shard]) -> Shard:
    """One shard of several, written; a single one as it is."""
    if len(group) == 1:
        return group[0]
    numbers = np.sort(np.concatenate([np.arange(*_ends(span)) for shard in group for span in shard.cases]))
    label = PurePosixPath(group[0].rows).stem.split("-")[3:]
    name = "-".join([f"{numbers[0]:08d}-{numbers[-1]:08d}-{len(numbers)}", *label]) + ".parquet"
    fingerprint, statuses = group[0].fingerprint, dict[str, int]()
    for shard in group:
        statuses |= {status: statuses.get(status, 0) + n for status, n in shard.statuses.items()}
    events = [(shard.events, shard.events_sha256 or "") for shard in group if shard.events is not None]
    events_sha256 = _write(folder, f"events/{name}", events, EVENTS, fingerprint) if events else None
    rows = [(shard.rows, shard.rows_sha256) for shard in group]
    tallies = [(shard.tallies, shard.tallies_sha256 or "") for shard in group if shard.tallies is not None]
    return Shard(
        cases=_spans(numbers),
        rows=f"rows/{name}",
        rows_sha256=_write(folder, f"rows/{name}", rows, rows_schema(()), fingerprint),
        events=f"events/{name}" if events else None,
        events_sha256=events_sha256,
        statuses=dict(sorted(statuses.items())),
        fingerprint=fingerprint,
        detectors=group[0].detectors,
        tallies=f"tallies/{name}" if tallies else None,
        tallies_sha256=_write_added(folder, f"tallies/{name}", tallies, fingerprint) if tallies else None,
    )


def _write(folder: Path, name: str, parts: list[tuple[str, str]], schema: pa.Schema, fingerprint: str) -> str:
    """Write one table of several, group by group of rows; its sha256."""

    def tables() -> Iterator[pa.Table]:
        for path, sha256 in parts:
            opened = open_table(folder / path, sha256, schema=schema, fingerprint=fingerprint)
            yield read_columns(folder / path, opened, opened.schema_arrow.names)

    return write_tables(folder / name, tables())


def _write_added(folder: Path, name: str, parts: list[tuple[str, str]], fingerprint: str) -> str:
    """Write what several tallies add up to; its sha256."""
    opened = [(p, open_table(folder / p, sha256, schema=TALLIES, fingerprint=fingerprint)) for p, sha256 in parts]
    found = [read_columns(folder / path, file, TALLIES.names).cast(TALLIES) for path, file in opened]
    return write_table(folder / name, added(found), fingerprint=fingerprint)


def _ends(span: tuple[int, int]) -> tuple[int, int]:
    return span[0], sum(span)


def _spans(numbers: Cases) -> tuple[tuple[int, int], ...]:
    """Numbers in order as (first, count) of their unbroken stretches."""
    parts = np.split(numbers, np.flatnonzero(np.diff(numbers) != 1) + 1)
    return tuple((int(part[0]), len(part)) for part in parts)


def remove_unlisted(folder: Path) -> None:
    """Remove tables that nobody reads: damaged ones whose flights were flown again, small ones that a kill left behind.

    Raises
    ------
    ResultsError
        The list is damaged, or a folder of tables is a link.
    """
    known = {name for shard in manifest.shards(folder) for name, _ in shard.files}
    for which in TABLES:
        below = folder / which
        if below.is_symlink():
            raise ResultsError(f"{below} is a link; nothing is removed through one. Put the folder itself there")
        for path in below.glob("*.parquet"):
            if f"{which}/{path.name}" not in known:
                path.unlink(missing_ok=True)
