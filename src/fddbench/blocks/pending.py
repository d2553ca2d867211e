"""When the new value of a state row may take the place of the old one: as soon as it is known and the old one has been read.

A value that waits for the end of the sample holds a register, or is put aside and fetched again: of ten detectors that are
more vectors than the first cache holds.
"""

from collections import defaultdict
from collections.abc import Collection, Mapping

__all__ = ["Pending"]


class Pending:
    """State rows that wait to be stored.

    Parameters
    ----------
    becomes : mapping of int to int
        Node that each row becomes.
    reads : mapping of int to collection of int
        Rows that a node reads, by node.
    nodes : collection of int
        Those that will be written; the others have been read, or do not matter.

    Examples
    --------
    >>> rows = Pending({0: 7, 1: 7}, {3: [0], 8: [1]}, [3, 7, 8])
    >>> rows.ready(7), rows.ready(3), rows.rest()
    ([], [0], [1])
    """

    def __init__(
        self, becomes: Mapping[int, int], reads: Mapping[int, Collection[int]], nodes: Collection[int]
    ) -> None:
        self._missing = {row: {node} for row, node in becomes.items()}
        for node in nodes:
            for row in reads.get(node, ()):
                if row in self._missing:
                    self._missing[row].add(node)
        self._waiting: dict[int, list[int]] = defaultdict(list)
        for row, nodes in self._missing.items():
            for node in nodes:
                self._waiting[node].append(row)

    def ready(self, node: int) -> list[int]:
        """Rows that can be stored now that a node is written."""
        rows = self._waiting.pop(node, [])
        for row in rows:
            self._missing[row].discard(node)
        return [row for row in rows if not self._missing[row] and self._missing.pop(row) is not None]

    def rest(self) -> list[int]:
        """Rows that are left when all nodes are written."""
        rows, self._missing = list(self._missing), {}
        return rows
