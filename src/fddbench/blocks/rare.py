"""What a sample can leave out while nothing seldom is true in any case of its block: see `primitives.rarely`."""

from collections.abc import Collection
from dataclasses import dataclass

from fddbench.blocks.program import Program
from fddbench.blocks.schedule import latency

__all__ = ["Region", "region", "worth_a_branch"]

_WORTH_IT = 60  # cycles of a processor with one operation each, below which a branch costs more than it spares


@dataclass(frozen=True)
class Region:
    """Nodes behind one branch.

    Attributes
    ----------
    inside : frozenset of int
        Nodes that nothing needs unless one of `conditions` is true in some case.
    results : tuple of int
        Those of them that are needed outside.
    conditions : tuple of int
        Nodes whose truth calls for the region; the region does not change them.
    """

    inside: frozenset[int]
    results: tuple[int, ...]
    conditions: tuple[int, ...]


def region(
    program: Program, needed: Collection[int], known: Collection[int], outputs: Collection[int]
) -> Region | None:
    """The nodes that are needed only where ``where(rarely(...), a, b)`` takes ``a``; None if they are not worth a branch.

    Parameters
    ----------
    needed : collection of int
        Nodes of a sample.
    known : collection of int
        Those that have been computed before.
    outputs : collection of int
        Those needed for their own sake.
    """
    nodes = program.nodes
    order = [j for j in sorted(needed) if j not in known]
    choices = {j for j in order if nodes[j].op == "select" and nodes[nodes[j].arguments[0]].op == "rarely"}
    behind: set[int] = set()  # a choice; none of it can be computed before the choice
    for j in order:
        if j in choices or any(a in behind for a in nodes[j].arguments):
            behind.add(j)
    choices = {j for j in choices if nodes[j].arguments[0] not in behind}
    seldom = _only_for(program, order, choices, set(outputs))
    conditions = sorted({nodes[j].arguments[0] for j in choices - seldom if nodes[j].arguments[1] in seldom})
    inside = seldom - behind
    if not worth_a_branch(program, inside):
        return None
    results = {a for j in order if j not in inside for a in nodes[j].arguments if a in inside}
    return Region(frozenset(inside), tuple(sorted(results)), tuple(conditions))


def worth_a_branch(program: Program, inside: Collection[int]) -> bool:
    """Whether some nodes cost more than a branch around them."""
    costly = (j for j in inside if program.nodes[j].op not in {"literal", "flag"})
    return sum(latency(program, j) for j in costly) >= _WORTH_IT


def _only_for(program: Program, order: list[int], choices: set[int], outputs: set[int]) -> set[int]:
    """Nodes that nothing needs but what some choices take where their condition is true."""
    needed_anyway, used = set(outputs), set[int]()
    found: set[int] = set()
    for j in reversed(order):
        if j in used and j not in needed_anyway:
            found.add(j)
        arguments = program.nodes[j].arguments
        used.update(arguments)
        if j not in found:
            needed_anyway.update(arguments if j not in choices else (arguments[0], arguments[2]))
    return found
