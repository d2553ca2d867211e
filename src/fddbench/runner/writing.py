"""Writes the rows and events of some flights as one shard; where not all are kept, what is counted of all of them."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.results.kept import Kept
from fddbench.results.manifest import Shard
from fddbench.results.shards import write_table
from fddbench.results.tallies import tally
from fddbench.runner.chunks import spans

__all__ = ["write_shard"]


def write_shard(
    folder: Path,
    cases: npt.NDArray[np.int64],
    rows: pa.Table,
    events: pa.Table,
    *,
    fingerprint: str,
    kept: Kept | None = None,
    detectors: tuple[str, ...] = (),
    label: str = "",
) -> Shard:
    """Write a shard into a folder of results; the line that lists it.

    Parameters
    ----------
    cases : (n,) array
        Numbers of its flights, in order.
    rows, events : Table
        Of these flights; there may be no events.
    fingerprint : str
        What flew it.
    kept : Kept, optional
        Which rows are kept; all by default.
    detectors : tuple of str
        Those that it has rows of; empty: all of its campaign.
    label : str
        Digits that keep its name apart from that of another shard of the same flights.
    """
    name = "-".join(filter(None, [f"{cases[0]:08d}-{cases[-1]:08d}-{len(cases)}", label])) + ".parquet"
    counts, tallies_sha256 = rows["status"].value_counts().to_pylist(), None
    if kept is not None:
        tallies_sha256 = write_table(folder / "tallies" / name, tally(rows), fingerprint=fingerprint)
        rows, events = kept.thinned(rows, events)
    events_sha256 = write_table(folder / "events" / name, events, fingerprint=fingerprint) if len(events) else None
    return Shard(
        cases=spans(cases),
        rows=f"rows/{name}",
        rows_sha256=write_table(folder / "rows" / name, rows, fingerprint=fingerprint),
        events=f"events/{name}" if events_sha256 else None,
        events_sha256=events_sha256,
        statuses=dict(sorted((entry["values"], entry["counts"]) for entry in counts)),
        fingerprint=fingerprint,
        detectors=detectors,
        tallies=f"tallies/{name}" if tallies_sha256 else None,
        tallies_sha256=tallies_sha256,
    )
