"""The channels of all logs of a mapping: read, converted, cut to the piece that is flown."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from fddbench.benchmarks.recorded.mapping import ChannelMap, Log, Mapped
from fddbench.benchmarks.recorded.reading import LogFile, Series, open_log
from fddbench.benchmarks.recorded.resampling import largest_gap
from fddbench.errors import FddbenchError
from fddbench.units import FACTORS, converts, unit_of_name

__all__ = ["Channel", "Piece", "read_logs"]

Channel = tuple[str, int]
"""Name of a signal, and row of it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """What is flown of a log.

    Attributes
    ----------
    name, file : str
        Of the log.
    begin_s, end_s : float
        Its first and last time, in the log's own time [s].
    channels : mapping of (str, int) to Series
        By signal and row, in the unit of the signal.
    gap_s, gap_of : float, str
        Largest time between two rows that are needed [s], and of which column.
    skipped : int
        Rows without a value that were left out, of all channels.
    """

    name: str
    file: str
    begin_s: float
    end_s: float
    channels: Mapping[Channel, Series]
    gap_s: float
    gap_of: str
    skipped: int

    @property
    def length_s(self) -> float:
        """Length of the flight [s]."""
        return round(self.end_s - self.begin_s, 9)


def read_logs(mapping: ChannelMap, folder: Path) -> tuple[tuple[Piece, ...], list[str]]:
    """Pieces of all logs, and everything that is wrong with them."""
    pieces, wrong = list[Piece](), list[str]()
    for log in mapping.logs:
        try:
            found = _series(open_log(folder / log.file, mapping.time), mapping, wrong)
            if found:
                pieces.append(_piece(log, mapping, folder / log.file, found))
        except FddbenchError as error:
            wrong.append(str(error))
    return tuple(pieces), wrong


def _mapped(mapping: ChannelMap) -> Iterator[tuple[Channel, str, Mapped]]:
    """Every row of a signal that a log has, its column and how it is mapped."""
    for name, own in {**mapping.signals, **mapping.truth}.items():
        yield from (((name, row), column, own) for row, column in enumerate(own.columns))


def _series(file: LogFile, mapping: ChannelMap, wrong: list[str]) -> dict[Channel, Series]:
    """Channels in the units of their signals; none where some are wrong."""
    found, whole, read = {}, True, dict[str, Series]()
    for channel, column, own in _mapped(mapping):
        try:
            if column not in read:
                read[column] = file.series(column, mapping.missing)
            factor = _factor(channel[0], column, own)
        except FddbenchError as error:
            whole = False
            wrong += [str(error)] if str(error) not in wrong else []
            continue
        series = read[column]
        found[channel] = series if factor == 1.0 else replace(series, values=series.values * factor)
    return found if whole else {}


def _factor(signal: str, column: str, own: Mapped) -> float:
    """Factor from the unit of a column to that of its signal.

    Raises
    ------
    FddbenchError
        They measure different things, or the column's name says another unit than the mapping.
    """
    wanted, named = _known(signal), _known(column)
    given = own.unit if own.unit is not None else wanted
    if named and own.unit is None and named != wanted:
        raise FddbenchError(
            f"signals.{signal}: the column {column} is named in {named}, the signal in {wanted or 'no unit'}; say what it "
            f"is in, `unit: {named}`"
        )
    try:
        return converts(given, wanted)
    except FddbenchError as error:
        raise FddbenchError(f"signals.{signal}: {column}: {error}") from error


def _known(name: str) -> str:
    """Unit that a name carries, if it is one of those that can be converted."""
    unit = unit_of_name(name)
    return unit if unit in FACTORS and unit != "-" else ""


def _piece(log: Log, mapping: ChannelMap, path: Path, found: Mapping[Channel, Series]) -> Piece:
    """What is flown of a log: what all channels cover, or the piece that is asked for.

    Raises
    ------
    FddbenchError
        The channels do not cover it, or a gap is too long.
    """
    begin_s, end_s = _covered(log, path, found)
    gap_s, gap_of = 0.0, ""
    for channel, column, own in _mapped(mapping):
        longest_s, row = largest_gap(found[channel], begin_s, end_s)
        limit_s = own.largest_gap_s or mapping.largest_gap_s
        if longest_s > limit_s * (1.0 + 1e-9):
            raise FddbenchError(
                f"{found[channel].place(row)}: {column} has no row for {longest_s:.4g} s before this one, at most {limit_s:g} "
                f"s; fly another piece (start_s, end_s of the log), or allow it: `largest_gap_s: {longest_s:.4g}`"
            )
        if longest_s > gap_s:
            gap_s, gap_of = longest_s, column
    return Piece(
        name=log.name, file=log.file, begin_s=begin_s, end_s=end_s, channels=found, gap_s=gap_s, gap_of=gap_of,
        skipped=sum(series.skipped for series in found.values()),
    )  # fmt: skip


def _covered(log: Log, path: Path, found: Mapping[Channel, Series]) -> tuple[float, float]:
    """First and last time of the piece that is flown [s]."""
    starts = {channel: float(series.time_s[0]) for channel, series in found.items()}
    ends = {channel: float(series.time_s[-1]) for channel, series in found.items()}
    begin_s, end_s = max(starts.values()), min(ends.values())
    late, early = max(starts, key=starts.__getitem__), min(ends, key=ends.__getitem__)
    if not begin_s < end_s:
        raise FddbenchError(
            f"{path}: the channels do not overlap: {late[0]} begins at {begin_s:.10g} s, {early[0]} ends at "
            f"{end_s:.10g} s"
        )
    for key, given in (("start_s", log.start_s), ("end_s", log.end_s)):
        if given is not None and not begin_s - 1e-9 <= given <= end_s + 1e-9:
            raise FddbenchError(
                f"{path}: {key} of log {log.name} is {given:.10g}, all channels cover {begin_s:.10g} s ({late[0]}) to "
                f"{end_s:.10g} s ({early[0]})"
            )
    begin_s, end_s = begin_s if log.start_s is None else log.start_s, end_s if log.end_s is None else log.end_s
    if not begin_s < end_s:
        raise FddbenchError(f"{path}: nothing is left of log {log.name} from {begin_s:.10g} to {end_s:.10g} s")
    return begin_s, end_s
