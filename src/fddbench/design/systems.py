"""Linear systems as the synthesis sees them: state space, uncertain plant, weights; refused when shapes do not fit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["StateSpace", "UncertainPlant", "Weights"]


@dataclass(frozen=True)
class StateSpace:
    """Continuous-time system ``x' = A x + B u, y = C x + D u``.

    Attributes
    ----------
    A, B, C, D : (n_x, n_x), (n_x, n_u), (n_y, n_x), (n_y, n_u) arrays
        Any of the sizes may be zero.
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats

    def __post_init__(self) -> None:
        """Refuse what is not a matrix or does not fit."""
        _adopt(self, {"A": "xx", "B": "xu", "C": "yx", "D": "yu"}, {"x": "states", "u": "inputs", "y": "outputs"})

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

    A: Floats
    Bf: Floats
    Bd: Floats
    B: Floats
    C: Floats
    Df: Floats
    Dd: Floats
    D: Floats
    FA: Floats = None  # type: ignore[assignment]  # zero when left out
    FC: Floats = None  # type: ignore[assignment]
    EA: Floats = None  # type: ignore[assignment]
    Ef: Floats = None  # type: ignore[assignment]
    Ed: Floats = None  # type: ignore[assignment]
    EB: Floats = None  # type: ignore[assignment]
    H: Floats = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        """Fill in zeros for what was left out, refuse what does not fit."""
        nominal = {"A": "xx", "Bf": "xf", "Bd": "xd", "B": "xu", "C": "yx", "Df": "yf", "Dd": "yd", "D": "yu"}
        channel = {"FA": "xw", "FC": "yw", "EA": "zx", "Ef": "zf", "Ed": "zd", "EB": "zu", "H": "zw"}
        counted = {"x": "states", "f": "faults", "d": "disturbances", "u": "inputs", "y": "outputs"}
        counted |= {"w": "outputs of Δ", "z": "inputs of Δ"}
        _adopt(self, nominal | channel, counted)

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

    def at(self, delta: Floats) -> "UncertainPlant":
        """Return the certain plant at one Δ, (n_w, n_z), equation (5)."""
        delta_h = np.linalg.solve(np.eye(len(delta)) - delta @ self.H, delta)
        x, y = self.FA @ delta_h, self.FC @ delta_h
        return UncertainPlant(
            A=self.A + x @ self.EA, Bf=self.Bf + x @ self.Ef, Bd=self.Bd + x @ self.Ed, B=self.B + x @ self.EB,
            C=self.C + y @ self.EA, Df=self.Df + y @ self.Ef, Dd=self.Dd + y @ self.Ed, D=self.D + y @ self.EB,
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Weights:
    """Weights of (13), ``‖[(T_rf - T_ref) W_f, T_rd W_d, T_ru W_u]‖∞``; None is the identity.

    Attributes
    ----------
    W_f, W_d, W_u : StateSpace, array or None
        Stable square systems or constant matrices; they turn unit signals into faults, disturbances
        and inputs in their own units.
    """

    W_f: StateSpace | npt.ArrayLike | None = None
    W_d: StateSpace | npt.ArrayLike | None = None
    W_u: StateSpace | npt.ArrayLike | None = None

    def systems(self, inputs: tuple[int, int, int]) -> tuple[StateSpace, StateSpace, StateSpace]:
        """Return the three weights as systems for `inputs` = (n_f, n_d, n_u); refuses unstable ones and other sizes."""
        named = {"W_f": self.W_f, "W_d": self.W_d, "W_u": self.W_u}
        f, d, u = (_weight(name, value, n) for (name, value), n in zip(named.items(), inputs, strict=True))
        return f, d, u


def _weight(name: str, value: StateSpace | npt.ArrayLike | None, n: int) -> StateSpace:
    """One weight as a system with `n` outputs."""
    if value is None:
        return StateSpace.gain(np.eye(n).reshape(n, n))
    weight = value if isinstance(value, StateSpace) else StateSpace.gain(value)
    if weight.D.shape[0] != n:
        counted = {
            "W_f": "faults (columns of Bf)",
            "W_d": "disturbances (columns of Bd)",
            "W_u": "inputs (columns of B)",
        }
        raise DesignError(f"{name} has D of shape {weight.D.shape}, need {n} rows: the plant has {n} {counted[name]}.")
    if not weight.stable():
        raise DesignError(
            f"{name} is unstable: poles {np.round(weight.poles(), 4)}. Use a stable weight, e.g. 1/(s + 0.01) for 1/s."
        )
    return weight


def _adopt(system: Any, layout: Mapping[str, str], counted: Mapping[str, str]) -> None:
    """Turn the fields of a frozen system into float matrices and refuse all that do not fit, at once.

    `layout` gives the letters of rows and columns of every matrix, `counted` says what a letter counts.
    """
    mistakes: list[str] = []
    sizes: dict[str, tuple[int, str]] = {}
    given = {name: getattr(system, name) for name in layout if getattr(system, name) is not None}
    matrices = {name: np.array(value, dtype=float) for name, value in given.items()}
    for name, matrix in matrices.items():
        if matrix.ndim != 2 or not np.all(np.isfinite(matrix)):
            mistakes.append(
                f"{name} must be a finite matrix with two axes, got shape {matrix.shape}: {given[name]!r:.80}"
            )
            continue
        for axis, letter in enumerate(layout[name]):
            size, first = sizes.setdefault(letter, (matrix.shape[axis], name))
            if matrix.shape[axis] != size:
                what = ("rows", "columns")[axis]
                mistakes.append(
                    f"{name} {matrix.shape} has {matrix.shape[axis]} {what} but {first} {matrices[first].shape} "
                    f"has {size} {counted[letter]}; they must agree"
                )
    if mistakes:
        raise DesignError(f"{type(system).__name__} does not fit together:\n  " + "\n  ".join(mistakes))
    for name, letters in layout.items():
        shape = tuple(sizes.get(letter, (0, ""))[0] for letter in letters)
        object.__setattr__(system, name, matrices.get(name, np.zeros(shape)))
