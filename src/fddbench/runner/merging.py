"""Several folders of results of campaigns that agree become one; rows that two of them hold must be the same bits."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from zlib import crc32

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.campaign.growth import in_the_way, points_in
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.campaign.plan import plan as planned
from fddbench.errors import ResultsError
from fddbench.results import manifest
from fddbench.results.compacting import ENOUGH, compact, require_sound
from fddbench.results.fingerprint import Fingerprint, differences
from fddbench.results.folder import claim, provenance_of, refuse_foreign
from fddbench.results.lock import locked
from fddbench.results.manifest import Shard
from fddbench.results.schema import CASE
from fddbench.results.table import as_of_today, read_events, read_rows
from fddbench.runner.assembling import assemble
from fddbench.runner.fingerprint import fingerprint_of, provenance_for
from fddbench.runner.growing import as_far_as
from fddbench.runner.joining import joinable, joined
from fddbench.runner.rows import schemas_of
from fddbench.runner.writing import write_shard

__all__ = ["merge_into"]

Cases = npt.NDArray[np.int64]
_SHARD_ROWS = 200_000
_KEYS = ("scenario", "point", "level", "run", "detector")


@dataclass(frozen=True)
class _Tables:
    """Rows and events of a part, as the whole numbers and writes them."""

    rows: pa.Table
    events: pa.Table


def merge_into(folder: Path, parts: Mapping[Path, Campaign], whole: Campaign) -> None:
    """Write the folder of results of `whole`, which holds every row of the parts.

    Raises
    ------
    ResultsError
        A part is of another campaign or program, two parts hold different rows of one flight, or the folder is not empty.
    """
    now, here = planned(whole), fingerprint_of(whole)
    wrong = [f"  {path}: {line}" for path, own in parts.items() for line in _in_the_way(path, planned(own), now, here)]
    if wrong:
        raise ResultsError("these folders do not belong together:\n" + "\n".join(wrong))
    refuse_foreign(folder)
    if (folder / "provenance.json").exists():
        raise ResultsError(f"{folder} holds results already; name another folder with --output")
    if joinable(list(parts), here.sha256):
        for path in parts:
            require_sound(path, manifest.shards(path))
        _write(folder, whole, now, here, joined(folder, list(parts)))
        return
    if whole.keep != "all":
        raise ResultsError(
            "these campaigns do not keep all their rows: only parts of one campaign, flown by one program and none twice, can "
            "be put together. Fly the whole into one folder, or with --set keep=all"
        )
    tables = [_read(path, planned(own), now) for path, own in parts.items()]
    rows, events = (_together([getattr(each, kind) for each in tables], kind) for kind in ("rows", "events"))
    _write(folder, whole, now, here, _shards(folder, now, here.sha256, rows, events))


def _write(folder: Path, whole: Campaign, plan: Plan, here: Fingerprint, shards: Iterable[Shard]) -> None:
    """Make a folder of results of these shards, which are written as they are asked for."""
    with locked(folder):
        claim(folder, files=whole.files(), provenance=provenance_for(plan, here), fresh=False)
        for shard in shards:
            manifest.append(folder, shard)
        compact(folder, least=ENOUGH)


def _in_the_way(path: Path, was: Plan, now: Plan, here: Fingerprint) -> list[str]:
    there = Fingerprint.of(provenance_of(path))
    return [*in_the_way(was, now), *differences(there, as_far_as(there, here))]


def _read(path: Path, was: Plan, now: Plan) -> _Tables:
    """Tables of a part, its points numbered as in the whole, with all columns of the whole."""
    points, schemas = points_in(was, now), schemas_of(assemble(now.campaign))
    found = []
    for schema, read in zip(schemas, (read_rows, read_events), strict=True):
        frame = read(path).drop(columns=CASE.name, errors="ignore")
        table = pa.Table.from_pandas(frame, preserve_index=False).replace_schema_metadata(None)
        found.append(as_of_today(table, schema.names, points).cast(schema))
    return _Tables(*found)


def _together(tables: Sequence[pa.Table], kind: str) -> pa.Table:
    """All tables as one, each row once.

    Raises
    ------
    ResultsError
        One flight and detector has two different rows.
    """
    keys = [*_KEYS, *(["event"] if kind == "events" else [])]
    table = pa.concat_tables(tables)
    frame = table.to_pandas(types_mapper=pd.ArrowDtype)
    twice = frame.duplicated(subset=keys)
    distinct = frame.drop_duplicates()
    clash = distinct[distinct.duplicated(subset=keys)]
    if len(clash):
        first = clash.iloc[0]
        name = "/".join(str(first[key]) for key in keys[:4])
        raise ResultsError(
            f"two of the folders hold different {kind} of {name} and {first['detector']} ({len(clash)} in all); one of them "
            "is not what the campaign gives: fddbench verify DIR --refly N says which"
        )
    return table.filter(pa.array(~twice.to_numpy(dtype=bool)))


def _shards(folder: Path, plan: Plan, fingerprint: str, rows: pa.Table, events: pa.Table) -> Iterator[Shard]:
    """Shards of the whole: flights that have rows of the same detectors together."""
    detectors = [design.name for design in plan.campaign.designs]
    numbers, its = _numbers(plan, rows), _numbers(plan, events)
    held = np.zeros((len(detectors), plan.n_cases), dtype=bool)
    held[pc.index_in(rows["detector"], pa.array(detectors)).to_numpy(), numbers] = True
    there = np.flatnonzero(held.any(axis=0))
    kinds, which = np.unique(held[:, there], axis=1, return_inverse=True)
    for k in range(kinds.shape[1]):
        names = tuple(name for name, has in zip(detectors, kinds[:, k], strict=True) if has)
        cases = there[which.ravel() == k]
        label = "" if len(names) == len(detectors) else f"{crc32(repr(names).encode()):010d}"
        for part in np.array_split(cases, -(-len(cases) * len(names) // _SHARD_ROWS)):
            mine, theirs = (table.filter(pa.array(np.isin(at, part))) for table, at in ((rows, numbers), (events, its)))
            yield write_shard(
                folder, part, mine, theirs, fingerprint=fingerprint, label=label,
                detectors=() if len(names) == len(detectors) else names,
            )  # fmt: skip


def _numbers(plan: Plan, table: pa.Table) -> Cases:
    """Numbers of the flights of rows."""
    shapes = np.array([(s.first_case, s.n_levels, s.n_runs) for s in plan.scenarios], dtype=np.int64)
    which = pc.index_in(table["scenario"], pa.array([s.name for s in plan.scenarios])).to_numpy()
    first, n_levels, n_runs = shapes[which].T if len(which) else np.empty((3, 0), dtype=np.int64)
    point, level, run = (table[name].to_numpy() for name in ("point", "level", "run"))
    found: Cases = first + (point * n_levels + level) * n_runs + run
    return found
