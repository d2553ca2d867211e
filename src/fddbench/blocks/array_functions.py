"""NumPy's array functions for traced values: building, reshaping and reducing in a fixed order."""

from collections.abc import Callable
from functools import reduce
from typing import Any

import numpy as np

from fddbench.blocks.trouble import trouble

__all__ = ["CURES", "HANDLERS", "REDUCTIONS", "definition", "reduce_axis"]


def definition(name: str) -> Callable[..., Any]:
    """The NumPy code of a named function: what its node means."""
    from fddbench.blocks import functions

    return vars(functions).get(name, vars(functions).get(name + "_")).__wrapped__  # type: ignore[no-any-return,union-attr]


def _same_kind(t: Any, values: Any) -> list[Any]:
    """All lifted, and numbers unless all are true or false."""
    lifted = [t.lift(value) for value in values]
    return lifted if all(value.boolean for value in lifted) else [value.number() for value in lifted]


def _where(t: Any, condition: Any, *choices: Any) -> Any:
    if len(choices) != 2:
        trouble("np.where with one argument has a shape that depends on data", "use np.where(condition, a, b)")
    a, b = _same_kind(t, choices)
    c = t.lift(condition).condition()
    if a.boolean:
        return (c & a) | (~c & b)
    return t.apply("select", (c, a, b))


def _several(function: Callable[..., Any]) -> Callable[..., Any]:
    """Handler of a function that joins a sequence of arrays."""

    def handler(t: Any, arrays: Any, *args: Any, **kwargs: Any) -> Any:
        lifted = _same_kind(t, arrays)
        return t.like(function([value.ids for value in lifted], *args, **kwargs), boolean=lifted[0].boolean)

    return handler


def _shaping(function: Callable[..., Any]) -> Callable[..., Any]:
    """Handler of a function that rearranges one array."""

    def handler(t: Any, array: Any, *args: Any, **kwargs: Any) -> Any:
        kwargs.pop("subok", None)
        value = t.lift(array)
        return t.like(function(value.ids, *args, **kwargs), boolean=value.boolean)

    return handler


def _filled(value: float) -> Callable[..., Any]:
    """Handler of zeros_like and its kin."""

    def handler(t: Any, array: Any, dtype: Any = None, **kwargs: Any) -> Any:
        return _full_like(t, array, value, dtype=dtype, **kwargs)

    return handler


def _full_like(t: Any, array: Any, fill_value: Any, dtype: Any = None, shape: Any = None, **_: Any) -> Any:
    boolean = array.boolean if dtype is None else np.dtype(dtype).kind == "b"
    fill = t.lift(fill_value)
    fill = fill.condition() if boolean else fill.number()
    return t.like(np.broadcast_to(fill.ids, array.shape if shape is None else shape).copy(), boolean=boolean)


def reduce_axis(value: Any, operator: Callable[[Any, Any], Any], axis: Any, *, keepdims: bool) -> Any:
    """Rows along an axis combined left to right; all elements when the axis is None."""
    flat = value.ravel() if axis is None else value.like(np.moveaxis(value.ids, axis, 0))
    result = reduce(operator, list(flat))
    if not keepdims:
        return result
    return result.reshape((1,) * value.ndim) if axis is None else result.like(np.expand_dims(result.ids, axis))


def _reduction(ufunc: np.ufunc) -> Callable[..., Any]:
    def handler(t: Any, array: Any, axis: Any = None, out: None = None, keepdims: bool = False, **_: Any) -> Any:  # noqa: ARG001
        value = t.lift(array)
        if ufunc is np.add:
            value = value.number()
        if ufunc in {np.logical_and, np.logical_or}:
            value = value.condition()
        return reduce_axis(value, REDUCTIONS[ufunc], axis, keepdims=keepdims)

    return handler


def _dot(t: Any, a: Any, b: Any) -> Any:
    return np.matmul(t.lift(a), t.lift(b))


def _clip(t: Any, array: Any, *limits: Any, min: Any = None, max: Any = None, **named: Any) -> Any:  # noqa: A002
    low, high = limits if limits else (named.get("a_min", min), named.get("a_max", max))
    value = t.lift(array) if low is None else np.maximum(array, low)
    return value if high is None else np.minimum(value, high)


def _diff(t: Any, array: Any, n: int = 1, axis: int = -1) -> Any:
    value = t.like(np.moveaxis(array.ids, axis, 0))
    for _ in range(n):
        value = value[1:] - value[:-1]
    return value.like(np.moveaxis(value.ids, 0, axis))


def _median(t: Any, array: Any, axis: Any = None, **_: Any) -> Any:
    rows = _sorted_rows(t, array, axis)
    middle = len(rows) // 2
    return rows[middle] if len(rows) % 2 else (rows[middle - 1] + rows[middle]) * 0.5


def _sort(t: Any, array: Any, axis: Any = -1, **_: Any) -> Any:
    rows = np.stack(_sorted_rows(t, array, axis))
    return t.like(np.moveaxis(rows.ids, 0, axis))  # type: ignore[attr-defined]


def _sorted_rows(t: Any, array: Any, axis: Any) -> list[Any]:
    """Rows along an axis in rising order, by exchanging neighbours."""
    value = t.lift(array).number()
    rows = list(value.ravel() if axis is None else value.like(np.moveaxis(value.ids, axis, 0)))
    for last in range(len(rows) - 1, 0, -1):
        for j in range(last):
            rows[j], rows[j + 1] = np.minimum(rows[j], rows[j + 1]), np.maximum(rows[j], rows[j + 1])
    return rows


REDUCTIONS: dict[np.ufunc, Callable[[Any, Any], Any]] = {
    np.add: lambda a, b: a + b,
    np.multiply: lambda a, b: a * b,
    np.minimum: np.minimum,
    np.maximum: np.maximum,
    np.logical_and: lambda a, b: a & b,
    np.logical_or: lambda a, b: a | b,
}

HANDLERS: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    **{f: _several(f) for f in (np.concatenate, np.stack, np.vstack, np.hstack, np.column_stack)},
    **{
        f: _shaping(f)
        for f in (np.reshape, np.ravel, np.transpose, np.squeeze, np.expand_dims, np.broadcast_to, np.copy, np.roll,
                  np.flip, np.repeat, np.tile, np.take, np.moveaxis, np.swapaxes, np.atleast_1d, np.atleast_2d)
    },
    np.broadcast_arrays: lambda t, *arrays, **_: [
        t.like(ids, boolean=value.boolean)
        for value, ids in zip(map(t.lift, arrays), np.broadcast_arrays(*(t.lift(a).ids for a in arrays)), strict=True)
    ],
    np.zeros_like: _filled(0.0),
    np.empty_like: _filled(0.0),
    np.ones_like: _filled(1.0),
    np.full_like: _full_like,
    np.shape: lambda _, array: array.shape,
    np.ndim: lambda _, array: array.ndim,
    np.size: lambda _, array: array.size,
    np.clip: _clip,
    np.dot: _dot,
    np.diff: _diff,
    np.sum: _reduction(np.add),
    np.prod: _reduction(np.multiply),
    np.min: _reduction(np.minimum),
    np.max: _reduction(np.maximum),
    np.any: _reduction(np.logical_or),
    np.all: _reduction(np.logical_and),
    np.median: _median,
    np.sort: _sort,
}  # fmt: skip

CURES: dict[Any, str] = {
    np.interp: "use fddbench.blocks.functions.interpolate",
    np.nonzero: "its shape depends on data: use np.where(condition, a, b)",
    np.flatnonzero: "its shape depends on data: use np.where(condition, a, b)",
    np.argmax: "compare the rows with np.where",
    np.argmin: "compare the rows with np.where",
    np.mean: "use np.sum and divide",
    np.cumsum: "add the rows one by one",
    np.einsum: "use fddbench.blocks.linear.product",
    np.linalg.norm: "use np.sqrt of a sum of squares",
}
