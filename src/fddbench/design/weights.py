"""Sizes of faults, disturbances and inputs: γ weighs all three as unit signals."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.errors import DesignError
from fddbench.systems import StateSpace

__all__ = ["Weights"]


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
