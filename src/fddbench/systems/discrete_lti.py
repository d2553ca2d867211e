"""Linear systems on the clock, one flight or many: what filters and linear plants do at every sample."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column, product
from fddbench.blocks.tustin import tustin
from fddbench.systems.shapes import misfits, refuse
from fddbench.systems.state_space import StateSpace

__all__ = ["DiscreteLti"]


@dataclass(frozen=True, eq=False, kw_only=True)
class DiscreteLti:
    """``x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k]`` for many cases at once.

    Attributes
    ----------
    A, B, C, D : (n_x, n_x), (n_x, n_u), (n_y, n_x), (n_y, n_u) arrays with a last axis of 1 or n_cases
        One system for all (`fddbench.blocks.linear.column`), or one per case; also traced values. n_x may be zero.
    sample_s : float
        Sample time [s].
    """

    A: Rows
    B: Rows
    C: Rows
    D: Rows
    sample_s: float

    def __post_init__(self) -> None:
        """Refuse what does not fit."""
        layout = {"A": "xx", "B": "xu", "C": "yx", "D": "yu"}
        shapes = {name: tuple(getattr(self, name).shape) for name in layout}
        flat = [
            f"{name} needs three axes, (rows, columns, cases), got shape {s}"
            for name, s in shapes.items()
            if len(s) != 3
        ]
        refuse("DiscreteLti", flat or misfits(shapes, layout, {"x": "states", "u": "inputs", "y": "outputs"})[0])

    @classmethod
    def of(cls, system: StateSpace, sample_s: float) -> Self:
        """Discretise `system` by Tustin's rule; one for all cases.

        Inputs and outputs are those of the continuous system at the samples, states are not; the frequency axis is bent,
        w becomes ``(2/T) tan(w T/2)``.
        """
        return cls.tustin(*(column(M) for M in (system.A, system.B, system.C, system.D)), sample_s=sample_s)

    @classmethod
    def tustin(cls, A: Rows, B: Rows, C: Rows, D: Rows, *, sample_s: float) -> Self:
        """Discretise continuous-time matrices of the shapes of the attributes; the same bits in any company of cases."""
        A, B, C, D = tustin(A, B, C, D, sample_s=sample_s)
        return cls(A=A, B=B, C=C, D=D, sample_s=sample_s)

    @classmethod
    def from_rows(cls, A: Rows, B: Rows, C: Rows, D: Rows, *, n_states: int, n_outputs: int, sample_s: float) -> Self:
        """Read matrices from constants of a flight, (rows * columns, n_cases) each, as `rows` lays them out."""
        matrices = {"A": (A, n_states), "B": (B, n_states), "C": (C, n_outputs), "D": (D, n_outputs)}
        return cls(**{name: _stacked(rows, n) for name, (rows, n) in matrices.items()}, sample_s=sample_s)

    def rows(self) -> dict[str, Rows]:
        """A, B, C, D by name, row after row, (rows * columns, n_cases or 1) each: constants of a flight."""
        return {name: getattr(self, name).reshape(-1, getattr(self, name).shape[2]) for name in "ABCD"}

    @property
    def order(self) -> int:
        """Number of states."""
        return int(self.A.shape[0])

    def start(self, n_cases: int) -> Rows:
        """State at rest, (n_x, n_cases)."""
        return np.zeros((self.order, n_cases))

    def step(self, x: Rows, u: Rows) -> tuple[Rows, Rows]:
        """State at the next sample, (n_x, n_cases), and output at this one, (n_y, n_cases).

        Sums run left to right over the states, then over the inputs, then both are added: the bits are the same however
        many cases fly together, compiled or not.

        Parameters
        ----------
        x : (n_x, n_cases) rows
            State at this sample.
        u : (n_u, n_cases) rows
            Input at this sample.
        """
        if not self.order:
            return x, product(self.D, u)
        return product(self.A, x) + product(self.B, u), product(self.C, x) + product(self.D, u)


def _stacked(rows: Rows, n: int) -> Rows:
    """Rows as a matrix per case, (n, n_columns, n_cases)."""
    n_columns = len(rows) // max(n, 1)
    return np.stack([rows[i * n_columns : (i + 1) * n_columns] for i in range(n)])
