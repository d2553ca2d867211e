"""Assignments that differ in their indices only become a loop of fixed length, as one would write it."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

__all__ = ["Assignment", "rolled"]

_INDEX = re.compile(r"\[(\d+)U\]")
_LEAST = 3


@dataclass(frozen=True)
class Assignment:
    """``target = value;``."""

    target: str
    value: str

    @property
    def skeleton(self) -> str:
        """The same without its indices."""
        return _INDEX.sub("[]", f"{self.target} = {self.value}")

    @property
    def indices(self) -> list[int]:
        """Its indices in order."""
        return [int(number) for number in _INDEX.findall(f"{self.target} = {self.value}")]


@dataclass(frozen=True)
class Loop:
    """Assignments whose target's index goes from `first` to before `end`; down where that is the smaller one.

    Going down the index in the text is one more than the row, so that it may end at row 0 without a sign.
    """

    body: Assignment
    first: int
    end: int

    @property
    def head(self) -> str:
        """The ``for`` of it."""
        if self.first < self.end:
            return f"for (i = {self.first}U; i < {self.end}U; i++)"
        return f"for (i = {self.first + 1}U; i > {self.end + 1}U; i--)"


def rolled(assignments: Sequence[Assignment]) -> Iterator[Assignment | Loop]:
    """The same assignments in the same order, runs of three and more as loops.

    >>> rows = [Assignment(f"y[{j}U]", f"k * x[{j + 1}U]") for j in range(3)]
    >>> [(loop.body.target, loop.body.value, loop.first, loop.end) for loop in rolled(rows)]
    [('y[i]', 'k * x[i + 1U]', 0, 3)]
    """
    at = 0
    while at < len(assignments):
        run = _run(assignments, at)
        if run >= _LEAST:
            yield _loop(assignments[at], assignments[at + 1], run)
            at += run
        else:
            yield assignments[at]
            at += 1


def _run(assignments: Sequence[Assignment], at: int) -> int:
    """How many assignments from one on step alike."""
    first = assignments[at]
    if "[" not in first.target or at + 1 == len(assignments):
        return 1
    start, skeleton = first.indices, first.skeleton
    steps = _steps(start, assignments[at + 1].indices)
    target = len(_INDEX.findall(first.target)) - 1
    if steps is None or target < 0 or not steps[target] or any(steps[:target]):
        return 1
    number = 1
    for other in assignments[at + 1 :]:
        if other.skeleton != skeleton or other.indices != [a + number * s for a, s in zip(start, steps, strict=True)]:
            break
        number += 1
    return number


def _steps(first: list[int], second: list[int]) -> list[int] | None:
    steps = [b - a for a, b in zip(first, second, strict=False)]
    return steps if len(first) == len(second) and (set(steps) <= {0, 1} or set(steps) <= {0, -1}) else None


def _loop(first: Assignment, second: Assignment, number: int) -> Loop:
    steps = [b - a for a, b in zip(first.indices, second.indices, strict=True)]
    target = len(_INDEX.findall(first.target)) - 1
    begin, way = first.indices[target], steps[target]
    each = iter(zip(first.indices, steps, strict=True))

    def index(found: re.Match[str]) -> str:
        value, step = next(each)
        if not step:
            return found[0]
        apart = value - begin - (way < 0)
        return "[i]" if apart == 0 else f"[i {'+' if apart > 0 else '-'} {abs(apart)}U]"

    text = Assignment(_INDEX.sub(index, first.target), _INDEX.sub(index, first.value))
    return Loop(text, begin, begin + way * number)
