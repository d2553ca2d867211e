"""Finds the state rows that change, and the ring buffers, so that a kernel addresses one row instead of comparing all."""

from collections import defaultdict
from dataclasses import dataclass

from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import depends_only_on

__all__ = ["Ring", "reads", "state_row", "writes", "written"]


@dataclass(frozen=True)
class Ring:
    """Consecutive state rows, one of which is meant.

    Attributes
    ----------
    index : int
        Node of the place among the rows, the same in every lane.
    first, depth : int
        First state row and number of rows.
    value : int
        Node written; -1 when the row is read.
    """

    index: int
    first: int
    depth: int
    value: int = -1


def state_row(program: Program, node: int) -> int:
    """Row of a state input, else -1."""
    op, _, value = program.nodes[node]
    return value[1] if op == "input" and value[0] == "state" else -1


def reads(program: Program) -> dict[int, Ring]:
    """Picks, by node, whose rows are consecutive state rows and whose index is the same in every lane."""
    uniform, found = depends_only_on(program, {"sample"}), {}
    for j, (op, arguments, _) in enumerate(program.nodes):
        if op == "pick" and uniform[arguments[0]]:
            rows = [state_row(program, a) for a in arguments[1:]]
            if rows[0] >= 0 and rows == list(range(rows[0], rows[0] + len(rows))):
                found[j] = Ring(arguments[0], rows[0], len(rows))
    return found


def writes(program: Program) -> list[Ring]:
    """Runs of state rows of which each is replaced by one and the same value when its turn has come, else kept."""
    uniform, turns = depends_only_on(program, {"sample"}), defaultdict(set)
    for row, node in enumerate(program.outputs["state"]):
        op, arguments, _ = program.nodes[node]
        if op != "select" or state_row(program, arguments[2]) != row:
            continue
        test, compared, _ = program.nodes[arguments[0]]
        for index, turn in (compared, compared[::-1]) if test == "eq" else ():
            place = program.nodes[turn].value
            if program.nodes[turn].op == "literal" and uniform[index] and float(place).is_integer():
                turns[index, arguments[1], row - int(place)].add(int(place))
    return [
        Ring(index, first, len(places), value)
        for (index, value, first), places in turns.items()
        if len(places) > 1 and places == set(range(len(places)))
    ]


def written(program: Program) -> dict[int, int]:
    """Node that each state row becomes, of the rows that do not stay as they are."""
    return {row: node for row, node in enumerate(program.outputs["state"]) if state_row(program, node) != row}
