"""In which order to write operations: the longest chain first, so that a processor always has something else to do."""

import heapq
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from fddbench.blocks.program import Program

__all__ = ["latency", "longest_first"]

_LATENCIES = {
    "add": 3, "sub": 3, "mul": 3, "div": 13, "sqrt": 20, "min": 5, "max": 5, "floor": 4, "rint": 4, "gather": 25, "locate": 30,
}  # fmt: skip
_DRAW, _LOAD, _OTHER = 60, 3, 2  # the ten rounds of Philox; a vector of the workspace; comparisons and selections


def latency(program: Program, node: int, *, loaded: bool = False) -> int:
    """Cycles until the result of a node can be used, about those of today's processors.

    Parameters
    ----------
    loaded : bool
        It has been computed before and is read from the workspace.
    """
    op, _, value = program.nodes[node]
    if op == "input" and value[0] == "uniforms":
        return _DRAW
    if op == "repeat":
        return int(value.count) * len(value.body.nodes)
    return _LOAD if loaded or op == "input" else _LATENCIES.get(op, _OTHER)


def longest_first(
    nodes: Iterable[int], arguments: Callable[[int], Sequence[int]], latency: Callable[[int], int], registers: int = 32
) -> list[int]:
    """The nodes in an order that an imagined processor, one operation a cycle, would fly in few cycles and registers.

    Of the operations whose arguments are ready it takes the one with the longest way to the end (list scheduling). A
    processor looks some hundred operations ahead; in depth-first order that window is one chain, and it waits. But when as
    many results wait for their use as there are registers, it takes operations that end more waiting than they begin, for a
    value that is put aside in memory costs a store and a load.

    Parameters
    ----------
    nodes : iterable of int
        In any order.
    arguments : callable
        Nodes a node needs; those that are not among `nodes` are there from the beginning.
    latency : callable
        Cycles until the result of a node can be used.
    registers : int
        Vectors that a processor holds; 20 to 40 are equally good for one that has 32.

    References
    ----------
    Graham (1969), Bounds on multiprocessing timing anomalies, SIAM Journal on Applied Mathematics 17(2), 416-429; Goodman,
    Hsu (1988), Code scheduling and register allocation in large basic blocks, ICS 2, 442-452.

    Examples
    --------
    >>> needs = {1: (), 2: (), 3: (2,), 4: (1, 3)}
    >>> longest_first(needs, needs.__getitem__, lambda node: 3)
    [2, 1, 3, 4]
    """
    work = _Work(nodes, arguments, latency)
    order: list[int] = []
    while len(order) < len(work.ways):
        order.append(work.take(relieve=work.waiting_for_use >= registers))
    return order


class _Work:
    """What is left to schedule."""

    def __init__(
        self, nodes: Iterable[int], arguments: Callable[[int], Sequence[int]], latency: Callable[[int], int]
    ) -> None:
        inside = sorted(nodes)
        self._users: dict[int, list[int]] = {j: [] for j in inside}
        self._needs = {j: [a for a in dict.fromkeys(arguments(j)) if a in self._users] for j in inside}
        for j in inside:
            for argument in self._needs[j]:
                self._users[argument].append(j)
        self._latency = {j: latency(j) for j in inside}
        self.ways: dict[int, int] = {}
        for j in reversed(inside):
            self.ways[j] = self._latency[j] + max((self.ways[user] for user in self._users[j]), default=0)
        self._missing = {j: len(self._needs[j]) for j in inside}
        self._uses = {j: len(self._users[j]) for j in inside}
        self._ready_at = dict.fromkeys(inside, 0)
        self._cycle = self.waiting_for_use = 0
        # operations that could be taken: whose arguments are computed but not yet there, and those whose are
        self._later = [(0, j) for j in inside if not self._missing[j]]
        self._by_way: list[tuple[int, int]] = []
        self._by_relief: list[tuple[int, int, int]] = []
        self._relief_later: list[tuple[int, int, int]] = []
        self._now: set[int] = set()
        self._done: set[int] = set()

    def take(self, *, relieve: bool) -> int:
        """Next operation: the one that frees most registers if that is wanted, else the one with the longest way."""
        while self._later and (self._later[0][0] <= self._cycle or not self._now):
            self._cycle = max(self._cycle, self._later[0][0])
            _, j = heapq.heappop(self._later)
            if j not in self._done:
                self._now.add(j)
                heapq.heappush(self._by_way, (-self.ways[j], j))
                self._offer(j)
        j = self._relieving() if relieve else self._next(self._by_way)
        self._finish(j)
        self._cycle += 1
        return j

    def _finish(self, j: int) -> None:
        """What becomes ready, or frees a register, now that an operation is written."""
        self._done.add(j)
        self._now.discard(j)
        self.waiting_for_use += self._uses[j] > 0
        for argument in self._needs[j]:
            self._uses[argument] -= 1
            self.waiting_for_use -= not self._uses[argument]
            if self._uses[argument] == 1:
                self._offer(next(user for user in self._users[argument] if user not in self._done))
        for user in self._users[j]:
            self._ready_at[user] = max(self._ready_at[user], self._cycle + self._latency[j])
            self._missing[user] -= 1
            if not self._missing[user]:
                heapq.heappush(self._later, (self._ready_at[user], user))
                self._offer(user)

    def _offer(self, j: int) -> None:
        """Sort in an operation by the registers it frees; again when they have become more."""
        if not self._missing[j]:
            heapq.heappush(
                self._by_relief if j in self._now else self._relief_later, (-self._freed(j), -self.ways[j], j)
            )

    def _freed(self, j: int) -> int:
        """Registers that an operation frees, less the one that it takes."""
        return sum(self._uses[argument] == 1 for argument in self._needs[j]) - (self._uses[j] > 0)

    def _relieving(self) -> int:
        """The operation that frees most; one that would have to wait for its arguments only if no other frees any."""
        j = self._next(self._by_relief)
        if self._freed(j) <= 0:
            other = self._next(self._relief_later)
            if other >= 0 and self._freed(other) > 0:
                return other
        return j

    def _next(self, heap: list[Any]) -> int:
        """Best of a heap that is not done, left there; -1 if there is none."""
        while heap and heap[0][-1] in self._done:
            heapq.heappop(heap)
        return heap[0][-1] if heap else -1
