"""Tables on disk that survive a crash: written aside, synced, renamed, and listed with their sha256."""

import hashlib
import os
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


def read_table(path: Path, sha256: str) -> pa.Table:
    """Table of a shard.

    Raises
    ------
    ResultsError
        The file is missing or is not the one that was written.
    """
    found = file_sha256(path)
    if found != sha256:
        state = "is missing" if found is None else "is not the file that was written (its sha256 differs)"
        raise ResultsError(f"{path} {state}; run the campaign again on this folder, it flies again what is lost")
    return pq.read_table(path, page_checksum_verification=True)


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
