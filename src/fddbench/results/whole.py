"""Whether a folder of results is whole: how many flights of each scenario it holds, of how many there are to be."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import Shard, shards

__all__ = ["Holdings", "holdings", "require_whole"]

_MOST = 4
"""Scenarios that a sentence names."""


@dataclass(frozen=True, kw_only=True)
class Holdings:
    """Flights that a folder holds, and that it is to hold, by scenario.

    >>> Holdings(held={"healthy": 250, "jam": 0}, total={"healthy": 3000, "jam": 3000}).sentence
    '250 of 6000 flights: healthy 250 of 3000, jam 0 of 3000'
    """

    held: Mapping[str, int]
    total: Mapping[str, int]

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
        return f"{sum(self.held.values())} of {sum(self.total.values())} flights{where}"


def holdings(folder: Path) -> Holdings:
    """What a folder of results holds.

    Raises
    ------
    ResultsError
        No folder of results, or a damaged one.
    """
    return counted(provenance_of(folder)["flights"], shards(folder), folder)


def counted(flights: Mapping[str, int], listed: tuple[Shard, ...], folder: Path) -> Holdings:
    """Flights of shards by scenario; the case table has the scenarios one after the other.

    Raises
    ------
    ResultsError
        A shard has flights beyond the case table.
    """
    held, first = dict.fromkeys(flights, 0), 0
    spans = [span for shard in listed for span in shard.cases]
    for name, n in flights.items():
        last = first + n
        held[name] = sum(max(0, min(start + count, last) - max(start, first)) for start, count in spans)
        first = last
    if any(start < 0 or start + count > first for start, count in spans):
        raise ResultsError(
            f"the manifest of {folder} lists flights beyond the {first} of its campaign; fly it anew with --fresh"
        )
    return Holdings(held=held, total=dict(flights))


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
