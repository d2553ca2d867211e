"""Tables on disk that survive a crash: written aside, synced, renamed, and listed with their sha256.

Every shard carries the fingerprint of what flew it and the version of its schema; a reader that expects another refuses.
"""

import errno
import hashlib
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from fddbench.errors import ResultsError
from fddbench.results.schema import SCHEMA_VERSION

__all__ = ["file_sha256", "is_durable", "open_table", "read_columns", "write_bytes", "write_table", "write_tables"]

_SCHEMA, _FINGERPRINT = b"fddbench_schema", b"fddbench_fingerprint"
_GROUP = 100_000
"""Rows that are read together of a file of many."""
_NO_SYNC = {errno.EINVAL, errno.EBADF, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EACCES, errno.EPERM}
"""What systems answer that cannot make a rename durable; the file itself has been."""


def write_bytes(path: Path, data: bytes) -> None:
    """Put a file in place, whole or not at all; what was a link there is replaced, not followed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    aside.unlink(missing_ok=True)
    try:
        with aside.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        aside.replace(path)
    except BaseException as error:  # a full disk, Ctrl-C: nothing half written stays
        with suppress(OSError):
            aside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.filename is None:
            error.filename = str(path)
        raise
    is_durable(path.parent)


def write_table(path: Path, table: pa.Table, *, fingerprint: str) -> str:
    """Write a table as Parquet with page checksums and the fingerprint of what flew it; the file's sha256.

    Raises
    ------
    ResultsError
        The file would lie behind a link.
    """
    _refuse_link(path)
    sink = pa.BufferOutputStream()
    carried = {**(table.schema.metadata or {}), _FINGERPRINT: fingerprint.encode()}
    pq.write_table(table.replace_schema_metadata(carried), sink, compression="zstd", write_page_checksum=True)
    data = sink.getvalue().to_pybytes()
    write_bytes(path, data)
    return hashlib.sha256(data).hexdigest()


def _refuse_link(path: Path) -> None:
    if path.parent.is_symlink():
        raise ResultsError(f"{path.parent} is a link; results are not written through one. Remove it and run again")


def write_tables(path: Path, tables: Iterable[pa.Table]) -> str:
    """Write tables of shards, with what they carry, one after the other into one; the file's sha256.

    Few rows are in memory at a time, beside the file itself; they stand in groups that can be read one by one.

    Raises
    ------
    ResultsError
        The file would lie behind a link, or the tables have different columns.
    """
    _refuse_link(path)
    sink, writer, waiting = pa.BufferOutputStream(), None, list[pa.Table]()
    for table in tables:
        if waiting and table.schema != waiting[0].schema:
            raise ResultsError(
                f"{path.parent}: shards of one campaign have different columns; fly it anew with --fresh"
            )
        waiting.append(table)
        writer = writer or pq.ParquetWriter(sink, table.schema, compression="zstd", write_page_checksum=True)
        if sum(map(len, waiting)) >= _GROUP:
            waiting = [_written(writer, waiting)]
    if writer is not None:
        if sum(map(len, waiting)):
            _written(writer, waiting)
        writer.close()
    data = sink.getvalue().to_pybytes()
    write_bytes(path, data)
    return hashlib.sha256(data).hexdigest()


def _written(writer: pq.ParquetWriter, tables: list[pa.Table]) -> pa.Table:
    """Write tables as one group of rows; no rows of the same schema."""
    whole = pa.concat_tables(tables).combine_chunks()  # the bytes do not say how it was cut
    writer.write_table(whole, row_group_size=len(whole))
    return whole.slice(0, 0)


def open_table(path: Path, sha256: str, *, schema: pa.Schema, fingerprint: str) -> pq.ParquetFile:
    """Table of a shard, ready to be read column by column.

    Parameters
    ----------
    path, sha256 : Path, str
        The file, and what it was when it was written.
    schema : pyarrow.Schema
        Columns that it has, maybe among others.
    fingerprint : str
        What it carries.

    Raises
    ------
    ResultsError
        The file is missing, is not the one that was written, or is of another schema or program.
    """
    data = path.read_bytes() if path.is_file() else None
    if data is None or hashlib.sha256(data).hexdigest() != sha256:
        state = "is missing" if data is None else "is not the file that was written (its sha256 differs)"
        raise ResultsError(f"{path} {state}; run the campaign again on this folder, it flies again what is lost")
    try:
        found = pq.ParquetFile(pa.BufferReader(data), page_checksum_verification=True)
    except (pa.ArrowException, OSError) as error:
        raise _no_table(path, error) from error
    _require(path, found.schema_arrow, schema, fingerprint)
    return found


def read_columns(path: Path, opened: pq.ParquetFile, columns: Sequence[str], group: int | None = None) -> pa.Table:
    """Some columns of the table of a shard, of one of its groups of rows or of all.

    Raises
    ------
    ResultsError
        There is no such column, or the file cannot be read.
    """
    missing = [name for name in columns if name not in opened.schema_arrow.names]
    if missing:
        raise ResultsError(f"{path} has no column {missing[0]!r}; it has {', '.join(opened.schema_arrow.names)}")
    try:
        if group is not None:
            return opened.read_row_group(group, columns=list(columns), use_threads=False)
        return opened.read(columns=list(columns), use_threads=False)
    except (pa.ArrowException, OSError) as error:
        raise _no_table(path, error) from error


def _no_table(path: Path, error: Exception) -> ResultsError:
    reason = str(error).splitlines()[0]
    return ResultsError(f"{path} is no table of fddbench ({reason}); fly the campaign anew with --fresh")


def _require(path: Path, found: pa.Schema, expected: pa.Schema, fingerprint: str) -> None:
    """Refuse a table of another schema or program."""
    carried = found.metadata or {}
    version = carried.get(_SCHEMA, b"none").decode(errors="replace")
    if version != SCHEMA_VERSION:
        raise ResultsError(
            f"{path} has schema version {version}, this fddbench reads {SCHEMA_VERSION}; read it with the fddbench that "
            "wrote it, or fly the campaign anew with --fresh"
        )
    for field in expected:
        here = found.field(field.name).type if field.name in found.names else "missing"
        if here != field.type:
            raise ResultsError(
                f"{path} has a foreign schema: column {field.name} is {here}, needs {field.type}; fly the campaign anew "
                "with --fresh"
            )
    if carried.get(_FINGERPRINT, b"").decode(errors="replace") != fingerprint:
        raise ResultsError(
            f"{path} carries another fingerprint than the manifest says: it was flown by another campaign or program. Put "
            "the right file back, or fly the campaign anew with --fresh"
        )


def file_sha256(path: Path) -> str | None:
    """Sha256 of a file; None when it is not there."""
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None


def is_durable(folder: Path) -> bool:
    """Make renames in a folder durable; False where the system cannot, which is no reason to stop."""
    if os.name != "posix":
        return False
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError as error:
        if error.errno in _NO_SYNC:
            return False
        raise
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno in _NO_SYNC:
            return False
        raise
    finally:
        os.close(handle)
    return True
