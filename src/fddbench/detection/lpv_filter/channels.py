"""Measured signals as the numbers that a filter takes."""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.layout import Row, Rows
from fddbench.detection.lpv_filter.gains import ChannelEntry
from fddbench.errors import DesignError
from fddbench.interfaces import Bus

__all__ = ["require_channels", "rows_of"]


def require_channels(entries: Sequence[ChannelEntry], bus: Bus, what: str) -> None:
    """Refuse channels that this bus does not have.

    Parameters
    ----------
    what : str
        Key that they stand under, for messages.
    """
    bus.require(*dict.fromkeys(name for entry in entries for name in (entry.signal, entry.times) if name is not None))
    several = [entry.times for entry in entries if entry.times is not None and bus.signals[entry.times]]
    if several:
        raise DesignError(f"{what}: times: {several[0]} has {bus.signals[several[0]]} rows; give a signal of one row")
    for number, entry in enumerate(entries):
        if entry.signal is None:
            continue
        rows, row = bus.signals[entry.signal], entry.row
        if (row is None) != (rows == 0) or (row is not None and row >= rows):
            has = f"{rows} rows, give row: 0 to {rows - 1}" if rows else "one row, leave row out"
            raise DesignError(f"{what}[{number}]: {entry.signal} has {has}; got row: {row}")


def rows_of(entries: Sequence[ChannelEntry], measured: SimpleNamespace, like: Row) -> Rows:
    """Numbers of one sample, (n_channels, n_cases); `like` is any (n_cases,) row."""
    return np.stack([_row(entry, measured, like) for entry in entries])


def _row(entry: ChannelEntry, measured: SimpleNamespace, like: Row) -> Row:
    if entry.signal is None:
        return np.zeros_like(like) + entry.constant
    signal = vars(measured)[entry.signal]
    value = signal if entry.row is None else signal[entry.row]
    value = value - entry.offset if entry.offset else value
    value = value * entry.scale if entry.scale != 1.0 else value * 1.0
    return value if entry.times is None else value * vars(measured)[entry.times]
