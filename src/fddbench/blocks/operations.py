"""The operation set in one table: what a step may be made of, with meaning, cost and C expression.

Values are float64 or boolean; integers live inside Philox only. Every primitive is exact or correctly rounded by
IEEE 754, so NumPy, LLVM at any width and C give the same bits. Only what a not-a-number carries in its payload is open.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.blocks.primitives import exponent, fraction, gather, locate, pick, power_of_two, rarely

__all__ = ["OPERATIONS", "Operation"]


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
    "power_of_two": Operation("two to the whole power a", 1, 2, "fdd_power_of_two({0})", power_of_two, "f"),
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
