"""Nodes of a program while it is being traced: equal nodes are one, and what is known is computed at once."""

import struct
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fddbench.blocks.operations import OPERATIONS

__all__ = ["Graph", "Node"]


class Node(NamedTuple):
    """One scalar operation.

    Attributes
    ----------
    op : str
        Name in `OPERATIONS`.
    arguments : tuple of int
        Nodes it takes.
    value : float, bool, (str, int) or None
        Number of a literal or flag; name and row of an input.
    """

    op: str
    arguments: tuple[int, ...] = ()
    value: float | bool | tuple[str, int] | None = None


class Graph:
    """Growing list of nodes; a node refers to earlier ones only.

    Parameters
    ----------
    expand : bool
        Named functions (sin, ...) are written out as primitives instead of being kept as one node.
    """

    def __init__(self, *, expand: bool = False) -> None:
        self.expand = expand
        self.nodes: list[Node] = []
        self._index: dict[object, int] = {}

    def literal(self, value: float) -> int:
        """Node of a number; zeros of either sign are different."""
        return self._intern(("literal", struct.pack("d", value)), Node("literal", (), float(value)))

    def flag(self, value: bool) -> int:
        """Node of true or false."""
        return self._intern(("flag", bool(value)), Node("flag", (), bool(value)))

    def input(self, name: str, row: int) -> int:
        """Node of an input row."""
        return self._intern(("input", name, row), Node("input", (), (name, row)))

    def add(self, op: str, *arguments: int) -> int:
        """Node of an operation, after folding of constants and the simplifications of `_simpler`."""
        known = self._folded(op, arguments)
        if known is None:
            known = self._simpler(op, arguments)
        if known is not None:
            return known
        key = tuple(sorted(arguments)) if op in _COMMUTATIVE else arguments
        return self._intern((op, key), Node(op, key))

    def boolean(self, node: int) -> bool:
        """Whether a node is true or false rather than a number."""
        return OPERATIONS[self.nodes[node].op].result == "b"

    def constant(self, node: int) -> float | None:
        """Number of a literal or flag, else None."""
        kind, _, value = self.nodes[node]
        return float(value) if kind in {"literal", "flag"} else None  # type: ignore[arg-type]

    def _intern(self, key: object, node: Node) -> int:
        found = self._index.get(key)
        if found is None:
            found = self._index[key] = len(self.nodes)
            self.nodes.append(node)
        return found

    def _folded(self, op: str, arguments: tuple[int, ...]) -> int | None:
        """Literal of a primitive whose arguments are all known, computed by NumPy in float64."""
        compute, nodes = OPERATIONS[op].numpy, self.nodes
        if compute is None or any(nodes[a].op not in {"literal", "flag"} for a in arguments):
            return None
        with np.errstate(all="ignore"):
            value = compute(*(np.asarray(nodes[a].value) for a in arguments))
        return self.flag(bool(value)) if OPERATIONS[op].result == "b" else self.literal(float(value))

    def _simpler(self, op: str, arguments: tuple[int, ...]) -> int | None:
        """An earlier or cheaper node with the same value for finite numbers, up to the sign of a zero.

        ``x 0`` becomes 0 and ``x + 0`` becomes x: this is what makes the zeros of a matrix free. A product of zero with
        an infinite number would have been not-a-number.
        """
        rule = _RULES.get(op)
        return rule(self, *arguments) if rule else None


def _simpler_add(g: Graph, a: int, b: int) -> int | None:
    for x, y in ((a, b), (b, a)):
        if g.constant(y) == 0.0:
            return x
        if g.nodes[y].op == "neg":
            return g.add("sub", x, g.nodes[y].arguments[0])
    return None


def _simpler_sub(g: Graph, a: int, b: int) -> int | None:
    if g.constant(b) == 0.0:
        return a
    if g.constant(a) == 0.0:
        return g.add("neg", b)
    if g.nodes[b].op == "neg":
        return g.add("add", a, g.nodes[b].arguments[0])
    return None


def _simpler_mul(g: Graph, a: int, b: int) -> int | None:
    for x, y in ((a, b), (b, a)):
        known = g.constant(y)
        if known == 0.0:
            return g.literal(0.0)
        if known == 1.0:
            return x
        if known == -1.0:
            return g.add("neg", x)
    return None


def _simpler_div(g: Graph, a: int, b: int) -> int | None:
    known = g.constant(b)
    if known is not None and abs(np.frexp(known)[0]) == 0.5 and 1e-300 < abs(known) < 1e300:
        return g.add("mul", a, g.literal(1.0 / known))  # exact for powers of two
    return None


def _simpler_neg(g: Graph, a: int) -> int | None:
    node = g.nodes[a]
    return node.arguments[0] if node.op == "neg" else None


def _simpler_not(g: Graph, a: int) -> int | None:
    node = g.nodes[a]
    return node.arguments[0] if node.op == "not" else None


def _simpler_min(g: Graph, a: int, b: int) -> int | None:
    return _simpler_extreme(g, "min", a, b)


def _simpler_max(g: Graph, a: int, b: int) -> int | None:
    return _simpler_extreme(g, "max", a, b)


def _simpler_extreme(g: Graph, op: str, a: int, b: int) -> int | None:
    known = g.constant(b)
    if known is not None and np.isnan(known):
        return b
    if known is not None and g.constant(a) is None:
        return g.add(op, b, a)  # a number first needs no look at nan in machine code
    known = g.constant(a)
    return a if a == b or (known is not None and np.isnan(known)) else None


def _simpler_and(g: Graph, a: int, b: int) -> int | None:
    for x, y in ((a, b), (b, a)):
        if g.nodes[y].op == "flag":
            return x if g.nodes[y].value else y
    return a if a == b else None


def _simpler_or(g: Graph, a: int, b: int) -> int | None:
    for x, y in ((a, b), (b, a)):
        if g.nodes[y].op == "flag":
            return y if g.nodes[y].value else x
    return a if a == b else None


def _simpler_select(g: Graph, condition: int, a: int, b: int) -> int | None:
    node = g.nodes[condition]
    if node.op == "flag":
        return a if node.value else b
    if node.op == "not":
        return g.add("select", node.arguments[0], b, a)
    if a == b:
        return a
    return g.add("number", condition) if (g.constant(a), g.constant(b)) == (1.0, 0.0) else None


def _simpler_ne(g: Graph, a: int, b: int) -> int | None:
    if g.nodes[a].op == "number" and g.constant(b) == 0.0:
        return g.nodes[a].arguments[0]
    return None


_COMMUTATIVE = {"add", "mul", "eq", "ne", "and", "or"}
_RULES: dict[str, Callable[..., int | None]] = {
    "add": _simpler_add,
    "sub": _simpler_sub,
    "mul": _simpler_mul,
    "div": _simpler_div,
    "neg": _simpler_neg,
    "not": _simpler_not,
    "min": _simpler_min,
    "max": _simpler_max,
    "and": _simpler_and,
    "or": _simpler_or,
    "select": _simpler_select,
    "ne": _simpler_ne,
}
