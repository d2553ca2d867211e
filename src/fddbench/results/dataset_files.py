"""Files of a data set: measured signals and truth apart, never more than a few flights in memory."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from fddbench.results.shards import file_sha256

__all__ = ["SPLITS", "SplitFiles", "listed"]

SPLITS = ("train", "validation", "test")
_FLIGHTS_A_FILE = 256


@dataclass
class SplitFiles:
    """Writes the flights of one split: ``train/part-00000.parquet``, ``truth/train/part-00000.parquet``, ``cases.parquet``."""

    folder: Path
    split: str
    flights: int = 0
    samples: int = 0
    _open: ExitStack = field(default_factory=ExitStack)
    _writers: dict[str, pq.ParquetWriter] = field(default_factory=dict)
    _part: int = -1

    def add(self, tables: Mapping[str, pa.Table], flights: int) -> None:
        """Write flights: tables of the same rows by what they hold, "measured" and "truth"."""
        part = self.flights // _FLIGHTS_A_FILE
        if part != self._part:
            self.close()
            self._part = part
        for what, table in tables.items():
            if what not in self._writers:
                below = self.folder / self.split if what == "measured" else self.folder / what / self.split
                below.mkdir(parents=True, exist_ok=True)
                writer = pq.ParquetWriter(below / f"part-{part:05d}.parquet", table.schema, compression="zstd")
                self._writers[what] = self._open.enter_context(writer)
            self._writers[what].write_table(table, row_group_size=max(len(table), 1))
        self.flights += flights
        self.samples += len(tables["measured"])

    def close(self) -> None:
        """End the files that are open."""
        self._open.close()
        self._writers.clear()


def listed(folder: Path) -> Iterator[dict[str, Any]]:
    """Every Parquet file of a data set with its rows and its sha256, in the order of their names."""
    for path in sorted(folder.rglob("*.parquet")):
        yield {
            "file": path.relative_to(folder).as_posix(),
            "rows": pq.ParquetFile(path).metadata.num_rows,
            "sha256": file_sha256(path),
        }
