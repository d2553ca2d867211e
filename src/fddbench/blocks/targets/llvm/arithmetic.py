"""LLVM text of the primitives, from one line each to those that need several."""

from collections.abc import Callable
from typing import Any

from fddbench.blocks.targets.llvm.writer import Vectors

__all__ = ["ARITHMETIC", "operation"]

_TWO52 = 4503599627370496.0


def operation(o: Vectors, op: str, *a: str) -> str:
    """Name of the value of a primitive."""
    line = ARITHMETIC[op]
    return o.let(line.format(*a, V=o.V, M=o.M, W=o.lanes)) if isinstance(line, str) else str(line(o, None, *a))


def _extreme(o: Vectors, comparison: str, a: str, b: str) -> str:
    chosen = o.let(f"select {o.M} {o.let(f'fcmp {comparison} {o.V} {a}, {b}')}, {o.V} {a}, {o.V} {b}")
    if a.startswith("splat"):  # a number, which is not nan
        return chosen
    ordered = o.let(f"fcmp ord {o.V} {a}, {a}")
    return o.let(f"select {o.M} {ordered}, {o.V} {chosen}, {o.V} {a}")


def _rint(o: Vectors, _: None, a: str) -> str:
    """Nearest whole number; by adding and subtracting 2^52 where no instruction rounds."""
    if o.rounds:
        return o.let(f"call {o.V} @llvm.nearbyint.v{o.lanes}f64({o.V} {a})")
    size = operation(o, "abs", a)
    whole = operation(o, "sub", operation(o, "add", size, o.number(_TWO52)), o.number(_TWO52))
    kept = operation(o, "select", operation(o, "lt", size, o.number(_TWO52)), whole, size)
    sign = o.let(f"and {o.I} {o.as_integers(a)}, {o.integer(-(2**63))}")
    return o.as_doubles(o.let(f"or {o.I} {o.as_integers(kept)}, {sign}"))


def _floor(o: Vectors, _: None, a: str) -> str:
    if o.rounds:
        return o.let(f"call {o.V} @llvm.floor.v{o.lanes}f64({o.V} {a})")
    nearest = _rint(o, _, a)
    return operation(o, "sub", nearest, operation(o, "number", operation(o, "lt", a, nearest)))


def _fraction(o: Vectors, _: None, a: str) -> str:
    kept = o.let(f"and {o.I} {o.as_integers(a)}, {o.integer(-0x7FF0000000000001)}")
    return o.as_doubles(o.let(f"or {o.I} {kept}, {o.integer(0x3FE0000000000000)}"))


def _exponent(o: Vectors, _: None, a: str) -> str:
    high = o.let(f"lshr {o.I} {o.as_integers(a)}, {o.integer(52)}")
    biased = o.whole(o.let(f"and {o.I} {high}, {o.integer(0x7FF)}"))
    return operation(o, "sub", biased, o.number(1022.0))


def _power_of_two(o: Vectors, _: None, a: str) -> str:
    biased = o.as_integers(operation(o, "add", a, o.number(6755399441055744.0 + 1023.0)))
    return o.as_doubles(o.let(f"shl {o.I} {biased}, {o.integer(52)}"))


def _pick(o: Vectors, _: None, index: str, *rows: str) -> str:
    """By comparing the index with each row's number."""
    chosen = rows[0]
    for j in range(1, len(rows)):
        chosen = operation(o, "select", operation(o, "le", o.number(float(j)), index), rows[j], chosen)
    return chosen


ARITHMETIC: dict[str, str | Callable[..., Any]] = {
    "add": "fadd {V} {0}, {1}",
    "sub": "fsub {V} {0}, {1}",
    "mul": "fmul {V} {0}, {1}",
    "div": "fdiv {V} {0}, {1}",
    "neg": "fneg {V} {0}",
    "abs": "call {V} @llvm.fabs.v{W}f64({V} {0})",
    "sqrt": "call {V} @llvm.sqrt.v{W}f64({V} {0})",
    "floor": _floor,
    "rint": _rint,
    "min": lambda o, _, a, b: _extreme(o, "olt", a, b),
    "max": lambda o, _, a, b: _extreme(o, "ogt", a, b),
    "lt": "fcmp olt {V} {0}, {1}",
    "le": "fcmp ole {V} {0}, {1}",
    "eq": "fcmp oeq {V} {0}, {1}",
    "ne": "fcmp une {V} {0}, {1}",
    "and": "and {M} {0}, {1}",
    "or": "or {M} {0}, {1}",
    "not": lambda o, _, a: o.let(f"xor {o.M} {a}, {o.flag(value=True)}"),
    "select": "select {M} {0}, {V} {1}, {V} {2}",
    "number": lambda o, _, a: o.let(f"select {o.M} {a}, {o.V} {o.number(1.0)}, {o.V} zeroinitializer"),
    "fraction": _fraction,
    "exponent": _exponent,
    "power_of_two": _power_of_two,
    "pick": _pick,
}
"""Template, or function (writer, value of the instruction, names of the arguments) -> name of the result."""
