"""Functions that are one operation each: parts of a number, choosing, looking up; and how a function becomes one."""

import inspect
from collections.abc import Callable, Hashable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.table import Table

__all__ = ["Symbolic", "exponent", "fraction", "gather", "locate", "named", "pick", "power_of_two", "rarely"]

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
    such condition is true in any of the cases that fly side by side. The result is the same; the saying is about speed. A
    state that becomes ``np.where(rarely(condition), new, old)`` is then not even read or written.
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
