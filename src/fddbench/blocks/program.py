"""A traced step: flat list of scalar operations with named inputs and outputs."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import blake2b, sha256
from typing import Any

import numpy as np

from fddbench.blocks.graph import Graph, Node
from fddbench.blocks.origin import Origin
from fddbench.blocks.simplify import COMMUTATIVE
from fddbench.blocks.traced import Traced
from fddbench.blocks.trouble import trouble

__all__ = ["Program", "digests", "prune", "trace"]


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
    origins : tuple of Origin or None
        Block and line that each node was traced from, no part of what the program is; empty: nobody looked.
    """

    inputs: Mapping[str, int]
    nodes: tuple[Node, ...]
    outputs: Mapping[str, tuple[int, ...]]
    origins: tuple[Origin | None, ...] = field(default=(), compare=False, repr=False)

    @property
    def counts(self) -> Counter[str]:
        """Number of nodes by operation, leaves included."""
        return Counter(node.op for node in self.nodes)

    @cached_property
    def hash(self) -> str:
        """Identity of the computation, in hexadecimal: what each output row is made of, whatever was traced first."""
        found = digests(self.nodes)
        outputs = sorted((name, [found[node].hex() for node in rows]) for name, rows in self.outputs.items())
        return sha256(repr((sorted(self.inputs.items()), outputs)).encode()).hexdigest()

    def keep(self, *names: str) -> "Program":
        """The same program with these outputs only, and nothing computed that they do not need."""
        return prune(self.only(*names))

    def only(self, *names: str) -> "Program":
        """The same program with these outputs only; the same hash as `keep`, without looking at what they need."""
        return replace(self, outputs={name: self.outputs[name] for name in names})


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
    graph, values = Graph(locate=True), {}
    for name, rows in inputs.items():
        ids = np.array([graph.input(name, row) for row in range(max(rows, 1))], dtype=np.int64)
        values[name] = Traced(graph, ids[:, np.newaxis] if rows else ids)
    try:
        results = function(**values)
        root = Traced(graph, np.zeros(0, dtype=np.int64))
        outputs = {name: _rows(root.lift(value).number(), name) for name, value in results.items()}
    finally:
        graph.forget()
    return prune(Program(dict(inputs), tuple(graph.nodes), outputs, tuple(graph.origins)))


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
    kept = [j for j in range(len(nodes)) if needed[j]]
    place = {j: number for number, j in enumerate(kept)}
    return Program(
        program.inputs,
        tuple(Node(nodes[j].op, tuple(place[a] for a in nodes[j].arguments), nodes[j].value) for j in kept),
        {name: tuple(place[j] for j in rows) for name, rows in program.outputs.items()},
        tuple(program.origins[j] for j in kept) if program.origins else (),
    )


def digests(nodes: Sequence[Node]) -> list[bytes]:
    """What each node computes, in 16 bytes: a hash of its operation and of its arguments' digests, not of their numbers."""
    found: list[bytes] = []
    plain = {
        op: repr((op, None)).encode() for op in {node.op for node in nodes}
    }  # of those without a value, most of them
    for op, arguments, value in nodes:
        what = plain[op] if value is None else repr((op, value)).encode()
        parts = [found[a] for a in arguments]
        if op in COMMUTATIVE:
            parts.sort()
        found.append(blake2b(what + b"".join(parts), digest_size=16).digest())
    return found
