"""What is computed, whoever writes it down: equal computations have equal numbers."""

import struct
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any

from fddbench.blocks.program import Program

__all__ = ["Value", "Values", "of_program"]

_EITHER_WAY = {"add", "mul", "eq", "ne", "and", "or"}


@dataclass(frozen=True)
class Value:
    """A number or truth that a program computes, by its place among all that are computed."""

    number: int


class Values:
    """Computations, each kept once."""

    def __init__(self) -> None:
        self._known: dict[Hashable, Value] = {}
        self.entries: list[tuple[str, tuple[Value, ...], Any]] = []

    def new(self, op: str, *arguments: Value, value: Any = None) -> Value:
        """Value of an operation; the arguments of a sum or product may come in any order."""
        own = tuple(sorted(arguments, key=lambda each: each.number)) if op in _EITHER_WAY else arguments
        key = (op, own, struct.pack("d", value) if isinstance(value, float) else value)
        if key not in self._known:
            self._known[key] = Value(len(self.entries))
            self.entries.append((op, own, value))
        return self._known[key]

    def literal(self, number: float) -> Value:
        """Value of a number; zeros of either sign differ, not-a-numbers do not."""
        return self.new("literal", value=float("nan") if number != number else float(number))

    def entry(self, value: Value) -> tuple[str, tuple[Value, ...], Any]:
        """Operation, arguments and what else it needs."""
        return self.entries[value.number]

    def said(self, value: Value, depth: int = 3) -> str:
        """A value as text, so deep."""
        op, arguments, extra = self.entry(value)
        if not arguments:
            return f"{extra[0]}[{extra[1]}]" if op == "input" else f"{extra!r}"
        return f"{op}({', '.join(self.said(a, depth - 1) for a in arguments)})" if depth else f"{op}(...)"


def of_program(program: Program, values: Values) -> dict[str, list[Value]]:
    """Value of every output row of a program; `rarely` is speed, and a search in no knots finds none."""
    found: list[Value] = []
    for op, arguments, extra in program.nodes:
        own = [found[a] for a in arguments]
        if op == "literal":
            found.append(values.literal(extra))
        elif op == "rarely":
            found.append(own[0])
        elif op in {"locate", "gather"}:
            found.append(values.new(op, *own, value=extra.data) if len(extra) else values.literal(0.0))
        else:
            found.append(values.new(op, *own, value=extra))
    return {name: [found[node] for node in rows] for name, rows in program.outputs.items()}
