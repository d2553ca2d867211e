"""Rules by which a node is not written down because an earlier or cheaper one has the same value.

The values are the same for finite numbers, up to the sign of a zero: ``x 0`` becomes 0 and ``x + 0`` becomes x, which is what
makes the zeros of a matrix free. A product of zero with an infinite number would have been not-a-number.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fddbench.blocks.graph import Graph

__all__ = ["COMMUTATIVE", "simpler"]


def simpler(g: Graph, op: str, arguments: Sequence[int]) -> int | None:
    """Node to take in place of ``op(*arguments)``; None if there is no better one."""
    rule = _RULES.get(op)
    return rule(g, *arguments) if rule else None


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


COMMUTATIVE = {"add", "mul", "eq", "ne", "and", "or"}
"""Operations whose arguments may change places; only what a not-a-number carries in its payload may differ."""

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
