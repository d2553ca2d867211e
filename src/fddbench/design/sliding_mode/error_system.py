"""How uncertainty and corruption reach the reconstructed fault while the observer slides, section 4."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.sliding_mode.canonical import Canonical
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["ErrorSystem", "Pair", "Weights"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Weights:
    """What counts how much, eqs (22) and (23).

    Attributes
    ----------
    uncertainty : (n_xi,) array
        δ1: size of each uncertainty.
    corruption : (p,) array
        δ2: size of what corrupts each output, in its unit; 0: nothing does.
    corruption_pole_1_s : float
        a_f [1/s].
    fault : (q,) array
        Size of each fault that an error of the reconstruction is measured in.
    """

    uncertainty: Floats
    corruption: Floats
    corruption_pole_1_s: float
    fault: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """The free gains: L, (n_1, p), with ``L F2 = 0``, and W, (q, p), with ``W F2 = I``."""

    L: Floats
    W: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class ErrorSystem:
    """What is left of the error on ``e_y = 0``.

    There the injection is ``nu = d' - Ã21 e1 - Ã22 d + F2 f + M2 xi``, and with d of eq (22)

        e1' = (Ã11 + L Ã21) e1 + (Ã12 + L Ã22 + a_f L) d - a_f L phi - (M1 + L M2) xi
        d'  = -a_f d + a_f phi
        W nu - f = -W Ã21 e1 - W (Ã22 + a_f I) d + W M2 xi + a_f W phi.

    Attributes
    ----------
    form : Canonical
    weights : Weights
        Inputs and errors are divided by them, so that all are about one.
    """

    form: Canonical
    weights: Weights

    def __post_init__(self) -> None:
        """Refuse weights of another number of channels."""
        form, w = self.form, self.weights
        needs = {"uncertainty": form.M.shape[1], "corruption": len(form.F2), "fault": form.F2.shape[1]}
        for name, need in needs.items():
            if getattr(w, name).shape != (need,):
                raise DesignError(f"weights.{name} needs {need} numbers, got {getattr(w, name).tolist()}")
        if not np.any(w.uncertainty > 0.0) and not np.any(w.corruption > 0.0):
            raise DesignError(
                "weights: nothing is uncertain and no output corrupted, so every gain is perfect; give sizes"
            )

    @property
    def shown(self) -> Floats:
        """Outputs that are corrupted as columns, (p, n_d), times their sizes."""
        size = self.weights.corruption
        return np.diag(size)[:, size > 0.0]

    def at(self, rho: Floats, pair: Pair) -> StateSpace:
        """From (xi, phi) to the error of the reconstruction, all divided by their sizes, at one point of the box.

        The state is [e1; d], d divided by its size.
        """
        a_f, E, n_1 = self.weights.corruption_pole_1_s, self.shown, self.form.n_1
        A11, A12, A21, A22 = self.form.split(rho)
        M = self.form.M * self.weights.uncertainty
        M1, M2, L, W = M[:n_1], M[n_1:], pair.L, pair.W / self.weights.fault[:, np.newaxis]
        n_d, n_xi = E.shape[1], M.shape[1]
        moving = A22 + a_f * np.eye(len(A22))
        return StateSpace(
            np.block([[A11 + L @ A21, (A12 + L @ moving) @ E], [np.zeros((n_d, n_1)), -a_f * np.eye(n_d)]]),
            np.block([[-(M1 + L @ M2), -a_f * L @ E], [np.zeros((n_d, n_xi)), a_f * np.eye(n_d)]]),
            np.hstack([-W @ A21, -W @ moving @ E]),
            np.hstack([W @ M2, a_f * W @ E]),
        )
