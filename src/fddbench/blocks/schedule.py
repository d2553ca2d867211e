"""In which order to write operations: the longest chain first, so that a processor always has something else to do."""

import heapq
from collections.abc import Callable, Iterable, Sequence

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
    nodes: Iterable[int], arguments: Callable[[int], Sequence[int]], latency: Callable[[int], int]
) -> list[int]:
    """The nodes in an order that an imagined processor, one operation a cycle, would fly in the fewest cycles.

    Of the operations whose arguments are ready it takes the one with the longest way to the end (list scheduling). A
    processor looks some hundred operations ahead; in depth-first order that window is one chain, and it waits.

    Parameters
    ----------
    nodes : iterable of int
        In any order.
    arguments : callable
        Nodes a node needs; those that are not among `nodes` are there from the beginning.
    latency : callable
        Cycles until the result of a node can be used.

    References
    ----------
    Graham (1969), Bounds on multiprocessing timing anomalies, SIAM Journal on Applied Mathematics 17(2), 416-429.

    Examples
    --------
    >>> needs = {1: (), 2: (), 3: (2,), 4: (1, 3)}
    >>> longest_first(needs, needs.__getitem__, lambda node: 3)
    [2, 1, 3, 4]
    """
    inside = sorted(nodes)
    users: dict[int, list[int]] = {j: [] for j in inside}
    missing: dict[int, int] = {}
    for j in inside:
        needed = {a for a in arguments(j) if a in users}
        missing[j] = len(needed)
        for argument in needed:
            users[argument].append(j)
    way: dict[int, int] = {}
    for j in reversed(inside):
        way[j] = latency(j) + max((way[user] for user in users[j]), default=0)
    ready_at = dict.fromkeys(inside, 0)
    waiting = [(0, j) for j in inside if not missing[j]]
    ready: list[tuple[int, int]] = []
    order: list[int] = []
    cycle = 0
    while waiting or ready:
        while waiting and (waiting[0][0] <= cycle or not ready):
            cycle = max(cycle, waiting[0][0])
            _, j = heapq.heappop(waiting)
            heapq.heappush(ready, (-way[j], j))
        _, j = heapq.heappop(ready)
        order.append(j)
        for user in users[j]:
            ready_at[user] = max(ready_at[user], cycle + latency(j))
            missing[user] -= 1
            if not missing[user]:
                heapq.heappush(waiting, (ready_at[user], user))
        cycle += 1
    return order
