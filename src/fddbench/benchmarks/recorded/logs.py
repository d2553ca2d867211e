"""The channels of all logs of a mapping: read, converted, cut to the piece that is flown."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from fddbench.benchmarks.recorded.mapping import Log, Mapped, Mapping_
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


def read_logs(mapping: Mapping_, folder: Path) -> tuple[tuple[Piece, ...], list[str]]:
    """Pieces of all logs, and everything that is wrong with them."""
    pieces, wrong = [], []
    for log in mapping.logs:
        try:
            found = _series(open_log(folder / log.file, mapping.time), mapping, wrong)
            if found:
                pieces.append(_piece(log, mapping, folder, found))
        except FddbenchError as error:
            wrong.append(str(error))
    return tuple(pieces), wrong


def _mapped(mapping: Mapping_) -> Iterator[tuple[Channel, str, Mapped]]:
    """Every row of a signal that a log has, its column and how it is mapped."""
    for name, own in {**mapping.signals, **mapping.truth}.items():
        yield from (((name, row), column, own) for row, column in enumerate(own.columns))


def _series(file: LogFile, mapping: Mapping_, wrong: list[str]) -> dict[Channel, Series]:
    """Channels in the units of their signals; none where some are wrong."""
    found, before, read = {}, len(wrong), dict[str, Series]()
    for channel, column, own in _mapped(mapping):
        try:
            if column not in read:
                read[column] = file.series(column, mapping.missing)
            factor = _factor(channel[0], column, own)
        except FddbenchError as error:
            if str(error) not in wrong:
                wrong.append(str(error))
            continue
        series = read[column]
        found[channel] = series if factor == 1.0 else replace(series, values=series.values * factor)
    return found if len(wrong) == before else {}


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
            f"signals.{signal}: the column {column} is named in {named}, the signal in {wanted or 'no unit'}; say what it is in, "
            f"`unit: {named}`"
        )
    try:
        return converts(given, wanted)
    except FddbenchError as error:
        raise FddbenchError(f"signals.{signal}: {column}: {error}") from error


def _known(name: str) -> str:
    """Unit that a name carries, if it is one of those that can be converted."""
    unit = unit_of_name(name)
    return unit if unit in FACTORS and unit != "-" else ""


def _piece(log: Log, mapping: Mapping_, folder: Path, found: Mapping[Channel, Series]) -> Piece:
    """What is flown of a log: what all channels cover, or the piece that is asked for.

    Raises
    ------
    FddbenchError
        The channels do not cover it, or a gap is too long.
    """
    starts = {channel: float(series.time_s[0]) for channel, series in found.items()}
    ends = {channel: float(series.time_s[-1]) for channel, series in found.items()}
    begin_s, end_s = max(starts.values()), min(ends.values())
    for key, given, outside in (("start_s", log.start_s, begin_s), ("end_s", log.end_s, end_s)):
        if given is not None and (given < begin_s - 1e-9 or given > end_s + 1e-9):
            raise FddbenchError(
                f"{folder / log.file}: {key} of log {log.name} is {given:.10g}, all channels cover {begin_s:.10g} to {end_s:.10g} s"
            )
        del outside
    begin_s, end_s = log.start_s if log.start_s is not None else begin_s, log.end_s if log.end_s is not None else end_s
    if not begin_s < end_s:
        late, early = max(starts, key=lambda each: starts[each]), min(ends, key=lambda each: ends[each])
        raise FddbenchError(
            f"{folder / log.file}: nothing to fly from {begin_s:.10g} to {end_s:.10g} s; {late[0]} begins at {starts[late]:.10g} s, "
            f"{early[0]} ends at {ends[early]:.10g} s"
        )
    columns = {channel: column for channel, column, _ in _mapped(mapping)}
    limits = {channel: own.largest_gap_s or mapping.largest_gap_s for channel, _, own in _mapped(mapping)}
    gap_s, gap_of, skipped = 0.0, "", 0
    for channel, series in found.items():
        longest_s, row = largest_gap(series, begin_s, end_s)
        if longest_s > limits[channel] * (1.0 + 1e-9):
            raise FddbenchError(
                f"{series.place(row)}: {columns[channel]} has no row for {longest_s:.4g} s before this one, at most "
                f"{limits[channel]:g} s; fly another piece (start_s, end_s of the log), or allow it: `largest_gap_s: {longest_s:.4g}`"
            )
        skipped += series.skipped
        if longest_s > gap_s:
            gap_s, gap_of = longest_s, columns[channel]
    return Piece(
        name=log.name, file=log.file, begin_s=begin_s, end_s=end_s, channels=found, gap_s=gap_s, gap_of=gap_of, skipped=skipped
    )
