"""The operation set in one table: what a step may be made of, with meaning, cost and C expression.

Values are float64 or boolean; integers live inside Philox only. Every primitive is exact or correctly rounded by
IEEE 754, so NumPy, LLVM at any width and C give the same bits. Only what a not-a-number carries in its payload is open.
"""

import inspect
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.table import Table

__all__ = [
    "OPERATIONS", "Operation", "Symbolic", "exponent", "fraction", "gather", "locate", "named", "pick", "power_of_two",
    "rarely",
]  # fmt: skip

P = ParamSpec("P")
R = TypeVar("R")

_EXPONENT_OF_HALF, _NO_EXPONENT = np.int64(0x3FE0000000000000), np.int64(-0x7FF0000000000001)
_MAGIC = 6755399441055744.0  # 1.5 * 2^52: adding it leaves an integer in the low bits
_BIASED_MAGIC = _MAGIC + 1023.0


class Symbolic:
    """A value being traced; see `fddbench.blocks.traced`. Named blocks hand themselves over to it."""

    def apply(self, name: str, arguments: tuple[Any, ...], value: Hashable = None) -> Any:
        """Value of the operation called `name`, element by element; `value` is what it needs beside its arguments."""
        raise NotImplementedError


def named(function: Callable[P, R]) -> Callable[P, R]:
    """Make a function of numbers one node of a traced program, called as the function without a final underscore."""
    name = function.__name__.rstrip("_")
    signature = inspect.signature(function)

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        for argument in (*args, *kwargs.values()):
            if isinstance(argument, Symbolic):
                return argument.apply(name, signature.bind(*args, **kwargs).args)  # type: ignore[no-any-return]
        return function(*args, **kwargs)

    return call


@named
def fraction(x: Rows) -> Rows:
    """Significand of a normal number with its sign, 0.5 <= |fraction| < 1; its own answer for 0, inf and nan.

    >>> float(fraction(np.float64(-24.0)))
    -0.75
    """
    bits = np.asarray(x, dtype=float).view(np.int64)
    return ((bits & _NO_EXPONENT) | _EXPONENT_OF_HALF).view(np.float64)


@named
def exponent(x: Rows) -> Rows:
    """Power of two that belongs to the `fraction` of a normal number.

    >>> float(exponent(np.float64(-24.0)))
    5.0
    """
    bits = np.asarray(x, dtype=float).view(np.int64)
    return ((bits >> 52) & 0x7FF).astype(float) - 1022.0


@named
def power_of_two(k: Rows) -> Rows:
    """Two to a whole power between -1022 and 1023.

    >>> float(power_of_two(np.float64(-3.0)))
    0.125
    """
    return ((np.asarray(k, dtype=float) + _BIASED_MAGIC).view(np.int64) << 52).view(np.float64)


@named
def pick(index: Rows, *rows: Rows) -> Rows:
    """Row number `index` of the rows, each case its own; the first or last outside.

    >>> pick(np.array([1.0, 0.0]), np.array([10.0, 11.0]), np.array([20.0, 21.0]))
    array([20., 11.])
    """
    chosen = rows[0]
    for j in range(1, len(rows)):
        chosen = np.where(index >= float(j), rows[j], chosen)
    return chosen


@named
def rarely(condition: Rows) -> Rows:
    """The condition itself, which is said to be seldom true, as that a fault is there.

    Compiled, what only ``np.where(rarely(condition), a, b)`` needs for its ``a`` is left out in every sample in which no
    such condition is true in any of the cases that fly side by side. The result is the same; the saying is about speed.
    """
    return condition


def locate(knots: Table, x: Rows) -> Rows:
    """How many of the rising knots lie at or below x, (n_cases,); none for a not-a-number.

    >>> locate(Table.of([0.0, 1.0, 5.0]), np.array([-1.0, 1.0, 9.0, np.nan]))
    array([0., 2., 3., 0.])
    """
    if isinstance(x, Symbolic):
        return x.apply("locate", (x,), knots)
    x = np.asarray(x, dtype=float)
    return np.where(np.isnan(x), 0.0, np.searchsorted(knots.values, x, side="right"))


def gather(table: Table, place: Rows) -> Rows:
    """Entry of a table at a place, (n_cases,): the first or last one outside, the first one for a not-a-number.

    >>> gather(Table.of([10.0, 11.0, 12.0]), np.array([1.0, -3.0, 7.0, np.nan]))
    array([11., 10., 12., 10.])
    """
    if isinstance(place, Symbolic):
        return place.apply("gather", (place,), table)
    place = np.asarray(place, dtype=float)
    inside = np.where(place > 0.0, np.minimum(place, float(len(table) - 1)), 0.0)
    return table.values[inside.astype(np.int64)]


@dataclass(frozen=True)
class Operation:
    """One line of the table.

    Attributes
    ----------
    meaning : str
        Formula; ``a, b, c`` are the arguments.
    arity : int
        Number of arguments; -1: any.
    flops : int
        Cost in floating-point operations of a scalar processor; a composite's is counted from its definition.
    c : str
        C99 expression, ``{0}`` the first argument.
    numpy : callable or None
        The same on arrays, the value of the node first where it has one; None for leaves, for composites (those are
        functions of ``blocks.functions``) and for a repeat, which the interpreter runs itself.
    arguments, result : str
        ``f`` float64, ``b`` boolean, one letter an argument; ``r`` rows of float64, which only ``row`` takes.
    """

    meaning: str
    arity: int
    flops: int
    c: str
    numpy: Callable[..., Any] | None
    arguments: str = ""
    result: str = "f"

    @property
    def composite(self) -> bool:
        """Whether it is a function written in other operations."""
        return self.flops < 0


OPERATIONS: dict[str, Operation] = {
    "literal": Operation("a number written in the step", 0, 0, "{value}", None),
    "flag": Operation("true or false written in the step", 0, 0, "{value}", None, "", "b"),
    "input": Operation("one row of a named input", 0, 0, "{name}[{row}]", None),
    "add": Operation("a + b", 2, 1, "({0} + {1})", np.add, "ff"),
    "sub": Operation("a - b", 2, 1, "({0} - {1})", np.subtract, "ff"),
    "mul": Operation("a b", 2, 1, "({0} * {1})", np.multiply, "ff"),
    "div": Operation("a / b", 2, 1, "({0} / {1})", np.divide, "ff"),
    "neg": Operation("-a", 1, 1, "(-{0})", np.negative, "f"),
    "abs": Operation("|a|", 1, 1, "fabs({0})", np.abs, "f"),
    "sqrt": Operation("square root of a", 1, 1, "sqrt({0})", np.sqrt, "f"),
    "min": Operation("a if a < b else b; nan if either is", 2, 1, "fdd_min({0}, {1})", np.minimum, "ff"),
    "max": Operation("a if a > b else b; nan if either is", 2, 1, "fdd_max({0}, {1})", np.maximum, "ff"),
    "floor": Operation("largest whole number not above a", 1, 1, "floor({0})", np.floor, "f"),
    "rint": Operation("nearest whole number, ties to even", 1, 1, "nearbyint({0})", np.rint, "f"),
    "lt": Operation("a < b", 2, 1, "({0} < {1})", np.less, "ff", "b"),
    "le": Operation("a <= b", 2, 1, "({0} <= {1})", np.less_equal, "ff", "b"),
    "eq": Operation("a = b", 2, 1, "({0} == {1})", np.equal, "ff", "b"),
    "ne": Operation("a differs from b, or one is nan", 2, 1, "({0} != {1})", np.not_equal, "ff", "b"),
    "and": Operation("both", 2, 1, "({0} && {1})", np.logical_and, "bb", "b"),
    "or": Operation("either or both", 2, 1, "({0} || {1})", np.logical_or, "bb", "b"),
    "not": Operation("the opposite", 1, 1, "(!{0})", np.logical_not, "b", "b"),
    "select": Operation("b where a, else c", 3, 1, "({0} ? {1} : {2})", np.where, "bff"),
    "number": Operation("1 where a, else 0", 1, 1, "({0} ? 1.0 : 0.0)", lambda a: np.where(a, 1.0, 0.0), "b"),
    "rarely": Operation("a, which is seldom true", 1, 0, "{0}", rarely, "b", "b"),
    "fraction": Operation("significand of a, 0.5 .. 1", 1, 2, "fdd_fraction({0})", fraction, "f"),
    "exponent": Operation("power of two of a", 1, 3, "fdd_exponent({0})", exponent, "f"),
    "power_of_two": Operation("two to the whole power a", 1, 2, "ldexp(1.0, (int){0})", power_of_two, "f"),
    "pick": Operation("argument number a of the rest", -1, 1, "fdd_pick({0}, {rest})", pick, "f"),
    "locate": Operation(
        "how many of the rising knots lie at or below a", 1, 4, "fdd_locate({table}, {0})", locate, "f"
    ),
    "gather": Operation("entry number a of a table", 1, 1, "{table}[fdd_index({0})]", gather, "f"),
    "repeat": Operation("rows after a body has run many times", -1, 0, "{loop}({rest})", None, "", "r"),
    "row": Operation("one row of a repeat", 1, 0, "{0}[{row}]", lambda number, rows: rows[number], "r"),
    "sin": Operation("sine of a [rad]", 1, -1, "fdd_sin({0})", None, "f"),
    "cos": Operation("cosine of a [rad]", 1, -1, "fdd_cos({0})", None, "f"),
    "exp": Operation("exponential of a", 1, -1, "fdd_exp({0})", None, "f"),
    "log": Operation("natural logarithm of a", 1, -1, "fdd_log({0})", None, "f"),
    "pow": Operation("a > 0 to the power b", 2, -1, "fdd_pow({0}, {1})", None, "ff"),
    "atan2": Operation("angle of the point (b, a) [rad]", 2, -1, "fdd_atan2({0}, {1})", None, "ff"),
    "asin": Operation("arc sine of a [rad]", 1, -1, "fdd_asin({0})", None, "f"),
}
"""The whole set. Look-ups between knots that differ from case to case (``functions.interpolate``), ring buffers (``ring``)
and constant matrix products (``linear.product``, ``@``) are made of these in a fixed order and are exported as such."""
