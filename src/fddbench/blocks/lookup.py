"""Tables of numbers between fixed breakpoints: linear between them, held at the border, kept in constant memory.

The search along an axis is done once for all tables on it, and a table costs a few loads, whatever its size. Where breakpoints
or values differ from flight to flight, `fddbench.blocks.functions.interpolate` compares with all of them instead.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Rows
from fddbench.blocks.primitives import gather, locate
from fddbench.blocks.table import Table
from fddbench.errors import DesignError

__all__ = ["Grid", "Lookup", "Place"]


class Place(NamedTuple):
    """Where a number lies on a `Grid`.

    Attributes
    ----------
    interval : (n_cases,) rows
        Number of the interval, from 0.
    share : (n_cases,) rows
        Of the interval, 0 ... 1 [-]; not-a-number for one.
    """

    interval: Rows
    share: Rows


class Grid:
    """Breakpoints along one axis.

    Parameters
    ----------
    knots : (n,) array
        In rising order, two or more.

    Raises
    ------
    DesignError
        The breakpoints do not rise, are not finite or fewer than two.
    """

    def __init__(self, knots: npt.ArrayLike) -> None:
        x = np.asarray(knots, dtype=float)
        if x.ndim != 1 or len(x) < 2 or not np.isfinite(x).all() or not (np.diff(x) > 0.0).all():
            raise DesignError(f"breakpoints need two or more finite numbers in rising order, got {x.tolist()}")
        self.knots = x
        self._inner, self._left, self._width = Table.of(x[1:-1]), Table.of(x[:-1]), Table.of(np.diff(x))

    def __len__(self) -> int:
        return len(self.knots)

    def find(self, x: Rows) -> Place:
        """Place of x, (n_cases,), on this axis; of the nearest breakpoint outside.

        Examples
        --------
        >>> interval, share = Grid([0.0, 1.0, 3.0]).find(np.array([-5.0, 0.5, 2.0, 9.0]))
        >>> interval, share
        (array([0., 0., 1., 1.]), array([0. , 0.5, 0.5, 1. ]))
        """
        inside = np.minimum(np.maximum(x, self.knots[0]), self.knots[-1])
        interval = locate(self._inner, inside)
        return Place(interval, (inside - gather(self._left, interval)) / gather(self._width, interval))


@dataclass(frozen=True)
class Lookup:
    """Table over one or two axes; tables over the same axes are called with the same places.

    Parameters
    ----------
    values : (n,) or (n_x, n_y) array
        Values at the breakpoints.
    axes : Grid
        One an axis.

    Raises
    ------
    DesignError
        The shape of the values is not that of the axes, or there are more than two.

    Examples
    --------
    >>> alpha_deg, mach = Grid([0.0, 10.0]), Grid([0.2, 0.8])
    >>> lift = Lookup([[0.0, 0.1], [1.0, 1.3]], alpha_deg, mach)
    >>> lift(alpha_deg.find(np.array([5.0, 99.0])), mach.find(np.array([0.2, 0.5])))
    array([0.5 , 1.15])
    """

    table: Table
    axes: tuple[Grid, ...]

    def __init__(self, values: npt.ArrayLike, *axes: Grid) -> None:
        array = np.asarray(values, dtype=float)
        if array.shape != tuple(map(len, axes)) or len(axes) not in {1, 2}:
            raise DesignError(
                f"a table over axes of {list(map(len, axes))} breakpoints has values of shape {array.shape}"
            )
        object.__setattr__(self, "table", Table.of(array))
        object.__setattr__(self, "axes", axes)

    def __call__(self, *places: Place) -> Rows:
        """Value at a place of each axis, (n_cases,)."""
        if len(places) != len(self.axes):
            raise DesignError(f"a table over {len(self.axes)} axes needs as many places, got {len(places)}")
        if len(places) == 1:
            ((i, s),) = places
            return self._between(i, i + 1.0, s)
        (i, s), (j, t) = places
        n = float(len(self.axes[1]))
        place = i * n + j
        low, high = self._between(place, place + 1.0, t), self._between(place + n, place + (n + 1.0), t)
        return low + s * (high - low)

    def _between(self, left: Rows, right: Rows, share: Rows) -> Rows:
        low = gather(self.table, left)
        return low + share * (gather(self.table, right) - low)
