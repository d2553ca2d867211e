"""Readers of logs: one file a format, one series a channel."""

from fddbench.benchmarks.recorded.reading.files import LogFile, open_log
from fddbench.benchmarks.recorded.reading.series import Series

__all__ = ["LogFile", "Series", "open_log"]
