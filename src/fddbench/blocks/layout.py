"""Typed records of numbers, and where their leaves lie in one flat array: how states, constants and signals are laid out.

A record is a frozen dataclass made by keyword, so that a type checker refuses a misspelt or forgotten field. Its *shape* is
an instance of the same class that holds row counts, so sizes may depend on the instance. Records nest, in fields and in
tuples. Only the border to the kernel packs them into one array; steps see fields.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import Any, Generic, TypeVar, dataclass_transform

import numpy as np

__all__ = ["ROW", "Layout", "Nothing", "Row", "Rows", "filled", "leaves", "mapped", "record"]

T = TypeVar("T")

Row = Any
"""A row of numbers, (n_cases,): a float64 array when flown, a traced value when compiled."""
Rows = Any
"""Rows of numbers, (n_rows, n_cases)."""

ROW = 0
"""Shape of a single row, seen as (n_cases,) instead of (1, n_cases)."""


@dataclass_transform(kw_only_default=True, frozen_default=True)
def record(cls: type[T]) -> type[T]:
    """Make a class a record: a frozen dataclass whose fields are given by keyword.

    >>> @record
    ... class Filter:
    ...     level: Row
    >>> Layout(Filter(level=ROW)).size
    1
    """
    made = dataclass(frozen=True, slots=True, kw_only=True)(cls)
    made.is_record = True  # type: ignore[attr-defined]  # any other dataclass is a leaf
    return made


@record
class Nothing:
    """No state, no constants or no draws."""


def _parts(nest: Any) -> dict[str, Any] | None:
    """Named parts of a record or tuple; None for a leaf."""
    if isinstance(nest, tuple):
        return {str(j): part for j, part in enumerate(nest)}
    if getattr(nest, "is_record", False) and not isinstance(nest, type):
        return {field.name: getattr(nest, field.name) for field in fields(nest)}
    return None


def leaves(nest: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Path (``faults.slots.0.held``) and value of every leaf, in declared order."""
    parts = _parts(nest)
    if parts is None:
        yield path, nest
        return
    for name, part in parts.items():
        yield from leaves(part, f"{path}.{name}" if path else name)


def filled(nest: T, values: Iterator[Any]) -> T:
    """The same nest with other leaves, taken in order."""
    parts = _parts(nest)
    if parts is None:
        return next(values)  # type: ignore[no-any-return]
    made = {name: filled(part, values) for name, part in parts.items()}
    return tuple(made.values()) if isinstance(nest, tuple) else type(nest)(**made)  # type: ignore[return-value]


def mapped(function: Callable[..., Any], nest: T, *others: T) -> T:
    """The same nest with every leaf (and the leaves of others of its shape) passed through a function.

    >>> mapped(max, (1, 5), (4, 2))
    (4, 5)
    """
    columns = zip(*(leaves(each) for each in (nest, *others)), strict=True)
    return filled(nest, (function(*(value for _, value in column)) for column in columns))


class Layout(Generic[T]):
    """Where the leaves of a record lie in one (n_rows, n_cases) array.

    Parameters
    ----------
    shape : record
        An instance of the record that holds row counts; `ROW` makes a single row, seen as (n_cases,).

    Examples
    --------
    >>> @record
    ... class Aircraft:
    ...     phi_rad: Row
    ...     surface_deg: Rows
    >>> layout = Layout(Aircraft(phi_rad=ROW, surface_deg=2))
    >>> layout.size, layout.names
    (3, ('phi_rad', 'surface_deg_1', 'surface_deg_2'))
    >>> x = layout.unpack(np.array([[1.0], [2.0], [3.0]]))
    >>> x.phi_rad, x.surface_deg.shape
    (array([1.]), (2, 1))
    >>> layout.pack(x).ravel()
    array([1., 2., 3.])
    >>> layout.pack(Aircraft(phi_rad=0.0, surface_deg=1.5), n_cases=2).tolist()
    [[0.0, 0.0], [1.5, 1.5], [1.5, 1.5]]
    """

    def __init__(self, shape: T) -> None:
        self.shape = shape
        self.counts: dict[str, int] = dict(leaves(shape))
        self.places: dict[str, int | slice] = {}
        self.size = 0
        for path, rows in self.counts.items():
            self.places[path] = slice(self.size, self.size + rows) if rows else self.size
            self.size += rows or 1

    @property
    def names(self) -> tuple[str, ...]:
        """One name a row; a leaf of several rows is numbered from 1."""
        return tuple(
            f"{path}_{row + 1}" if rows else path for path, rows in self.counts.items() for row in range(rows or 1)
        )

    def unpack(self, rows: Rows) -> T:
        """Record of views, (n_cases,) or (n, n_cases) each."""
        return filled(self.shape, (rows[place] for place in self.places.values()))

    def pack(self, values: T, n_cases: int = 1) -> Rows:
        """One (n_rows, n_cases) array of all leaves in declared order; plain numbers are spread over `n_cases`.

        Raises
        ------
        TypeError
            Another record, or a leaf of another shape: a state that is forgotten would silently stand still.
        """
        parts = [
            _rows(path, rows, value, n_cases)
            for (path, rows), value in zip(self.counts.items(), self._values(values), strict=True)
        ]
        return np.concatenate(parts) if parts else np.zeros((0, n_cases))

    def check(self, values: T, n_cases: int) -> None:
        """Refuse values that `pack` would refuse, or whose rows are not (n_cases,) or (n, n_cases); cheaper than packing.

        Raises
        ------
        TypeError
            As `pack`.
        """
        for (path, rows), value in zip(self.counts.items(), self._values(values), strict=True):
            if np.shape(value) != ((rows, n_cases) if rows else (n_cases,)):
                raise TypeError(_wrong(path, rows, np.shape(value)))

    def spread(self, values: T, n_cases: int) -> T:
        """The same record with every leaf as an array of its own shape, (n_cases,) or (n, n_cases), numbers repeated."""
        shapes = ((rows, n_cases) if rows else (n_cases,) for rows in self.counts.values())
        found = zip(self._values(values), shapes, strict=True)
        return filled(self.shape, (np.broadcast_to(value, shape) for value, shape in found))

    def ordered(self, values: T) -> T:
        """The same leaves in declared order: another record may have them in another.

        Raises
        ------
        TypeError
            It has not these leaves.
        """
        return filled(self.shape, iter(self._values(values)))

    def _values(self, values: T) -> list[Any]:
        """Leaves in declared order, found by their paths: another record may have the same ones in another order."""
        given = dict(leaves(values))
        if given.keys() != self.counts.keys():
            if "" in given:
                raise TypeError(f"need a record of the fields {list(self.counts)}, got {type(values).__name__}")
            # lists, not sets: the text becomes part of a row, which is the same every time
            missing, unknown = [p for p in self.counts if p not in given], [p for p in given if p not in self.counts]
            raise TypeError(f"need exactly the fields {list(self.counts)}, {missing=}, {unknown=}")
        return [given[path] for path in self.counts]


def _wrong(path: str, rows: int, shape: tuple[int, ...]) -> str:
    return f"{path or 'it'} needs the shape {f'({rows}, n_cases)' if rows else '(n_cases,)'}, got {shape}"


def _rows(path: str, rows: int, value: Any, n_cases: int) -> Rows:
    """One leaf as (n, n_cases) rows."""
    if isinstance(value, float | int):
        return np.full((rows or 1, n_cases), float(value))
    shape = np.shape(value)
    if len(shape) != (2 if rows else 1) or (rows and shape[0] != rows):
        raise TypeError(_wrong(path, rows, shape))
    return value if rows else value[np.newaxis]
