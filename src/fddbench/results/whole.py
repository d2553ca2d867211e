"""Whether a folder of results is whole: how many flights of each scenario it holds, of how many there are to be."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fddbench.errors import ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import Shard, shards
from fddbench.results.stages import Numbering

__all__ = ["Holdings", "holdings", "require_whole"]

_MOST = 4
"""Scenarios that a sentence names."""


@dataclass(frozen=True, kw_only=True)
class Holdings:
    """Flights that a folder holds, and that it is to hold, by scenario; and how many it has of some of the detectors only.

    >>> Holdings(held={"healthy": 250, "jam": 0}, total={"healthy": 3000, "jam": 3000}).sentence
    '250 of 6000 flights: healthy 250 of 3000, jam 0 of 3000'
    """

    held: Mapping[str, int]
    total: Mapping[str, int]
    partly: int = 0

    @property
    def partial(self) -> bool:
        """Whether any flight is missing."""
        return self.held != self.total

    @property
    def sentence(self) -> str:
        """What is there of what; of many scenarios the first that are not whole."""
        short = [f"{name} {n} of {self.total[name]}" for name, n in self.held.items() if n != self.total[name]]
        more = f", and {len(short) - _MOST} more scenarios" if len(short) > _MOST else ""
        where = f": {', '.join(short[:_MOST])}{more}" if short else ""
        some = f"; {self.partly} more of some detectors only" if self.partly else ""
        return f"{sum(self.held.values())} of {sum(self.total.values())} flights{where}{some}"


def holdings(folder: Path) -> Holdings:
    """What a folder of results holds.

    Raises
    ------
    ResultsError
        No folder of results, or a damaged one.
    """
    return counted(provenance_of(folder), shards(folder), folder)


def counted(provenance: Mapping[str, Any], listed: tuple[Shard, ...], folder: Path) -> Holdings:
    """Flights of shards by scenario; a flight is there when all detectors have a row of it.

    Raises
    ------
    ResultsError
        A shard has flights beyond the case table, or a row is there twice.
    """
    numbering = Numbering(provenance)
    try:
        rows = numbering.held(listed)
    except ResultsError as error:
        raise ResultsError(f"the manifest of {folder} is of another campaign: {error}") from None
    if (rows > 1).any():
        case = int(np.flatnonzero((rows > 1).any(axis=0))[0])
        raise ResultsError(
            f"the manifest of {folder} lists flights twice (case {case}); fly the campaign anew with --fresh"
        )
    there, held, first = (rows == 1).all(axis=0), dict[str, int](), 0
    for name, n in numbering.flights.items():
        held[name] = int(there[first : first + n].sum())
        first += n
    return Holdings(held=held, total=numbering.flights, partly=int((rows == 1).any(axis=0).sum() - there.sum()))


def require_whole(folder: Path) -> None:
    """Refuse a folder that lacks flights.

    Raises
    ------
    ResultsError
        It does, or is damaged.
    """
    found = holdings(folder)
    if found.partial:
        raise ResultsError(
            f"{folder} holds {found.sentence}. Scores that are kept are those of a whole campaign; run it again to fly the "
            "rest"
        )
