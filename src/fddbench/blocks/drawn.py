"""Random numbers by name: which frozen number of which consumer a block draws at every sample."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic, Literal, TypeVar

from fddbench.blocks.layout import ROW, Rows, filled, leaves
from fddbench.blocks.philox import PER_DRAW

__all__ = ["Draw", "Draws"]

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Draw:
    """Normals of one frozen consumer number.

    Attributes
    ----------
    consumer, first, rows : int
        `rows` of its four numbers from `first` on; `ROW` is one, seen as (n_cases,).
    stream : {"flight", "scenario"}
        Whether it belongs to the flight itself or to the faults of its scenario.
    shared : bool
        Other names may stand for the same numbers, and do so on purpose (a fault that is the same on all its sites).
    """

    consumer: int
    first: int = 0
    rows: int = ROW
    stream: Literal["flight", "scenario"] = "flight"
    shared: bool = False

    @property
    def numbers(self) -> Iterator[tuple[int, str, int]]:
        """Consumer, stream and place among the four of every number."""
        return ((self.consumer, self.stream, self.first + j) for j in range(self.rows or 1))


class Draws(Generic[T]):
    """Draws of a block as a record whose leaves are `Draw`.

    Raises
    ------
    ValueError
        A number serves two names that do not share it, or does not exist: two noises would secretly be one.
    """

    def __init__(self, names: T) -> None:
        self.names = names
        found: list[Draw] = [draw for _, draw in leaves(names)]
        # those of the flight before those of the scenario
        self.streams = tuple(dict.fromkeys(sorted(((d.consumer, d.stream) for d in found), key=lambda s: s[1])))
        owners: dict[tuple[int, str, int], list[Draw]] = {}
        for draw in found:
            for number in draw.numbers:
                owners.setdefault(number, []).append(draw)
        twice = [n for n, each in owners.items() if len(each) > 1 and not all(draw.shared for draw in each)]
        beyond = [n for n in owners if not 0 <= n[2] < PER_DRAW]
        if twice or beyond:
            raise ValueError(f"a random number is drawn under two names or does not exist: {sorted(twice + beyond)}")

    @property
    def size(self) -> int:
        """Rows of normals that `unpack` takes."""
        return PER_DRAW * len(self.streams)

    def unpack(self, normals: Rows) -> T:
        """Record of views of the normals of a kernel, (4 len(streams), n_cases), stacked in the order of `streams`."""
        first = {stream: PER_DRAW * j for j, stream in enumerate(self.streams)}
        found: list[Any] = [draw for _, draw in leaves(self.names)]
        at = ((first[d.consumer, d.stream] + d.first, d.rows) for d in found)
        return filled(self.names, (normals[j : j + rows] if rows else normals[j] for j, rows in at))
