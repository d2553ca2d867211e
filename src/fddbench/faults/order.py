"""In which order the faults of a scenario act on a site: that of the site's first faulty samples.

At the same sample what replaces acts before what adds, then kinds by name, then lines. Where the order is the same for all
flights there is one stage a line, in that order. Where it differs, between scenarios, sites or drawn onsets, a line has
several stages and acts in one of them, so no stage has to choose between faults.
"""

import heapq
from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fddbench.clock import samples
from fddbench.faults.timing import first_samples, onset_bounds_s
from fddbench.interfaces import Fault, Floats

__all__ = ["orders_of", "pattern_of", "place", "stages"]

Orders = npt.NDArray[np.int64]


def _tie(fault: Fault, line: int) -> tuple[int, str, int]:
    """What decides between faults that begin at the same sample."""
    return int(fault.mode != "replace"), fault.kind, line


def _here(faults: Sequence[Fault], site: str) -> list[int]:
    """Lines of a scenario that act on a site, in the order of their ties."""
    return sorted((j for j, fault in enumerate(faults) if site in fault.sites), key=lambda j: _tie(faults[j], j))


def orders_of(faults: Sequence[Fault], site: str, sample_s: float, n_cases: int) -> Orders:
    """Lines in the order in which they act on a site, (n_lines, n_cases), of faults as they are flown."""
    lines = _here(faults, site)
    first = np.empty((len(lines), n_cases))
    for row, line in enumerate(lines):
        first[row] = first_samples(faults[line], [site], sample_s)[0]
    # the lines stand in the order of their ties, and the sort is stable
    order = np.argsort(first, axis=0, kind="stable")
    return np.array(lines, dtype=np.int64)[order]


def pattern_of(faults: Sequence[Fault], site: str, sample_s: float) -> tuple[int, ...]:
    """Lines such that every order in which a scenario's faults may act on a site is part of them.

    Faults that may overtake each other are repeated: two of them, a and b, as a b a.
    """
    groups: list[list[tuple[int, int, int]]] = []
    found = []
    for rank, line in enumerate(_here(faults, site)):
        bounds_s = onset_bounds_s(faults[line], faults[line].sites.index(site))
        found.append((samples(bounds_s[0], sample_s), rank, samples(bounds_s[1], sample_s), line))
    for first, rank, last, line in sorted(found):
        if groups and any((before, tie) >= (first, rank) for before, tie, _ in groups[-1]):
            groups[-1].append((last, rank, line))
        else:
            groups.append([(last, rank, line)])
    return tuple(line for group in groups for line in _every_order([line for *_, line in group]))


def _every_order(lines: list[int]) -> list[int]:
    """A list that has every order of the lines as a part.

    >>> _every_order([3]), _every_order([1, 2]), _every_order([0, 1, 2])
    ([3], [1, 2, 1], [0, 1, 2, 0, 1, 2, 0])
    """
    return lines * (len(lines) - 1) + lines[:1]


def stages(patterns: Sequence[tuple[int, ...]]) -> tuple[int, ...]:
    """Lines stage by stage, such that every pattern is a part of them; each line once where that is possible.

    >>> stages([(0, 1), (2,)]), stages([(2, 0), (0, 1)]), stages([(0, 1), (1, 0)])
    ((0, 1, 2), (2, 0, 1), (0, 1, 0))
    """
    distinct = sorted(set(patterns), key=lambda pattern: (-len(pattern), pattern))
    return _one_order(distinct) or reduce(_merged, distinct, ())


def _one_order(patterns: Sequence[tuple[int, ...]]) -> tuple[int, ...]:
    """The lines in an order that all patterns share, smaller numbers first where they leave it open; () for none."""
    after: dict[int, set[int]] = {line: set() for pattern in patterns for line in pattern}
    for pattern in patterns:
        for a, b in pairwise(pattern):
            after[a].add(b)
    waiting = {line: sum(line in others for others in after.values()) for line in after}
    ready = [line for line, n in waiting.items() if n == 0]
    heapq.heapify(ready)
    order = []
    while ready:
        line = heapq.heappop(ready)
        order.append(line)
        for other in after[line]:
            waiting[other] -= 1
            if waiting[other] == 0:
                heapq.heappush(ready, other)
    return tuple(order) if len(order) == len(after) else ()


def _merged(a: tuple[int, ...], b: tuple[int, ...]) -> tuple[int, ...]:
    """A shortest list that has both as parts."""
    best: dict[tuple[int, int], tuple[int, ...]] = {}
    for i in range(len(a), -1, -1):
        for j in range(len(b), -1, -1):
            if i == len(a) or j == len(b):
                best[i, j] = a[i:] + b[j:]
            elif a[i] == b[j]:
                best[i, j] = (a[i], *best[i + 1, j + 1])
            else:
                best[i, j] = min((a[i], *best[i + 1, j]), (b[j], *best[i, j + 1]), key=len)
    return best[0, 0]


def place(orders: Orders, sequence: Sequence[int]) -> Floats:
    """1 where a stage acts, (n_stages, n_cases): each line in the first stage that its order leaves open.

    >>> place(np.array([[0, 1], [1, 0]]), (0, 1, 0)).tolist()
    [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    """
    found = np.zeros((len(sequence), orders.shape[1]))
    if not orders.size:
        return found
    different, which = np.unique(orders, axis=1, return_inverse=True)
    for number in range(different.shape[1]):
        stage = -1
        for line in different[:, number].tolist():
            stage = sequence.index(line, stage + 1)
            found[stage, which.ravel() == number] = 1.0
    return found
