"""A traced step: flat list of scalar operations with named inputs and outputs."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

import numpy as np

from fddbench.blocks.graph import Graph, Node
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.traced import Traced
from fddbench.blocks.trouble import trouble

__all__ = ["Program", "depends_only_on", "expand", "prune", "trace"]


@dataclass(frozen=True)
class Program:
    """What a step computes, operation by operation.

    Attributes
    ----------
    inputs : mapping of str to int
        Rows of each input; 0 for a single signal, seen as (n_cases,).
    nodes : tuple of Node
        Operations; arguments come before their use.
    outputs : mapping of str to tuple of int
        Node of each row of each output; every output is a number (true is 1).
    """

    inputs: Mapping[str, int]
    nodes: tuple[Node, ...]
    outputs: Mapping[str, tuple[int, ...]]

    @property
    def counts(self) -> Counter[str]:
        """Number of nodes by operation, leaves included."""
        return Counter(node.op for node in self.nodes)

    @property
    def hash(self) -> str:
        """Identity of the computation: sha256 of inputs, nodes and outputs, in hexadecimal."""
        text = repr((sorted(self.inputs.items()), [tuple(n) for n in self.nodes], list(self.outputs.items())))
        return sha256(text.encode()).hexdigest()

    def keep(self, *names: str) -> "Program":
        """The same program with these outputs only, and nothing computed that they do not need."""
        return prune(Program(self.inputs, self.nodes, {name: self.outputs[name] for name in names}))


def trace(function: Callable[..., Mapping[str, Any]], /, **inputs: int) -> Program:
    """Program of a step.

    Parameters
    ----------
    function : callable
        Called once with the inputs by keyword, (rows, 1) or (1,) for 0 rows; gives a mapping of names to rows.
    inputs : int
        Rows of each input.

    Examples
    --------
    >>> program = trace(lambda x, gain: {"x": np.maximum(x * gain, 0.0)}, x=2, gain=0)
    >>> program.counts["mul"], program.counts["max"], len(program.outputs["x"])
    (2, 2, 2)
    """
    graph, values = Graph(), {}
    for name, rows in inputs.items():
        ids = np.array([graph.input(name, row) for row in range(max(rows, 1))], dtype=np.int64)
        values[name] = Traced(graph, ids[:, np.newaxis] if rows else ids)
    results = function(**values)
    root = Traced(graph, np.zeros(0, dtype=np.int64))
    outputs = {name: _rows(root.lift(value).number(), name) for name, value in results.items()}
    return prune(Program(dict(inputs), tuple(graph.nodes), outputs))


def _rows(value: Traced, name: str) -> tuple[int, ...]:
    """Nodes of an output, one a row."""
    if value.ndim and value.shape[-1] != 1:
        trouble(
            f"output {name!r} has shape {value.shape}", "its last axis must be the case axis, of length 1 when traced"
        )
    return tuple(value.ids.ravel().tolist())


def prune(program: Program) -> Program:
    """The same program without the nodes that no output needs."""
    needed, nodes = [False] * len(program.nodes), program.nodes
    for rows in program.outputs.values():
        for j in rows:
            needed[j] = True
    for j in range(len(nodes) - 1, -1, -1):
        if needed[j]:
            for argument in nodes[j].arguments:
                needed[argument] = True
    place: dict[int, int] = {}
    kept: list[Node] = []
    for j, node in enumerate(nodes):
        if needed[j]:
            place[j] = len(kept)
            kept.append(Node(node.op, tuple(place[a] for a in node.arguments), node.value))
    outputs = {name: tuple(place[j] for j in rows) for name, rows in program.outputs.items()}
    return Program(program.inputs, tuple(kept), outputs)


def expand(program: Program, replace: Callable[[Graph, str, int], int | None] | None = None) -> Program:
    """The same program in primitives: sines and their kin written out as `blocks.functions` defines them.

    Parameters
    ----------
    replace : callable, optional
        Given the new graph, the name and the row of an input, the node to take instead, or None to keep it.
    """
    graph, place = Graph(expand=True), list[int]()
    for op, arguments, value in program.nodes:
        if op == "literal":
            place.append(graph.literal(value))  # type: ignore[arg-type]
        elif op == "flag":
            place.append(graph.flag(value))  # type: ignore[arg-type]
        elif op == "input":
            name, row = value  # type: ignore[misc]
            other = replace(graph, name, row) if replace else None
            place.append(graph.input(name, row) if other is None else other)
        else:
            mapped = tuple(Traced(graph, np.asarray(place[a]), boolean=graph.boolean(place[a])) for a in arguments)
            place.append(_scalar(graph, op, mapped))
    outputs = {name: tuple(place[node] for node in rows) for name, rows in program.outputs.items()}
    return prune(Program(program.inputs, tuple(graph.nodes), outputs))


def _scalar(graph: Graph, op: str, arguments: tuple[Traced, ...]) -> int:
    """Node of one operation; composites by running their definition."""
    if OPERATIONS[op].numpy is not None:
        return graph.add(op, *(int(argument.ids) for argument in arguments))
    return int(arguments[0].apply(op, arguments).ids)


def depends_only_on(program: Program, names: set[str]) -> list[bool]:
    """For each node whether it is made of these inputs and of literals only."""
    known: list[bool] = []
    for op, arguments, value in program.nodes:
        known.append(value[0] in names if op == "input" else all(known[a] for a in arguments))  # type: ignore[index]
    return known
