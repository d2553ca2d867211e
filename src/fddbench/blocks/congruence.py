"""Which states of a program are always equal: partition refinement over its operations."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from heapq import heapify, heappop, heappush
from struct import pack

from fddbench.blocks.program import Program
from fddbench.blocks.simplify import COMMUTATIVE

__all__ = ["refined"]


def refined(program: Program, keys: Sequence[Hashable]) -> list[int]:
    """Class of every state row, numbered from 0: the coarsest partition by keys that the updates respect.

    Rows with the same key are supposed equal; a round looks what each row becomes if all of a class are one, and splits the
    classes whose rows become different things, until none does. A round looks only at what depends on rows that were split
    off in the one before.

    Parameters
    ----------
    keys : sequence of hashable
        One a row of ``state``, which is both input and output.

    References
    ----------
    Moore (1956), Gedanken-experiments on sequential machines; Hopcroft (1971), An n log n algorithm for minimizing states
    in a finite automaton; for programs Alpern, Wegman, Zadeck (1988), Detecting equality of variables in programs, POPL 15.

    Examples
    --------
    >>> from fddbench.blocks.program import trace
    >>> refined(trace(lambda state: {"state": state[[1, 2, 3, 3]] * 0.5}, state=4), [0, 0, 0, 0])
    [0, 0, 0, 0]
    >>> refined(trace(lambda state: {"state": state[[1, 2, 3, 3]] * 0.5}, state=4), [0, 0, 0, 1])
    [0, 1, 2, 3]
    """
    classes = _numbered(keys)
    values = _Values(program, classes)
    while True:
        parts: dict[tuple[int, int], list[int]] = defaultdict(list)
        for row, node in enumerate(program.outputs["state"]):
            parts[classes[row], values.of[node]].append(row)
        largest: dict[int, list[int]] = {}
        for (number, _), rows in parts.items():
            largest[number] = max(largest.get(number, []), rows, key=len)
        changed = []
        for (number, _), rows in parts.items():  # the largest part keeps its number, so that little has to be done anew
            if rows is not largest[number]:
                new = max(classes) + 1
                for row in rows:
                    classes[row] = new
                changed += rows
        if not changed:
            return _numbered(classes)
        values.update(changed)


class _Values:
    """Value number of every node: two nodes with the same number are equal if all rows of each class are.

    Attributes
    ----------
    of : list of int
        By node.
    """

    def __init__(self, program: Program, classes: Sequence[int]) -> None:
        self._nodes, self._classes = program.nodes, classes
        self.of = [-1] * len(program.nodes)
        self._numbers: dict[Hashable, int] = {}
        self._users: list[list[int]] = [[] for _ in program.nodes]
        self._rows: dict[int, int] = {}
        for j, (op, arguments, value) in enumerate(program.nodes):
            for argument in arguments:
                self._users[argument].append(j)
            if op == "input" and value[0] == "state":
                self._rows[value[1]] = j
        for j in range(len(program.nodes)):
            self.of[j] = self._number(j)

    def update(self, rows: Sequence[int]) -> None:
        """Number anew what depends on these state rows."""
        left = [self._rows[row] for row in rows if row in self._rows]
        heapify(left)
        last = -1
        while left:
            j = heappop(left)
            number = self._number(j) if j != last else self.of[j]
            if number != self.of[j]:
                self.of[j] = number
                for user in self._users[j]:
                    heappush(left, user)
            last = j

    def _number(self, j: int) -> int:
        op, arguments, value = self._nodes[j]
        if op == "input" and value[0] == "state":
            key: Hashable = ("state", self._classes[value[1]])
        elif op == "literal":
            key = ("literal", pack("<d", value))
        else:
            numbers = [self.of[a] for a in arguments]
            key = (op, tuple(sorted(numbers) if op in COMMUTATIVE else numbers), value)
        return self._numbers.setdefault(key, len(self._numbers))


def _numbered(keys: Sequence[Hashable]) -> list[int]:
    """Each key by the order of its first appearance."""
    numbers: dict[Hashable, int] = {}
    return [numbers.setdefault(key, len(numbers)) for key in keys]
