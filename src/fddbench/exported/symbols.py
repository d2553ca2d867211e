"""Symbol libraries: the operations that a code generator for flight computers has, and what a detector needs beyond them."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.program import Program
from fddbench.errors import DesignError, did_you_mean
from fddbench.exported.statements import statement_at

__all__ = ["LIBRARIES", "SYMBOLS", "Library", "library", "require_symbols"]

_GROUPS = {
    "compare": ("lt", "le", "eq", "ne"), "logic": ("and", "or", "not"), "switch": ("select", "number", "pick"),
    "lookup": ("locate", "gather"), "loop": ("repeat", "row"), "angle": ("sin", "cos", "atan2", "asin"),
}  # fmt: skip
"""Symbols that are several operations."""
_FREE = {"literal", "input", "flag", "rarely"}
SYMBOLS = frozenset({*OPERATIONS, *_GROUPS, "delay"} - _FREE)
"""What a library may be made of."""

LIBRARIES: dict[str, tuple[Any, ...]] = {
    "scalar": (
        "add", "sub", "mul", "div", "neg", "abs", "min", "max", "sqrt", "compare", "logic", "switch", {"lookup": 1024},
        "sin", "cos", "delay",
    ),
}  # fmt: skip
"""Libraries by name. ``scalar``: after section 7.4 of the yaw-rate sliding-mode observer paper of the ADDSAFE project, whose
graphical library has scalar sums and products (a matrix is broken down to them), logic and switches; which of the elementary
functions it has the paper does not say: here root, sine and cosine, no exponential, logarithm or power."""


@dataclass(frozen=True)
class Library:
    """Operations that may be used.

    Attributes
    ----------
    name : str
        As it was asked for.
    most : mapping of str to float
        By operation how often it may stand in a step; of a look-up how many numbers a table may have; ``delay``: states.
    """

    name: str
    most: Mapping[str, float]


def library(symbols: str | Sequence[Any]) -> Library:
    """Library of a name, or of a list of symbols, each with a size if it is limited: ``[add, mul, {lookup: 64}]``.

    Raises
    ------
    DesignError
        There is no such library or symbol, or a size is no whole number above 0.
    """
    if isinstance(symbols, str):
        if symbols not in LIBRARIES:
            hint = did_you_mean(symbols, LIBRARIES)
            raise DesignError(
                f"no symbol library is called {symbols!r}. {f'{hint} ' if hint else ''}Known: {', '.join(LIBRARIES)}"
            )
        return Library(symbols, library(LIBRARIES[symbols]).most)
    most: dict[str, float] = {}
    wrong = []
    for entry in symbols:
        pairs = entry.items() if isinstance(entry, Mapping) else [(entry, float("inf"))]
        for name, size in pairs:
            if name not in SYMBOLS:
                hint = did_you_mean(str(name), SYMBOLS)
                wrong.append(f"no symbol is called {name!r}{f' ({hint})' if hint else ''}")
            elif isinstance(size, bool) or not isinstance(size, int | float) or size <= 0:
                wrong.append(f"the size of {name} must be a whole number above 0, got {size!r}")
            else:
                most |= dict.fromkeys(_GROUPS.get(name, (name,)), float(size))
    if wrong:
        raise DesignError("symbols: " + "; ".join(wrong) + f". Known: {', '.join(sorted(SYMBOLS))}")
    return Library("of " + ", ".join(str(next(iter(e))) if isinstance(e, Mapping) else str(e) for e in symbols), most)


def require_symbols(program: Program, allowed: Library, name: str) -> None:
    """Do nothing where a program keeps to a library.

    Raises
    ------
    DesignError
        What it needs beyond it, and in which line.
    """
    needed: dict[str, list[str]] = {}
    counted = Counter[str]()
    too_large = []
    for j, (op, _, value) in enumerate(program.nodes):
        if op in _FREE:
            continue
        counted[op] += 1
        if op not in allowed.most:
            origin = program.origins[j] if program.origins else None
            statement = statement_at(origin.line) if origin else None
            needed.setdefault(op, []).append(f"{statement.place} ({statement.text})" if statement else "somewhere")
        elif op in {"locate", "gather"} and len(value) > allowed.most[op]:
            too_large.append(f"a table of {len(value)} numbers, at most {allowed.most[op]:g}")
    wrong = [f"{op}, {len(where)} times: {'; '.join(list(dict.fromkeys(where))[:3])}" for op, where in needed.items()]
    tables = {"locate", "gather"}
    wrong += [
        f"{n} times {op}, at most {allowed.most[op]:g}"
        for op, n in counted.items()
        if op not in tables and n > allowed.most.get(op, n)
    ]
    states = program.inputs.get("state", 0)
    if states > allowed.most.get("delay", 0):
        wrong.append(f"{states} states, at most {allowed.most.get('delay', 0):g} (delay)")
    wrong += dict.fromkeys(too_large)
    if wrong:
        raise DesignError(f"{name} needs more than the symbols {allowed.name}:\n  " + "\n  ".join(wrong))
