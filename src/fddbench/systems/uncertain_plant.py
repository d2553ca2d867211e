"""Plants with faults, disturbances, inputs and a channel for what is not known about them."""

from dataclasses import dataclass

import numpy as np

from fddbench.systems.interconnection import upper_lft
from fddbench.systems.shapes import Matrix, adopt
from fddbench.systems.state_space import StateSpace

__all__ = ["UncertainPlant"]


@dataclass(frozen=True, kw_only=True)
class UncertainPlant:
    """Plant (4) with faults f, disturbances d, inputs u and the uncertainty channel of (5).

    ``x' = A x + Bf f + Bd d + B u + FA w``, ``y = C x + Df f + Dd d + D u + FC w``,
    ``z = EA x + Ef f + Ed d + EB u + H w``, ``w = Δ z``; the entries left out are zero, without
    FA and EA the plant is certain.

    Attributes
    ----------
    A, Bf, Bd, B, C, Df, Dd, D : arrays
        Nominal matrices: (n_x, n_x), (n_x, n_f), (n_x, n_d), (n_x, n_u), and the same with n_y rows.
    FA, FC : (n_x, n_w), (n_y, n_w) arrays
        How the uncertainty enters states and outputs.
    EA, Ef, Ed, EB, H : (n_z, n_x), (n_z, n_f), (n_z, n_d), (n_z, n_u), (n_z, n_w) arrays
        What the uncertainty sees.
    """

    A: Matrix
    Bf: Matrix
    Bd: Matrix
    B: Matrix
    C: Matrix
    Df: Matrix
    Dd: Matrix
    D: Matrix
    FA: Matrix = None  # type: ignore[assignment]  # zero when left out
    FC: Matrix = None  # type: ignore[assignment]
    EA: Matrix = None  # type: ignore[assignment]
    Ef: Matrix = None  # type: ignore[assignment]
    Ed: Matrix = None  # type: ignore[assignment]
    EB: Matrix = None  # type: ignore[assignment]
    H: Matrix = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        """Fill in zeros for what was left out, refuse what does not fit."""
        nominal = {"A": "xx", "Bf": "xf", "Bd": "xd", "B": "xu", "C": "yx", "Df": "yf", "Dd": "yd", "D": "yu"}
        channel = {"FA": "xw", "FC": "yw", "EA": "zx", "Ef": "zf", "Ed": "zd", "EB": "zu", "H": "zw"}
        counted = {"x": "states", "f": "faults", "d": "disturbances", "u": "inputs", "y": "outputs"}
        counted |= {"w": "outputs of Δ", "z": "inputs of Δ"}
        adopt(self, nominal | channel, counted)

    @property
    def n_x(self) -> int:
        """Number of states."""
        return len(self.A)

    @property
    def n_y(self) -> int:
        """Number of measured outputs."""
        return len(self.C)

    @property
    def inputs(self) -> tuple[int, int, int]:
        """Numbers of faults, disturbances and inputs, in this order."""
        return self.Bf.shape[1], self.Bd.shape[1], self.B.shape[1]

    def system(self) -> StateSpace:
        """Return it as one system with its Δ channel first: from (w, f, d, u) to (z, y)."""
        return StateSpace(
            self.A,
            np.hstack([self.FA, self.Bf, self.Bd, self.B]),
            np.vstack([self.EA, self.C]),
            np.block([[self.H, self.Ef, self.Ed, self.EB], [self.FC, self.Df, self.Dd, self.D]]),
        )

    def at(self, delta: Matrix) -> "UncertainPlant":
        """Return the certain plant at one Δ, (n_w, n_z), equation (5): the upper LFT of the system and Δ."""
        closed = upper_lft(self.system(), StateSpace.gain(delta))
        f, d, u = (slice(end - n, end) for n, end in zip(self.inputs, np.cumsum(self.inputs), strict=True))
        return UncertainPlant(
            A=closed.A, Bf=closed.B[:, f], Bd=closed.B[:, d], B=closed.B[:, u],
            C=closed.C, Df=closed.D[:, f], Dd=closed.D[:, d], D=closed.D[:, u],
        )  # fmt: skip
