"""What is flown: the logs of a mapping, as a benchmark sees them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fddbench.benchmarks.recorded.consistent import inconsistent
from fddbench.benchmarks.recorded.labels import Label, labelled, read_labels
from fddbench.benchmarks.recorded.logs import Channel, Piece, read_logs
from fddbench.benchmarks.recorded.mapping import ChannelMap, read_mapping
from fddbench.benchmarks.recorded.resampling import OnClock, on_clock
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, LoggedFaults, Parameter, Site
from fddbench.units import unit_of_name

__all__ = ["RecordedPlant", "read_plant"]

LARGEST = 200_000_000
"""Bytes of a log that travels with the results."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RecordedPlant:
    """Logs as something that flies, see `fddbench.interfaces.Plant`.

    Attributes
    ----------
    mapping : ChannelMap
        What is in them.
    pieces : tuple of Piece
        What is flown of each.
    labels : tuple of Label
        Faults that are in them.
    files : mapping of str to bytes
        Everything but the mapping that travels with a campaign, by its name in the folder of the mapping.
    """

    mapping: ChannelMap
    pieces: tuple[Piece, ...]
    labels: tuple[Label, ...]
    files: Mapping[str, bytes]
    refused_parameters: Mapping[str, str]

    @property
    def about(self) -> str:
        """What is recorded."""
        return self.mapping.about or f"{len(self.pieces)} logs"

    @cached_property
    def sites(self) -> tuple[Site, ...]:
        """Fault sites in the order of the mapping, a row each."""
        return tuple(
            Site(
                name=name, signal=on.signal, row=row, unit_name=unit_of_name(on.signal), kind=on.kind,
                admissible=on.admissible, limits_s=on.limits_s,
                stops=(float("-inf"), float("inf")) if on.stops is None else (on.stops[0], on.stops[1]),
            )
            for on in self.mapping.sites
            for row, name in enumerate(on.names)
        )  # fmt: skip

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Which log is flown."""
        names = ", ".join(f"{number} {piece.name}" for number, piece in enumerate(self.pieces, 1))
        about = f"which log: {names}; all of them with `grid: {{log: {list(range(1, len(self.pieces) + 1))}}}`"
        return (Parameter(name="log", about=about, default=1.0, low=1.0, high=float(len(self.pieces)), whole=True),)

    @property
    def shown(self) -> tuple[str, ...]:
        """Signals in the pictures: those that faults sit on, and what is voted of them."""
        voted = [name for name, one in self.mapping.signals.items() if one.vote is not None]
        return (*(on.signal for on in self.mapping.sites), *voted)

    @property
    def manoeuvres(self) -> Mapping[str, float]:
        """The longest log; each is flown to its own end."""
        return {"recorded": max(piece.length_s for piece in self.pieces)}

    def numbers(self, parameters: Mapping[str, Floats]) -> npt.NDArray[np.int64]:
        """Logs of flights, (n_cases,) from 0."""
        return np.rint(parameters["log"]).astype(np.int64) - 1

    def longest_s(self, parameters: Mapping[str, Floats]) -> Floats:
        """How long flights can last, (n_cases,) [s]."""
        return np.array([piece.length_s for piece in self.pieces])[self.numbers(parameters)]

    def labelled(self, parameters: Mapping[str, Floats], sample_s: float) -> LoggedFaults:
        """Faults that are in the logs of flights."""
        names = [site.name for site in self.sites]
        return labelled(self.labels, self.numbers(parameters), names, sample_s)

    def n_labelled(self) -> int:
        """The most faults that a log has."""
        return max((sum(each.log == number for each in self.labels) for number in range(len(self.pieces))), default=0)

    def n_samples(self, piece: Piece, sample_s: float) -> int:
        """Samples of the flight of a log."""
        return int(piece.length_s / sample_s + 1e-6) + 1

    @lru_cache(maxsize=4)  # noqa: B019  (a plant lives as long as its campaign)
    def sampled(self, sample_s: float) -> tuple[Mapping[Channel, OnClock], ...]:
        """Channels of every log on the clock."""
        return tuple(
            {
                channel: on_clock(
                    series, piece.begin_s, self.n_samples(piece, sample_s), sample_s, self.mapping.between
                )
                for channel, series in piece.channels.items()
            }
            for piece in self.pieces
        )

    def notes(self, sample_s: float) -> dict[str, str]:
        """What there is to say of each log on this clock: length, gaps, faults, and the error of resampling."""
        how = {"previous": "the row before is held", "linear": "straight from row to row"}[self.mapping.between]
        found = {}
        for number, (piece, channels) in enumerate(zip(self.pieces, self.sampled(sample_s), strict=True)):
            faults = "; ".join(f"{'+'.join(one.sites)} {_when(one)}" for one in self.labels if one.log == number)
            parts = [
                f"{piece.file}, {piece.length_s:g} s from {piece.begin_s:g} s on",
                f"faulty: {faults}" if faults else "healthy",
                f"largest gap {piece.gap_s:.4g} s ({piece.gap_of})",
                f"{piece.skipped} cells without a value skipped" if piece.skipped else "",
                f"resampled {_resampled(channels, how)}",
            ]
            found[f"{number + 1} {piece.name}"] = "; ".join(filter(None, parts))
        return found


def _when(label: Label) -> str:
    return f"from {label.onset_s:g} s" + ("" if label.end_s is None else f" to {label.end_s:g} s")


def _resampled(channels: Mapping[Channel, OnClock], how: str) -> str:
    """Error of resampling, signal by signal where there is any."""
    worst: dict[str, tuple[float, float]] = {}
    for (name, _), own in channels.items():
        if own.between:
            rms, largest = worst.get(name, (0.0, 0.0))
            worst[name] = (max(rms, own.rms), max(largest, own.largest))
    unused = max(own.unused for own in channels.values())
    thinned = f"; up to {unused} rows of a channel between two samples not used, nothing filtered" if unused else ""
    if not worst:
        return f"exactly, every sample has a row of its own{thinned}"
    each = ", ".join(f"{name} {rms:.2g} ({largest:.2g})" for name, (rms, largest) in worst.items())
    return f"({how}) with an estimated error, rms (largest), of {each}{thinned}"


def read_plant(path: Path) -> RecordedPlant:
    """Plant of a mapping.

    Raises
    ------
    FddbenchError
        A line for each mistake in the mapping, its logs and its table of faults.
    """
    mapping, folder = read_mapping(path), path.parent
    wrong = [f"{path}: {each}" for each in inconsistent(mapping)]
    if wrong:
        raise FddbenchError("\n".join(wrong))
    names = [log.file for log in mapping.logs] + ([mapping.faults] if mapping.faults else [])
    files = {name: _content(folder, name, wrong) for name in dict.fromkeys(names)}
    pieces, broken = read_logs(mapping, folder) if not wrong else ((), [])
    wrong += broken
    labels: tuple[Label, ...] = ()
    if mapping.faults and not wrong:
        known = [name for on in mapping.sites for name in on.names]
        labels, broken = read_labels(
            folder / mapping.faults, {piece.name: (piece.begin_s, piece.end_s) for piece in pieces}, known
        )
        wrong += broken
    if wrong:
        raise FddbenchError("\n".join(wrong))
    return RecordedPlant(mapping=mapping, pieces=pieces, labels=labels, files=files, refused_parameters={})


def _content(folder: Path, name: str, wrong: list[str]) -> bytes:
    path = folder / name
    if not path.is_file() or not path.resolve().is_relative_to(folder.resolve()):
        wrong.append(f"{path}: no such file in the folder of the mapping; put it there or correct its name")
        return b""
    if path.stat().st_size > LARGEST:
        wrong.append(
            f"{path}: larger than {LARGEST / 1e6:g} MB; it would be copied into every folder of results. Write the mapped "
            "channels alone, as Parquet, or cut it into pieces"
        )
        return b""
    return path.read_bytes()
