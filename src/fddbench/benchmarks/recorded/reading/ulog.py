"""PX4 logs (ULog): topics have times of their own; a channel is ``topic.field``, of the second instance ``topic[1].field``."""

import re
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from fddbench.benchmarks.recorded.mapping import TimeOf
from fddbench.benchmarks.recorded.reading.series import Series, checked
from fddbench.errors import FddbenchError, did_you_mean

__all__ = ["UlogLog"]

_CHANNEL = re.compile(r"(?P<topic>[A-Za-z0-9_]+?)(\[(?P<instance>\d+)\])?\.(?P<field>[A-Za-z0-9_.\[\]]+)")
_MAGIC = bytes([0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35])


class UlogLog:
    """A ULog file; its time is in seconds since the log was started.

    Parameters
    ----------
    path : Path
        File.
    time : TimeOf
        What the mapping says of tables; a ULog needs none.

    Raises
    ------
    FddbenchError
        pyulog is not installed, or the file is no ULog.
    """

    def __init__(self, path: Path, time: TimeOf) -> None:
        del time
        self.path = path
        try:
            from pyulog import ULog
        except ImportError as error:
            raise FddbenchError(
                f"{path}: logs of PX4 need pyulog: pip install 'fddbench[ulog]'; or write the log as .csv or .parquet"
            ) from error
        with path.open("rb") as file:
            if file.read(len(_MAGIC)) != _MAGIC:
                raise FddbenchError(f"{path}: no ULog: it does not begin as one; is it whole, and not compressed?")
        self._log: Any = ULog(str(path))
        if getattr(self._log, "file_corruption", False):
            raise FddbenchError(f"{path}: the ULog is damaged; cut it off before the damage and log the piece anew")

    @cached_property
    def _topics(self) -> dict[tuple[str, int], Any]:
        return {(each.name, each.multi_id): each.data for each in self._log.data_list}

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its channels."""
        return tuple(
            f"{topic}{f'[{instance}]' if instance else ''}.{field}"
            for (topic, instance), data in self._topics.items()
            for field in data
            if field != "timestamp"
        )

    def series(self, column: str, missing: str) -> Series:
        """A channel, see `fddbench.benchmarks.recorded.reading.LogFile`."""
        found = _CHANNEL.fullmatch(column)
        if found is None:
            raise FddbenchError(
                f"{self.path}: a channel of a ULog is called topic.field, topic[1].field of the second instance, got {column!r}"
            )
        topic, instance, field = found["topic"], int(found["instance"] or 0), found["field"]
        data = self._topics.get((topic, instance), {})
        if field not in data:
            self._refuse(column, topic, data)
        stamps = data["timestamp"].astype(np.int64) - int(self._log.start_timestamp)
        place = f"{self.path} {topic}{f'[{instance}]' if instance else ''} row "
        return checked(
            stamps * 1e-6, np.asarray(data[field], dtype=np.float64), column=field, time="timestamp", missing=missing,
            place=lambda row: f"{place}{row}",
        )  # fmt: skip

    def _refuse(self, column: str, topic: str, data: Any) -> None:
        hint = did_you_mean(column, self.columns)
        if data:
            known = f"{topic} has {', '.join(name for name in data if name != 'timestamp')}"
        elif any(name == topic for name, _ in self._topics):
            known = f"{topic} has the instances {', '.join(str(j) for name, j in self._topics if name == topic)}"
        else:
            known = f"It has the topics {', '.join(dict.fromkeys(name for name, _ in self._topics)) or 'none'}"
        raise FddbenchError(" ".join(filter(None, [f"{self.path}: no channel {column}.", hint, known])))
