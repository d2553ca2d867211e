"""Constant arrays in memory and the two primitives that read them: where a number lies, and what stands at a place."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b

import numpy as np
import numpy.typing as npt

__all__ = ["Table"]


@dataclass(frozen=True)
class Table:
    """Constant array of float64, equal to another one with the same bits.

    Examples
    --------
    >>> Table.of([0.0, 0.5]) == Table.of(np.array([0.0, 0.5])), len(Table.of([1.0, 2.0, 3.0]))
    (True, 3)
    """

    data: bytes

    @classmethod
    def of(cls, values: npt.ArrayLike | Iterable[float]) -> "Table":
        """Table of some numbers, in C order."""
        return cls(np.ascontiguousarray(values, dtype=np.float64).tobytes())

    @cached_property
    def values(self) -> npt.NDArray[np.float64]:
        """The numbers, (n,), not to be written to."""
        return np.frombuffer(self.data, dtype=np.float64)

    def __len__(self) -> int:
        return len(self.data) // 8

    def __repr__(self) -> str:
        return f"Table({len(self)} numbers, {blake2b(self.data, digest_size=16).hexdigest()})"
