"""What a run has to do: the flights that a folder of results lacks, of those that are asked for."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from zlib import crc32

import numpy as np
import numpy.typing as npt

from fddbench.results import manifest
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import Shard
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
    wanted : array of bool, optional
        The rows that are asked for, with those of the shards that are flown again.
    """

    parts: tuple[Part, ...]
    n_left: int
    n_wanted: int
    statuses: Counter[str]
    wanted: Wanted | None


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
        Statuses of rows that are flown again where any row of their shards is asked for, with all flights of these.
    """
    provenance = provenance_of(folder)
    done, lost = mend(folder, provenance=provenance)
    for what in lost:
        say(f"{folder}: {what}; its flights are flown again")
    numbering = Numbering(provenance)
    anew = [shard for shard in done if _is_flown_again(shard, numbering, wanted, again)]
    if anew:
        dropped = {shard.rows for shard in anew}
        done = tuple(shard for shard in done if shard.rows not in dropped)
        manifest.keep(folder, done)
        wanted = None if wanted is None else wanted | (numbering.held(anew) > 0)
    lacks = numbering.held(done) == 0
    n_wanted = numbering.n_cases if wanted is None else int(wanted.any(axis=0).sum())
    if wanted is not None:
        lacks &= wanted
    statuses = Counter[str]()
    for shard in done:
        statuses.update(shard.statuses)
    parts = _parts(lacks, numbering.detectors, provenance["fingerprints"])
    return Left(parts=parts, n_left=int(lacks.any(axis=0).sum()), n_wanted=n_wanted, statuses=statuses, wanted=wanted)


def _is_flown_again(shard: Shard, numbering: Numbering, wanted: Wanted | None, again: frozenset[str]) -> bool:
    """Whether a shard has a row of one of these statuses, and any row that is asked for."""
    if not again & {status for status, n in shard.statuses.items() if n}:
        return False
    if wanted is None:
        return True
    of = np.isin(numbering.detectors, numbering.detectors_of(shard))
    return bool(wanted[:, numbering.numbers(shard)][of].any())


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
