"""NumPy's element-wise functions in terms of the operation set."""

from collections.abc import Callable
from typing import Any

import numpy as np

from fddbench.blocks.trouble import trouble

__all__ = ["apply"]

_PLAIN = {
    np.add: "add", np.subtract: "sub", np.multiply: "mul", np.true_divide: "div", np.negative: "neg",
    np.absolute: "abs", np.fabs: "abs", np.sqrt: "sqrt", np.minimum: "min", np.maximum: "max", np.floor: "floor",
    np.rint: "rint", np.less: "lt", np.less_equal: "le", np.equal: "eq", np.not_equal: "ne",
    np.logical_and: "and", np.logical_or: "or", np.logical_not: "not",
    np.bitwise_and: "and", np.bitwise_or: "or", np.invert: "not",
}  # fmt: skip

_OF_BOOLEANS = {np.add: "or", np.multiply: "and", np.minimum: "and", np.maximum: "or"}

_DERIVED: dict[Any, Callable[..., Any]] = {
    np.greater: lambda a, b: np.less(b, a),
    np.greater_equal: lambda a, b: np.less_equal(b, a),
    np.positive: lambda a: a * 1.0,
    np.square: lambda a: a * a,
    np.reciprocal: lambda a: 1.0 / a,
    np.ceil: lambda a: -np.floor(-a),
    np.trunc: lambda a: np.where(a < 0.0, -np.floor(-a), np.floor(a)),
    np.sign: lambda a: np.where(a > 0.0, 1.0, np.where(a < 0.0, -1.0, np.where(a == 0.0, 0.0, a))),
    np.deg2rad: lambda a: a * (np.pi / 180.0),
    np.radians: lambda a: a * (np.pi / 180.0),
    np.rad2deg: lambda a: a * (180.0 / np.pi),
    np.degrees: lambda a: a * (180.0 / np.pi),
    np.isnan: lambda a: a != a,
    np.isinf: lambda a: np.abs(a) == np.inf,
    np.isfinite: lambda a: np.abs(a) < np.inf,
    np.clip: lambda a, low, high: np.minimum(np.maximum(a, low), high),
    np.logical_xor: lambda a, b: (a & ~b) | (~a & b),
    np.bitwise_xor: lambda a, b: (a & ~b) | (~a & b),
}

_POWERS: dict[float, Callable[[Any], Any]] = {
    -1.0: lambda a: 1.0 / a,
    0.0: lambda a: a * 0.0 + 1.0,
    0.5: np.sqrt,
    1.0: lambda a: a * 1.0,
    2.0: lambda a: a * a,
}
"""Those that NumPy computes exactly too."""

_OWN = "use {} of fddbench.blocks.functions: the same bits on every machine"
_CURES = {
    **{getattr(np, name): _OWN.format(name) for name in ("sin", "cos", "exp", "log")},
    np.power: "multiply, or use pow_ of fddbench.blocks.functions with a constant exponent",
    np.tan: "use sin(x) / cos(x) of fddbench.blocks.functions",
    np.arcsin: _OWN.format("asin"),
    np.arctan2: _OWN.format("atan2"),
    np.arctan: "use atan2(x, 1.0) of fddbench.blocks.functions",
    np.hypot: "use np.sqrt(a * a + b * b)",
    np.floor_divide: "use np.floor(a / b)",
    np.remainder: "use a - b * np.floor(a / b)",
    np.fmod: "use a - b * np.floor(a / b)",
    np.tanh: "use exp of fddbench.blocks.functions",
}


def apply(ufunc: np.ufunc, traced: Any, inputs: tuple[Any, ...]) -> Any:
    """Result of ``ufunc(*inputs)`` as a traced value.

    Parameters
    ----------
    traced : Traced
        Any of the inputs that is one.
    """
    lifted = [traced.lift(value) for value in inputs] if ufunc is not np.power else list(inputs[:1])
    if ufunc in _OF_BOOLEANS and all(value.boolean for value in lifted):
        return traced.apply(_OF_BOOLEANS[ufunc], tuple(lifted))
    if ufunc in _PLAIN:
        if ufunc.__name__.startswith("logical"):
            lifted = [value.condition() for value in lifted]
        return traced.apply(_PLAIN[ufunc], tuple(lifted))
    if ufunc is np.power:
        return _power(*inputs)
    if ufunc is np.matmul:
        return _matmul(*lifted)
    if ufunc not in _DERIVED:
        trouble(
            f"np.{ufunc.__name__} is not in the operation set", _CURES.get(ufunc, "write it with + - * / and np.where")
        )
    return _DERIVED[ufunc](*lifted)


def _power(base: Any, power: Any) -> Any:
    """Power by a constant that is exact, else an error."""
    if isinstance(power, int | float) and float(power) in _POWERS:
        return _POWERS[float(power)](base)
    return trouble(f"power {power!r} is not exact", _CURES[np.power])


def _matmul(a: Any, b: Any) -> Any:
    """Matrix product of two 2-D values, each element summed left to right."""
    if a.ndim != 2 or b.ndim != 2:
        trouble(
            f"@ of shapes {a.shape} and {b.shape}",
            "keep the case axis: (n, m) @ (m, n_cases), or blocks.linear.product",
        )
    rows: Any = a[:, 0][:, np.newaxis] * b[0]
    for j in range(1, a.shape[1]):
        rows = rows + a[:, j][:, np.newaxis] * b[j]
    return rows
