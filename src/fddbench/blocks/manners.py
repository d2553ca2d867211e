"""Manners of a traced value: methods that arrays have, and what it refuses to be, each with its cure."""

from typing import Any

import numpy as np

from fddbench.blocks.trouble import trouble

__all__ = ["Manners", "static"]

_IF = "use np.where(condition, a, b), np.minimum or np.maximum: every flight takes every step together"


class Manners:
    """Methods in terms of NumPy's functions, and refusals of what would look at numbers that are not there yet."""

    boolean: bool

    def sum(self, axis: Any = None, **options: Any) -> Any:
        """Sum left to right; of true and false, how many are true."""
        return np.sum(self, axis=axis, **options)

    def max(self, axis: Any = None, **options: Any) -> Any:
        """Largest."""
        return np.max(self, axis=axis, **options)

    def min(self, axis: Any = None, **options: Any) -> Any:
        """Smallest."""
        return np.min(self, axis=axis, **options)

    def any(self, axis: Any = None, **options: Any) -> Any:
        """Whether one is true."""
        return np.any(self, axis=axis, **options)

    def all(self, axis: Any = None, **options: Any) -> Any:
        """Whether all are true."""
        return np.all(self, axis=axis, **options)

    def clip(self, low: Any, high: Any) -> Any:
        """Between two limits."""
        return np.minimum(np.maximum(self, low), high)

    def __bool__(self) -> bool:  # noqa: PLE0304  (never returns)
        trouble("an `if`, `and`, `or`, `not` or `while` depends on a traced value", _IF)

    def __float__(self) -> float:
        trouble("a traced value was turned into a Python number or written into a plain array",
                "use functions of fddbench.blocks.functions, and np.stack or np.concatenate")  # fmt: skip

    def __int__(self) -> int:
        trouble("a traced value was turned into a Python integer", "use np.floor or np.rint and stay with floats")

    def __index__(self) -> int:  # noqa: PLE0305  (never returns)
        trouble("a traced value is used as an index", "use blocks.functions.interpolate or np.where over the rows")

    def __array__(self, *_: Any, **__: Any) -> Any:
        trouble(
            "a traced value is written into a plain array, used as an index of one, or given to a function that wants "
            "its numbers",
            "build arrays with np.stack or np.concatenate, look up with blocks.functions.interpolate, choose with np.where",
        )


def static(key: Any) -> Any:
    """The index itself, unless it depends on data."""
    for part in key if isinstance(key, tuple) else (key,):
        if isinstance(part, Manners):
            cure = "use np.where(condition, a, b)" if part.boolean else "use blocks.functions.interpolate or np.where"
            trouble("an index depends on a traced value, so its shape or place depends on data", cure)
    return key
