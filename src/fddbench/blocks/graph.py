"""Nodes of a program while it is being traced: equal nodes are one, and what is known is computed at once."""

import struct
from collections.abc import Hashable
from typing import Any, NamedTuple

import numpy as np

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.origin import Locator, Origin
from fddbench.blocks.simplify import COMMUTATIVE, simpler
from fddbench.blocks.trouble import trouble

__all__ = ["Graph", "Node"]


class Node(NamedTuple):
    """One scalar operation.

    Attributes
    ----------
    op : str
        Name in `OPERATIONS`.
    arguments : tuple of int
        Nodes it takes.
    value : hashable or None
        What the operation needs beside its arguments: number of a literal or flag, (name, row) of an input, table of a
        look-up, loop of a repeat, row of its result.
    """

    op: str
    arguments: tuple[int, ...] = ()
    value: Any = None


class Graph:
    """Growing list of nodes; a node refers to earlier ones only.

    Parameters
    ----------
    expand : bool
        Named functions (sin, ...) are written out as primitives instead of being kept as one node.
    locate : bool
        The line and block that each node comes from are looked for in the frames of the caller.

    Attributes
    ----------
    depth : int
        How many traces it is inside of.
    origin : Origin or None
        Given to new nodes when it is not None, instead of looking for one.
    """

    def __init__(self, *, expand: bool = False, locate: bool = False) -> None:
        self.expand, self.depth = expand, 0
        self.nodes: list[Node] = []
        self.origins: list[Origin | None] = []
        self.origin: Origin | None = None
        self.locator = Locator() if locate else None
        self._index: dict[Hashable, int] = {}

    def literal(self, value: float) -> int:
        """Node of a number; zeros of either sign are different."""
        return self._intern(("literal", struct.pack("d", value)), Node("literal", (), float(value)))

    def flag(self, value: bool) -> int:
        """Node of true or false."""
        return self._intern(("flag", bool(value)), Node("flag", (), bool(value)))

    def input(self, name: str, row: int) -> int:
        """Node of an input row."""
        return self._intern(("input", name, row), Node("input", (), (name, row)))

    def add(self, op: str, *arguments: int, value: Hashable = None) -> int:
        """Node of an operation, after folding of constants and the simplifications of `simplify`."""
        known = self._folded(op, arguments, value)
        if known is None:
            known = simpler(self, op, arguments)
        if known is not None:
            return known
        key = tuple(sorted(arguments)) if op in COMMUTATIVE else arguments
        return self._intern((op, key, value), Node(op, key, value))

    def boolean(self, node: int) -> bool:
        """Whether a node is true or false rather than a number."""
        return OPERATIONS[self.nodes[node].op].result == "b"

    def constant(self, node: int) -> float | None:
        """Number of a literal or flag, else None."""
        kind, _, value = self.nodes[node]
        return float(value) if kind in {"literal", "flag"} else None

    def adopt(self, graph: "Graph", node: int) -> int:  # noqa: ARG002
        """Node here that stands for a node of another graph.

        Raises
        ------
        TraceError
            Always: two traces have nothing to do with each other, and a number of one would be any number in the other.
        """
        trouble(
            "a traced value of another trace is used, kept perhaps on `self` or in a variable outside the step",
            "pass it to the step as an input or part of its state, and keep nothing between two calls",
        )

    def forget(self) -> None:
        """Look for no more origins."""
        if self.locator:
            self.locator.forget()
        self.locator = None

    def _intern(self, key: Hashable, node: Node) -> int:
        found = self._index.get(key)
        if found is None:
            found = self._index[key] = len(self.nodes)
            self.nodes.append(node)
            self.origins.append(self.locator() if self.locator and self.origin is None else self.origin)
        return found

    def _folded(self, op: str, arguments: tuple[int, ...], value: Hashable) -> int | None:
        """Literal of a primitive whose arguments are all known, computed by NumPy in float64."""
        operation, nodes = OPERATIONS[op], self.nodes
        if operation.numpy is None or any(nodes[a].op not in {"literal", "flag"} for a in arguments):
            return None
        extra = () if value is None else (value,)
        with np.errstate(all="ignore"):
            result = operation.numpy(*extra, *(np.asarray(nodes[a].value) for a in arguments))
        return self.flag(bool(result)) if operation.result == "b" else self.literal(float(result))
