"""Affine families of matrices M(rho) = M_0 + rho_1 M_1 + ..., and the box of their parameters."""

import reprlib
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import qmc

from fddbench.design.geometric.subspaces import Matrix
from fddbench.errors import DesignError

__all__ = ["Box", "at", "family", "numbers"]

_MOST_CORNERS = 12
"""Parameters up to which all corners of a box are looked at."""
_SAMPLES = 1024


def family(name: str, M: ArrayLike, shape: tuple[int | None, int | None], n_parameters: int | None = None) -> Matrix:
    """A family as an (n_parameters + 1, rows, columns) array; a matrix without parameters is one of constant members.

    Parameters
    ----------
    name : str
        For messages.
    M : (rows, columns) or (n_parameters + 1, rows, columns) array, or (rows,) for a single column
    shape : two ints or None
        Rows and columns that it must have; None: any.
    n_parameters : int, optional
        None: as many as it has.
    """
    array = numbers(name, M)
    if array.ndim == 1:
        array = array[:, np.newaxis]
    if array.ndim == 2:
        array = np.concatenate([array[np.newaxis], np.zeros((n_parameters or 0, *array.shape))])
    need = (None if n_parameters is None else n_parameters + 1, *shape)
    if array.ndim != 3 or any(n is not None and n != found for n, found in zip(need, array.shape, strict=True)):
        asked = ", ".join("any" if n is None else str(n) for n in need)
        raise DesignError(
            f"{name} has shape {np.shape(M)}, needs ({asked}): the constant matrix, then one per parameter; a matrix alone "
            "does not depend on parameters"
        )
    if not np.all(np.isfinite(array)):
        raise DesignError(f"{name} has numbers that are not finite")
    return array


def numbers(name: str, M: ArrayLike) -> Matrix:
    """Real numbers in rows of one length.

    Raises
    ------
    DesignError
        They are none: text, complex numbers, rows of several lengths.
    """
    try:
        given = np.asarray(M)
        if not np.iscomplexobj(given):
            return given.astype(float)
    except (TypeError, ValueError):
        pass
    raise DesignError(f"{name} is no matrix of real numbers in rows of one length: got {reprlib.repr(M)}")


def at(M: Matrix, rho: Matrix) -> Matrix:
    """Member of a family at one point, (rows, columns); `rho` is (n_parameters,)."""
    value: Matrix = M[0] + np.tensordot(rho, M[1:], axes=1)
    return value


@dataclass(frozen=True, eq=False)
class Box:
    """Range of every scheduling parameter.

    Attributes
    ----------
    low, high : (n_parameters,) arrays
        In the units of the parameters; empty for a system without parameters.
    """

    low: Matrix
    high: Matrix

    @classmethod
    def of(cls, ranges: Sequence[Sequence[float]] | None, n_parameters: int) -> "Box":
        """Box of ``[low, high]`` per parameter; None only where there are no parameters."""
        if ranges is None and n_parameters:
            raise DesignError(
                f"A depends on {n_parameters} parameters and no box says in which range: give [low, high] for each of them"
            )
        array = numbers("the box", ranges if ranges is not None else [])
        if not array.size:
            array = array.reshape(0, 2)
        if array.shape != (n_parameters, 2) or not np.all(array[:, 0] < array[:, 1]) or not np.all(np.isfinite(array)):
            raise DesignError(
                f"the box is {array.tolist()}; it needs {n_parameters} rows [low, high], one per parameter, with low < high"
            )
        return cls(array[:, 0], array[:, 1])

    @property
    def centre(self) -> Matrix:
        """Middle of the box, (n_parameters,)."""
        middle: Matrix = 0.5 * (self.low + self.high)
        return middle

    @property
    def half(self) -> Matrix:
        """Half of its width, (n_parameters,)."""
        width: Matrix = 0.5 * (self.high - self.low)
        return width

    def corners(self, active: Sequence[int] | None = None) -> Matrix:
        """Corners of the box in the parameters of these numbers, the others in the middle, (2**k, n_parameters)."""
        chosen = range(len(self.low)) if active is None else active
        points = np.tile(self.centre, (2 ** len(chosen), 1))
        for row, signs in zip(points, product((-1.0, 1.0), repeat=len(chosen)), strict=True):
            row[list(chosen)] += np.array(signs) * self.half[list(chosen)]
        return points

    def looked_at(self, active: Sequence[int]) -> Matrix:
        """Centre, corners (of at most 12 active parameters) and 1024 points of Sobol's sequence, (n_points, n_parameters)."""
        if not len(active):
            return self.centre[np.newaxis]
        spread = np.tile(self.centre, (_SAMPLES, 1))
        inside = qmc.Sobol(len(active), scramble=False).random(_SAMPLES)
        spread[:, list(active)] += (2.0 * inside - 1.0) * self.half[list(active)]
        corners = self.corners(active if len(active) <= _MOST_CORNERS else ())
        return np.vstack([self.centre, corners, spread])

    def normalised(self, M: Matrix) -> Matrix:
        """The same family in parameters between -1 and 1."""
        scaled = M[1:] * self.half[:, np.newaxis, np.newaxis]
        return np.concatenate([at(M, self.centre)[np.newaxis], scaled])

    def restored(self, M: Matrix) -> Matrix:
        """A family in parameters between -1 and 1 as one in the parameters themselves."""
        own = M[1:] / self.half[:, np.newaxis, np.newaxis]
        return np.concatenate([(M[0] - np.tensordot(self.centre, own, axes=1))[np.newaxis], own])

    def active(self, *families: Matrix) -> tuple[int, ...]:
        """Numbers, from 0, of the parameters that really move one of these families over the box."""
        moves = np.zeros(len(self.low), dtype=bool)
        for M in families:
            swing = np.abs(self.normalised(M)).max(axis=(1, 2), initial=0.0)
            moves |= swing[1:] > 1e-12 * swing.max(initial=0.0)
        return tuple(int(j) for j in np.flatnonzero(moves))
