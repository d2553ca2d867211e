"""Which reader reads a file."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from fddbench.benchmarks.recorded.mapping import TimeOf
from fddbench.benchmarks.recorded.reading.series import Series
from fddbench.errors import FddbenchError, reason_of

__all__ = ["LogFile", "open_log"]


class LogFile(Protocol):
    """A log that is open: its channels by name."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its channels."""
        ...

    def series(self, column: str, missing: str) -> Series:
        """A channel; raises FddbenchError for one that it does not have, or that holds something else than numbers."""
        ...


def open_log(path: Path, time: TimeOf) -> LogFile:
    """Log of a file, by its ending.

    Raises
    ------
    FddbenchError
        There is no such file, or it cannot be read.
    """
    if not path.is_file():
        raise FddbenchError(f"{path}: no such log; put the file there or correct its name in the mapping")
    reader = _readers()[path.suffix]
    try:
        return reader(path, time)
    except FddbenchError:
        raise
    except Exception as error:  # pandas, pyarrow and pyulog raise many kinds
        raise FddbenchError(f"{path}: cannot be read as {path.suffix[1:]}: {reason_of(error)}") from error


def _readers() -> Mapping[str, Callable[[Path, TimeOf], LogFile]]:
    from fddbench.benchmarks.recorded.reading.tables import CsvLog, ParquetLog
    from fddbench.benchmarks.recorded.reading.ulog import UlogLog

    return {".csv": CsvLog, ".parquet": ParquetLog, ".ulg": UlogLog}
