"""A program written anew: its functions as primitives, some of its inputs as something else."""

from collections.abc import Callable, Iterator

import numpy as np

from fddbench.blocks.graph import Graph, Node
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.origin import Origin
from fddbench.blocks.program import Program, digests, prune
from fddbench.blocks.simplify import COMMUTATIVE
from fddbench.blocks.traced import Traced

__all__ = ["canonical", "depends_only_on", "expand", "rebuilt"]

Replace = Callable[[Graph, str, int], int | None]


def expand(program: Program, replace: Replace | None = None) -> Program:
    """The same program in primitives: sines and their kin written out as `blocks.functions` defines them.

    Parameters
    ----------
    replace : callable, optional
        Given the new graph, the name and the row of an input, the node to take instead, or None to keep it.
    """
    return rebuilt(program, replace, expand=True)


def rebuilt(program: Program, replace: Replace | None = None, *, expand: bool = False) -> Program:
    """The program traced again from its own nodes, so that what has become equal or known is found.

    Parameters
    ----------
    replace : callable, optional
        As for `expand`.
    expand : bool
        Write named functions out as primitives.
    """
    graph, place = Graph(expand=expand), list[int]()
    for (op, arguments, value), graph.origin in zip(program.nodes, _origins(program), strict=True):
        if op == "literal":
            place.append(graph.literal(value))
        elif op == "flag":
            place.append(graph.flag(value))
        elif op == "input":
            other = replace(graph, *value) if replace else None
            place.append(graph.input(*value) if other is None else other)
        elif expand and OPERATIONS[op].composite:
            mapped = tuple(Traced(graph, np.asarray(place[a]), boolean=graph.boolean(place[a])) for a in arguments)
            place.append(int(mapped[0].apply(op, mapped).ids))
        else:
            whole = value.written_out() if expand and op == "repeat" else value
            place.append(graph.add(op, *(place[a] for a in arguments), value=whole))
    outputs = {name: tuple(place[node] for node in rows) for name, rows in program.outputs.items()}
    return prune(Program(program.inputs, tuple(graph.nodes), outputs, tuple(graph.origins)))


def _origins(program: Program) -> Iterator[Origin | None]:
    return iter(program.origins or (None,) * len(program.nodes))


def canonical(program: Program) -> Program:
    """The same program with its nodes in an order that does not depend on that of tracing: as its outputs need them."""
    found, nodes = digests(program.nodes), program.nodes
    needs = [tuple(sorted(n.arguments, key=found.__getitem__)) if n.op in COMMUTATIVE else n.arguments for n in nodes]
    place: dict[int, int] = {}
    left = [node for name in sorted(program.outputs, reverse=True) for node in reversed(program.outputs[name])]
    while left:
        missing = [a for a in needs[left[-1]] if a not in place] if left[-1] not in place else []
        if missing:
            left.extend(reversed(missing))
        else:
            place.setdefault(left.pop(), len(place))
    return Program(
        program.inputs,
        tuple(Node(nodes[j].op, tuple(place[a] for a in needs[j]), nodes[j].value) for j in place),
        {name: tuple(place[j] for j in program.outputs[name]) for name in sorted(program.outputs)},
        tuple(program.origins[j] for j in place) if program.origins else (),
    )


def depends_only_on(program: Program, names: set[str]) -> list[bool]:
    """For each node whether it is made of these inputs and of literals only."""
    known: list[bool] = []
    for op, arguments, value in program.nodes:
        known.append(value[0] in names if op == "input" else all(known[a] for a in arguments))
    return known
