"""Tables on disk that survive a crash: written aside, synced, renamed, and listed with their sha256."""

import hashlib
import os
from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from fddbench.errors import ResultsError

__all__ = ["file_sha256", "read_table", "write_bytes", "write_table"]


def write_bytes(path: Path, data: bytes) -> None:
    """Put a file in place, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    with aside.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    aside.replace(path)
    _sync_folder(path.parent)


def write_table(path: Path, table: pa.Table) -> str:
    """Write a table as Parquet with page checksums; the file's sha256."""
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd", write_page_checksum=True)
    data = sink.getvalue().to_pybytes()
    write_bytes(path, data)
    return hashlib.sha256(data).hexdigest()


def read_table(path: Path, sha256: str, columns: Sequence[str] | None = None) -> pa.Table:
    """Table of a shard, all of it or some columns.

    Raises
    ------
    ResultsError
        The file is missing or is not the one that was written.
    """
    data = path.read_bytes() if path.is_file() else None
    if data is None or hashlib.sha256(data).hexdigest() != sha256:
        state = "is missing" if data is None else "is not the file that was written (its sha256 differs)"
        raise ResultsError(f"{path} {state}; run the campaign again on this folder, it flies again what is lost")
    chosen = None if columns is None else list(columns)
    return pq.read_table(pa.BufferReader(data), columns=chosen, page_checksum_verification=True)


def file_sha256(path: Path) -> str | None:
    """Fingerprint of a file; None when it is not there."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None


def _sync_folder(folder: Path) -> None:
    """Make a rename durable, where the system lets a folder be opened."""
    if os.name == "posix":
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
