"""What a run has to do: the flights that a folder of results lacks, of those that are asked for."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from zlib import crc32

import numpy as np
import numpy.typing as npt

from fddbench.results.folder import provenance_of
from fddbench.results.mending import mend
from fddbench.results.stages import Numbering

__all__ = ["Left", "Part", "Wanted", "left_in"]

Wanted = npt.NDArray[np.bool_]
"""Whether a row is asked for, (n_detectors, n_cases), in the order of the campaign."""


@dataclass(frozen=True)
class Part:
    """Flights that lack rows of the same detectors; no name for all."""

    cases: npt.NDArray[np.int64]
    detectors: tuple[str, ...]
    label: str


@dataclass(frozen=True, kw_only=True)
class Left:
    """What is not there yet.

    Attributes
    ----------
    parts : tuple of Part
        What is to be flown.
    n_left, n_wanted : int
        Flights in them, and flights that are asked for.
    statuses : Counter
        Rows that are there by status, asked for or not.
    """

    parts: tuple[Part, ...]
    n_left: int
    n_wanted: int
    statuses: Counter[str]


def left_in(
    folder: Path, say: Callable[[str], None], *, wanted: Wanted | None, again: frozenset[str] = frozenset()
) -> Left:
    """What a folder lacks; what was lost is told.

    Parameters
    ----------
    folder : Path
        Folder of results, locked and claimed.
    say : callable
        Told what is damaged and is flown again.
    wanted : array of bool, optional
        The rows that are asked for; all of them by default.
    again : frozenset of str
        Statuses of rows that are flown again, with the flights of their shards.
    """
    provenance = provenance_of(folder)
    done, lost = mend(folder, provenance=provenance, again=again)
    for what in lost:
        say(f"{folder}: {what}; its flights are flown again")
    numbering = Numbering(provenance)
    lacks = numbering.held(done) == 0
    n_wanted = numbering.n_cases if wanted is None else int(wanted.any(axis=0).sum())
    if wanted is not None:
        lacks &= wanted
    statuses = Counter[str]()
    for shard in done:
        statuses.update(shard.statuses)
    parts = _parts(lacks, numbering.detectors, provenance["fingerprints"])
    return Left(parts=parts, n_left=int(lacks.any(axis=0).sum()), n_wanted=n_wanted, statuses=statuses)


def _parts(lacks: Wanted, names: tuple[str, ...], fingerprints: list[str]) -> tuple[Part, ...]:
    """Flights by the detectors that they lack rows of."""
    left = np.flatnonzero(lacks.any(axis=0))
    if not len(left):
        return ()
    alike = lacks[:, left].all()
    kinds, which = np.unique(lacks[:, left[:1] if alike else left], axis=1, return_inverse=True)
    which = np.zeros(len(left), dtype=np.int64) if alike else which.ravel()
    parts = []
    for k in range(kinds.shape[1]):
        some = tuple(name for name, lack in zip(names, kinds[:, k], strict=True) if lack)
        detectors = () if len(some) == len(names) else some
        marked = len(fingerprints) > 1 or detectors
        label = f"{crc32(repr((fingerprints, detectors)).encode()):010d}" if marked else ""
        parts.append(Part(left[which == k].astype(np.int64), detectors, label))
    return tuple(parts)
