"""Series: a recorded signal from a file, added to the sensor or put in its place."""

import re
from collections.abc import Iterator, Mapping, Sequence
from hashlib import sha256
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, PrivateAttr, model_validator

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.primitives import gather
from fddbench.blocks.table import Table
from fddbench.errors import FddbenchError
from fddbench.faults.cycle import into_cycle
from fddbench.faults.key_rules import KeyRule, at_most_one
from fddbench.faults.profile import constants_of
from fddbench.faults.recorded import MOST_SAMPLES, Recorded, read_recorded
from fddbench.faults.specification import FaultSpecification, Finite, Time
from fddbench.faults.timing import misfits
from fddbench.faults.varied import bounds, in_words
from fddbench.interfaces import Floats, Instant, Site
from fddbench.units import UNITS

__all__ = ["Series"]

_BITS = 48
"""Of the hash by which a flight says which recording it plays; a float64 holds them exactly."""


@record
class Playing:
    """Which recording, how large [-], and where in it the onset lies [s]."""

    recording: Rows
    gain: Rows
    start_s: Rows


_FILE = r"[A-Za-z0-9_][A-Za-z0-9._-]*\.(csv|parquet)"


def _beside(name: str) -> str:
    if not re.fullmatch(_FILE, name):
        raise ValueError(
            f"need the name of a .csv or .parquet file beside the campaign, without a folder, got {name!r}; put it there"
        )
    return name


class SeriesBlock:
    """What is recorded at the sample, added to the reading of the sites; several recordings lie side by side.

    Parameters
    ----------
    recordings : mapping of float to (Table, str)
        Values on the clock and what comes after the last, by the number of the recording.
    """

    states: Layout[Any] = NOTHING

    def __init__(self, n_sites: int, sample_s: float, recordings: Mapping[float, tuple[Table, str]]) -> None:
        self.sample_s, self.recordings = sample_s, recordings
        self.constants = constants_of(Playing, n_sites)

    def start(self, c: Playing) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Playing, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        place = now.since_samples + np.rint(c.start_s / self.sample_s)
        rows = []
        for site, row in enumerate(reading):
            value: Rows = 0.0
            for number, (table, after) in self.recordings.items():
                value = np.where(c.recording[site] == number, _played(table, after, place[site]), value)
            played = row + now.sign[site] * (c.gain[site] * value)
            rows.append(np.where(c.gain[site] != 0.0, played, row))
        return x, np.stack(rows)


def _played(table: Table, after: str, place: Rows) -> Rows:
    """Value at a sample of the recording, (n_cases,)."""
    if after == "repeat":
        return gather(table, into_cycle(place, float(len(table))))
    value = gather(table, place)
    return value if after == "hold" else np.where(place < float(len(table)), value, 0.0)


class Series(FaultSpecification):
    """A recorded series added to the sensor, or with ``mode: replace`` shown in its place.

    The file lies beside the campaign and travels into the folder of results. It has the columns ``time_s`` and ``value`` with
    the unit of the sites (``value_deg_s``; plain ``value`` where they have none). Its first row is played at the onset. What
    the sites show at a sample is what the recording says at that time, `between` its rows as said; no filter comes before, so
    a recording that is faster than the clock is folded.

    Attributes
    ----------
    file : str
        Name of a ``.csv`` or ``.parquet`` file beside the campaign.
    between : {"linear", "previous"}
        Straight from row to row, or the row before.
    after : {"hold", "repeat", "zero"}
        After the last sample of the recording: it stays, it begins anew at the next sample, or nothing is left of it.
    gain : float
        The recording is played so many times as large [-]; 0 is the healthy sensor.
    start_s : float
        Where in the recording the onset lies [s].
    start : "uniform"
        Draws that place per case instead.
    """

    about: ClassVar[str] = "a recorded series from a file"
    files: ClassVar[tuple[str, ...]] = ("file",)

    kind: Literal["series"]
    file: Annotated[str, AfterValidator(_beside), Field(json_schema_extra={"pattern": f"^{_FILE}$"})]
    between: Literal["linear", "previous"] = "linear"
    after: Literal["hold", "repeat", "zero"] = "hold"
    gain: Finite = 1.0
    start_s: Time | None = None
    start: Literal["uniform"] | None = None

    _recorded: Recorded | None = PrivateAttr(default=None)

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """At most one start."""
        yield from super().key_rules()
        yield at_most_one("start_s", "start")

    @model_validator(mode="after")
    def _one_start(self) -> Self:
        if self.start is not None and self.start_s is not None:
            raise ValueError("give start_s or start: uniform, not both")
        return self

    @property
    def times(self) -> tuple[str, ...]:
        """Fields that are times on the clock."""
        return (*super().times, "start_s")

    def with_files(self, contents: Mapping[str, bytes]) -> Self:
        """Copy that has read its recording."""
        found = self.model_copy()
        column = f"value{UNITS[self.unit_name].suffix}"
        found._recorded = read_recorded(self.file, contents["file"], column)
        return found

    @property
    def recorded(self) -> Recorded:
        """What its file holds.

        Raises
        ------
        FddbenchError
            It was not read.
        """
        if self._recorded is None:
            raise FddbenchError(f"the series {self.file} was not read; with_files reads it")
        return self._recorded

    def unfit(self, sample_s: float) -> Iterator[tuple[str, str]]:
        """What the clock cannot show, and a place that the recording does not have."""
        yield from super().unfit(sample_s)
        yield from (("start_s", f"start_s {wrong}") for wrong in misfits(self.start_s, sample_s))
        length_s = self.recorded.length_s
        if length_s > MOST_SAMPLES * sample_s:
            most = f"at most {MOST_SAMPLES * sample_s:g} s at sample_s {sample_s:g}"
            yield "file", f"{self.file} lasts {length_s:g} s, {most}; cut it"
        if self.start_s is not None and bounds(self.start_s)[1] > length_s:
            start = in_words(self.start_s)
            yield "start_s", f"start_s must lie within the {length_s:g} s that {self.file} lasts, got {start}"

    def numbers(self, site: Site, uniform: Floats) -> Playing:
        """What is played."""
        del site
        start_s = 0.0 if self.start_s is None else self.start_s
        if self.start and self._recorded is not None:
            start_s = uniform * self.recorded.length_s
        return Playing(recording=self._number(), gain=self.gain, start_s=start_s)

    def _number(self) -> float:
        """Number of the recording: of what it holds and how it is played."""
        if self._recorded is None:
            return 0.0
        said = f"{self.between} {self.after} {len(self.recorded.value)} ".encode()
        digest = sha256(said + self.recorded.time_s.data + self.recorded.value.data)
        return float(int.from_bytes(digest.digest()[: _BITS // 8], "big"))

    @classmethod
    def block_for(cls, faults: Sequence[Self], n_sites: int, sample_s: float) -> SeriesBlock:
        """What flies of these: their recordings on the clock, each once."""
        found = {f._number(): (Table.of(f.recorded.on_clock(sample_s, f.between)), str(f.after)) for f in faults}
        return SeriesBlock(n_sites, sample_s, dict(sorted(found.items())))

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> SeriesBlock:
        """Without a recording nothing is played."""
        return SeriesBlock(n_sites, sample_s, {})
