"""A step repeated inside a sample: one node whose body is a program of its own, run in a loop wherever it is flown."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fddbench.blocks.graph import Graph
from fddbench.blocks.layout import Rows
from fddbench.blocks.program import Program, digests, prune
from fddbench.blocks.rewrite import expand, rebuilt
from fddbench.blocks.traced import Traced
from fddbench.blocks.trouble import trouble

__all__ = ["Loop", "repeat"]


@dataclass(frozen=True, eq=False)
class Loop:
    """A body, and how often it runs.

    Attributes
    ----------
    body : Program
        Inputs ``x`` and ``fixed``, output ``x``.
    count : int
        How often.
    """

    body: Program
    count: int

    @property
    def rows(self) -> int:
        """Rows of x."""
        return self.body.inputs["x"]

    def written_out(self) -> "Loop":
        """The same in primitives."""
        return replace(self, body=expand(self.body))

    def __repr__(self) -> str:
        return f"Loop({self.body.hash}, {self.count})"

    def __hash__(self) -> int:
        return hash((self.body.hash, self.count))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Loop) and (self.body.hash, self.count) == (other.body.hash, other.count)


def repeat(step: Callable[..., Rows], x: Rows, *fixed: Rows, count: int) -> Rows:
    """`x` after `count` applications of ``x = step(x, *fixed)``.

    Traced, the step is traced once, whatever the count; values that it takes from outside, handed over in `fixed` or just
    used, stay as they are meanwhile, and numbers known when tracing are written into the body. A count of 1 leaves no loop.

    Parameters
    ----------
    step : callable
        Gives rows of the shape of `x`. It may repeat something itself.
    x : (n, n_cases) rows
        Where it starts.
    fixed : rows
        What it needs beside `x`.

    Raises
    ------
    TraceError
        The step gives rows of another shape.

    Examples
    --------
    >>> repeat(lambda x, a: a * x + 1.0, np.array([[0.0, 4.0]]), 0.5, count=3)
    array([[1.75, 2.25]])
    """
    traced = max((v for v in (x, *fixed) if isinstance(v, Traced)), key=lambda v: v.graph.depth, default=None)
    for done in range(count):
        if traced is not None and count - done > 1:
            return _loop(step, traced.lift(x).number(), fixed, count - done)
        x = step(x, *fixed)
        traced = x if isinstance(x, Traced) else None  # it may use traced values that were not handed over
    return x


class _Inside(Graph):
    """Graph of a body: values of the trace around it become inputs, its numbers are written down."""

    def __init__(self, around: Graph) -> None:
        super().__init__(locate=around.locator is not None)
        self.around, self.depth = around, around.depth + 1
        self.captured: dict[int, int] = {}

    def adopt(self, graph: Graph, node: int) -> int:
        """Node here that stands for a node of the trace around, or of one around that."""
        if graph is not self.around:
            node = self.around.adopt(graph, node)
        known, boolean = self.around.constant(node), self.around.boolean(node)
        if known is not None:
            return self.flag(bool(known)) if boolean else self.literal(known)
        number = self.around.add("number", node) if boolean else node
        inside = self.input("fixed", self.captured.setdefault(number, len(self.captured)))
        return self.add("ne", inside, self.literal(0.0)) if boolean else inside


def _loop(step: Callable[..., Rows], x: Traced, fixed: tuple[Any, ...], count: int) -> Traced:
    """Rows of a new repeat node."""
    graph = _Inside(x.graph)
    ids = np.array([graph.input("x", row) for row in range(x.size)], dtype=np.int64)
    inside = Traced(graph, ids.reshape(x.shape))
    try:
        after = inside.lift(step(inside, *fixed)).number()
    finally:
        graph.forget()
    if after.shape != x.shape:
        trouble(f"a repeated step turns rows of shape {x.shape} into {after.shape}", "give as many rows as it takes")
    outputs = {"x": tuple(after.ids.ravel().tolist())}
    body = Program({"x": x.size, "fixed": len(graph.captured)}, tuple(graph.nodes), outputs, tuple(graph.origins))
    body, captured = _ordered(prune(body), list(graph.captured), x.graph)
    whole = x.graph.add("repeat", *x.ids.ravel().tolist(), *captured, value=Loop(body, count))
    rows = [x.graph.add("row", whole, value=row) for row in range(x.size)]
    return x.like(np.array(rows, dtype=np.int64).reshape(x.shape), boolean=False)


def _ordered(body: Program, captured: list[int], around: Graph) -> tuple[Program, list[int]]:
    """The body with those inputs only that it needs, in an order that does not depend on that of tracing."""
    used = {node.value[1] for node in body.nodes if node.op == "input" and node.value[0] == "fixed"}
    found = digests(around.nodes)
    order = sorted(used, key=lambda row: found[captured[row]])
    place = {row: number for number, row in enumerate(order)}
    renamed = rebuilt(
        replace(body, inputs={**body.inputs, "fixed": len(order)}),
        lambda graph, name, row: graph.input(name, place[row]) if name == "fixed" else None,
    )
    return renamed, [captured[row] for row in order]
