"""Matrices that depend affinely on scheduling parameters, as published models give them."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product as every

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import affine
from fddbench.systems.errors import MisfitError
from fddbench.systems.shapes import Matrix

__all__ = ["AffineLpv"]


@dataclass(frozen=True, eq=False, kw_only=True)
class AffineLpv:
    """``M(rho) = M_0 + M_1 rho_1 + ... + M_n rho_n`` for every named table M, with ``rho = (value - trim) / scale``.

    Attributes
    ----------
    tables : mapping of str to (n + 1, rows, columns, 1) array
        Matrices by name, constant part first.
    names : tuple of str
        The n scheduling parameters in the order of rho, with their units (``mass_kg``).
    trim, scale : (n, 1) arrays
        Centre and half width of the box in the parameters' units; inside it ``|rho| <= 1``.

    Examples
    --------
    >>> spring = AffineLpv(tables={"A": np.array([[[[-1.0]]], [[[-0.5]]]])}, names=("stiffness_n_m",),
    ...                    trim=np.array([[20.0]]), scale=np.array([[10.0]]))
    >>> spring.matrix("A", spring.rho(stiffness_n_m=np.array([30.0]))).ravel()
    array([-1.5])
    """

    tables: Mapping[str, Matrix]
    names: tuple[str, ...]
    trim: Matrix
    scale: Matrix

    def __post_init__(self) -> None:
        """Refuse tables of another number of parameters, and boxes without a width."""
        n = len(self.names)
        mistakes = [
            f"table {name} has shape {table.shape}, need ({n + 1}, rows, columns, 1): a constant part and one per parameter"
            for name, table in self.tables.items()
            if table.ndim != 4 or len(table) != n + 1 or table.shape[3] != 1
        ]
        mistakes += [
            f"{name} has shape {getattr(self, name).shape}, need ({n}, 1): one row per parameter"
            for name in ("trim", "scale")
            if getattr(self, name).shape != (n, 1)
        ]
        if not mistakes and np.any(self.scale == 0.0):
            mistakes.append(f"scale is {self.scale.ravel().tolist()}: no parameter may have a box without a width")
        if len(set(self.names)) < n:
            mistakes.append(f"parameters {self.names}: a name stands twice")
        if mistakes:
            raise MisfitError(f"AffineLpv of {', '.join(self.names)}:\n  " + "\n  ".join(mistakes))

    def rho(self, *values: Rows, **named: Rows) -> Rows:
        """Scheduling parameters [-], (n, n_cases), deliberately not clipped to the box.

        Parameters
        ----------
        *values : (n_cases,) rows
            In the order of `names`, in their units; or all by name.
        **named : (n_cases,) rows
            By name, in any order.

        Raises
        ------
        MisfitError
            A parameter is missing, unknown or given twice.
        """
        given = dict(zip(self.names, values, strict=False))
        twice, unknown = given.keys() & named.keys(), named.keys() - set(self.names)
        missing = [name for name in self.names if name not in given and name not in named]
        if twice or unknown or missing or len(values) > len(self.names):
            raise MisfitError(
                f"rho needs each of {', '.join(self.names)} once, got {len(values)} values in order and "
                f"{', '.join(named) or 'none'} by name"
            )
        given |= named
        rho: Rows = (np.stack([given[name] for name in self.names]) - self.trim) / self.scale
        return rho

    def values(self, rho: Rows) -> Rows:
        """Parameters in their units, (n, n_cases), of rho, (n, n_cases)."""
        return self.trim + self.scale * rho

    def matrix(self, name: str, rho: Rows) -> Rows:
        """One table at `rho`, (rows, columns, n_cases), summed in the order of the parameters."""
        return affine(self.tables[name], rho)

    def matrices(self, rho: Rows) -> tuple[Rows, ...]:
        """All tables at `rho`, (rows, columns, n_cases) each, in their order."""
        return tuple(affine(table, rho) for table in self.tables.values())

    def vertices(self) -> Matrix:
        """Corners of the box, (n, 2**n): rho = ±1, the last parameter changing fastest."""
        n = len(self.names)
        corners = np.array(list(every((-1.0, 1.0), repeat=n)), dtype=float)
        return np.ascontiguousarray(corners.reshape(2**n, n).T)
