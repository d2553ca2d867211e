"""Continuous-time systems ``x' = A x + B u, y = C x + D u``; refused when shapes do not fit."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from fddbench.systems.shapes import Matrix, adopt

__all__ = ["StateSpace"]


@dataclass(frozen=True)
class StateSpace:
    """Continuous-time system ``x' = A x + B u, y = C x + D u``.

    Attributes
    ----------
    A, B, C, D : (n_x, n_x), (n_x, n_u), (n_y, n_x), (n_y, n_u) arrays
        Any of the sizes may be zero.
    """

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix

    def __post_init__(self) -> None:
        """Refuse what is not a matrix or does not fit."""
        adopt(self, {"A": "xx", "B": "xu", "C": "yx", "D": "yu"}, {"x": "states", "u": "inputs", "y": "outputs"})

    @classmethod
    def gain(cls, D: npt.ArrayLike) -> Self:
        """Constant gain, (n_y, n_u) or a scalar; no state."""
        matrix = np.atleast_2d(np.asarray(D, dtype=float))
        rows, columns = matrix.shape
        return cls(np.zeros((0, 0)), np.zeros((0, columns)), np.zeros((rows, 0)), matrix)

    @classmethod
    def diagonal(cls, a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike, d: npt.ArrayLike) -> Self:
        """First-order channels ``d_i + c_i b_i / (s - a_i)`` side by side; all arguments (n,)."""
        return cls(*(np.diag(np.asarray(entry, dtype=float)) for entry in (a, b, c, d)))

    @property
    def n_inputs(self) -> int:
        """Number of inputs."""
        return int(self.D.shape[1])

    @property
    def n_outputs(self) -> int:
        """Number of outputs."""
        return int(self.D.shape[0])

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)

    def poles(self) -> npt.NDArray[np.complex128]:
        """Eigenvalues of A, (n_x,) [rad/s]."""
        return np.linalg.eigvals(self.A).astype(np.complex128)

    def stable(self) -> bool:
        """Whether every pole has a negative real part."""
        return bool(np.all(self.poles().real < 0.0))

    def at(self, frequency: float) -> npt.NDArray[np.complex128]:
        """Frequency response at `frequency` [rad/s], (n_y, n_u); D at infinity."""
        if np.isinf(frequency) or not self.order:
            return self.D.astype(np.complex128)
        resolvent = np.linalg.solve(1j * frequency * np.eye(self.order) - self.A, self.B.astype(np.complex128))
        return np.asarray(self.C @ resolvent + self.D, dtype=np.complex128)
