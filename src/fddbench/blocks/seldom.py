"""State rows that stay as they are in most samples, with all that only they need: see `primitives.rarely`."""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from fddbench.blocks.program import Program
from fddbench.blocks.rare import worth_a_branch

__all__ = ["Update", "independent", "updates"]

_ANYWAY = -1  # owner of what is needed in every sample


@dataclass(frozen=True)
class Update:
    """State rows that change only where one condition is true, ``np.where(rarely(condition), new, old)``.

    Attributes
    ----------
    condition : int
        Node of it.
    rows : tuple of int
        The state rows; where it is false in every case they are neither read nor written.
    inside : frozenset of int
        Nodes that nothing else needs: the choices between new and old, and what they are made of.
    """

    condition: int
    rows: tuple[int, ...]
    inside: frozenset[int]


def updates(
    program: Program, becomes: Mapping[int, int], needed: Collection[int], arguments: Callable[[int], Sequence[int]],
    outputs: Collection[int], reads: Mapping[int, Collection[int]],
) -> list[Update]:  # fmt: skip
    """The rows that seldom change, by condition, where a branch is worth it.

    Parameters
    ----------
    becomes : mapping of int to int
        Node that a state row becomes, of all rows that are written.
    needed : collection of int
        Nodes of a sample.
    arguments : callable
        Nodes a node needs in a sample.
    outputs : collection of int
        Nodes needed for their own sake, beside what rows become.
    reads : mapping of int to collection of int
        State rows that a node reads, by node.
    """
    times, users = Counter(becomes.values()), defaultdict(set)
    for j in needed:
        for a in arguments(j):
            users[a].add(j)
    chosen = {row: j for row, j in becomes.items() if times[j] == 1 and _seldom(program, row, j)}
    while True:
        owners = _owners(program, becomes, needed, arguments, outputs, reads, chosen)
        rows: dict[int, list[int]] = defaultdict(list)
        for row, j in chosen.items():
            rows[owners[j]].append(row)
        last = {q: max(chosen[row] for row in some) for q, some in rows.items()}
        # an update comes as a whole before all that ask for its new rows
        early = [r for r, j in chosen.items() if any(u < last[owners[j]] and owners[u] != owners[j] for u in users[j])]
        if not early:
            break
        for row in early:
            del chosen[row]
    found = [
        Update(q, tuple(rows[q]), frozenset(j for j in needed if owners[j] == q))
        for q in sorted(rows, key=last.__getitem__)
    ]
    return [update for update in found if worth_a_branch(program, update.inside)]


def independent(
    needed: Collection[int], behind: Collection[int], arguments: Callable[[int], Sequence[int]]
) -> set[int]:
    """Nodes that can be computed before all those `behind` a branch: they ask for none of them."""
    later: set[int] = set()
    for j in sorted(needed):
        if j in behind or any(a in later for a in arguments(j)):
            later.add(j)
    return set(needed) - later


def _seldom(program: Program, row: int, j: int) -> bool:
    """Whether a node is ``where(rarely(...), new, old)`` of a state row."""
    op, arguments, _ = program.nodes[j]
    return (
        op == "select"
        and program.nodes[arguments[0]].op == "rarely"
        and program.nodes[arguments[2]].value == ("state", row)
    )


def _owners(
    program: Program, becomes: Mapping[int, int], needed: Collection[int], arguments: Callable[[int], Sequence[int]],
    outputs: Collection[int], reads: Mapping[int, Collection[int]], chosen: Mapping[int, int],
) -> dict[int, int]:  # fmt: skip
    """The condition that alone calls for a node, or `_ANYWAY`, by node."""
    choices = {j: program.nodes[j].arguments[0] for j in chosen.values()}
    owners: dict[int, int] = dict(choices)

    def claim(nodes: Iterable[int], owner: int) -> None:
        for a in nodes:
            if a not in choices:
                owners[a] = owner if owners.get(a, owner) == owner else _ANYWAY

    claim((*outputs, *(j for row, j in becomes.items() if row not in chosen), *choices.values()), _ANYWAY)
    for j in sorted(needed, reverse=True):
        # what reads a row must have done so before the row is written, which another update may do
        if any(row in becomes and choices.get(chosen.get(row, -1)) != owners[j] for row in reads.get(j, ())):
            owners[j] = _ANYWAY
        claim(arguments(j), owners[j])
    return owners
