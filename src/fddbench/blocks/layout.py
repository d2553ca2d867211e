"""Named rows of one flat float64 array: how states, constants and signals are laid out."""

from types import SimpleNamespace
from typing import Any

import numpy as np

__all__ = ["Layout", "Rows"]

Rows = Any
"""Rows of numbers, (n_rows, n_cases): a float64 array when flown, traced values when compiled."""


class Layout:
    """Names for the rows of an (n_rows, n_cases) array.

    Parameters
    ----------
    fields : int
        Rows of each field; 0 makes a single signal, seen as (n_cases,) instead of (1, n_cases).

    Examples
    --------
    >>> layout = Layout(phi_rad=0, surface_deg=2)
    >>> layout.size
    3
    >>> named = layout.unpack(np.array([[1.0], [2.0], [3.0]]))
    >>> named.phi_rad, named.surface_deg.shape
    (array([1.]), (2, 1))
    >>> layout.pack(phi_rad=named.phi_rad, surface_deg=named.surface_deg).ravel()
    array([1., 2., 3.])
    """

    def __init__(self, **fields: int) -> None:
        self.fields = dict(fields)
        self.index: dict[str, int | slice] = {}
        self.size = 0
        for name, rows in fields.items():
            self.index[name] = slice(self.size, self.size + rows) if rows else self.size
            self.size += max(rows, 1)

    @property
    def names(self) -> tuple[str, ...]:
        """One name a row; a field of several rows is numbered from 1."""
        return tuple(
            f"{name}_{row + 1}" if rows else name for name, rows in self.fields.items() for row in range(max(rows, 1))
        )

    def unpack(self, rows: Rows) -> SimpleNamespace:
        """Views of the fields by name: (n_cases,) or (n, n_cases)."""
        return SimpleNamespace(**{name: rows[where] for name, where in self.index.items()})

    def pack(self, **values: Rows) -> Rows:
        """One (n_rows, n_cases) array of all the fields, in the declared order.

        Raises
        ------
        TypeError
            A field is missing or unknown: a state that is forgotten would silently stand still.
        """
        if values.keys() != self.fields.keys():
            missing, unknown = self.fields.keys() - values.keys(), values.keys() - self.fields.keys()
            raise TypeError(f"need exactly the fields {list(self.fields)}, {missing=}, {unknown=}")
        return np.concatenate(
            [values[name] if rows else values[name][np.newaxis] for name, rows in self.fields.items()]
        )

    def zeros(self, n_cases: int) -> np.ndarray:
        """State at rest, (n_rows, n_cases)."""
        return np.zeros((self.size, n_cases))
