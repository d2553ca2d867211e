"""Plants freed of inputs that nobody knows, as far as that is possible: the algebra of unknown-input observers.

``x' = A x + B u + E_x d``, ``y = C x + D u + E_y d`` with d unknown. First d is solved for where the outputs hold it, then
what is left of it is taken out of the rates by the change of the outputs that it moves.

References
----------
Hou, Müller (1992), Design of observers for linear systems with unknown inputs, IEEE Transactions on Automatic Control 37(6),
871-875; Darouach, Zasadzinski, Xu (1994), Full-order observers for linear systems with unknown inputs, IEEE Transactions on
Automatic Control 39(3), 606-609; Chen, Patton (1999), Robust model-based fault diagnosis for dynamic systems, chapter 3.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Decoupled", "decoupled"]

_SMALL = 1e-9
"""Singular values below this share of the largest are zero."""


@dataclass(frozen=True, kw_only=True)
class Decoupled:
    """``x' = A x + B_y y + B_u u + E d``, ``S (y - D u) = S C x`` with d that no output holds; and what projects it away.

    Attributes
    ----------
    A, B_y, B_u, E : (n_x, n_x), (n_x, n_y), (n_x, n_u), (n_x, n_d) arrays
        Rates; n_d may be zero.
    S : (n_left, n_y) array
        Outputs that are left.
    SC, SD : (n_left, n_x), (n_left, n_u) arrays
        Their rows of C and D.
    H : (n_x, n_left) array
        ``H = E (S C E)⁺``; an observer ``z = x - H S (y - D u)`` is free of d.
    """

    A: Floats
    B_y: Floats
    B_u: Floats
    E: Floats
    S: Floats
    SC: Floats
    SD: Floats
    H: Floats

    @property
    def T(self) -> Floats:
        """``I - H S C``, which takes d out of the rates, (n_x, n_x)."""
        return np.eye(len(self.A)) - self.H @ self.SC


def decoupled(A: Floats, B: Floats, C: Floats, D: Floats, *, E_x: Floats, E_y: Floats, what: str) -> Decoupled:
    """Take unknown inputs out of a plant.

    Parameters
    ----------
    what : str
        The unknown inputs in words, for messages.

    Raises
    ------
    DesignError
        With the condition that fails: no output is left for a residual; ``rank(C E) = rank(E)``; detectability.
    """
    S, N = null_space(E_y.T, rcond=_SMALL).T, null_space(E_y, rcond=_SMALL)
    held, n_y = len(C) - len(S), len(C)
    solved = E_x @ np.linalg.pinv(E_y, rcond=_SMALL)
    E, SC = E_x @ N, S @ C
    rank_E, rank_CE = _rank(E), _rank(SC @ E) if len(S) else 0
    if n_y - held - rank_E < 1:
        raise DesignError(
            f"no unknown-input observer for {what}: {held + rank_E} independent ones leave none of the {n_y} outputs for a "
            "residual; needs more outputs than unknown inputs. Take some for known, or for noise"
        )
    if rank_CE < rank_E:
        raise DesignError(
            f"no unknown-input observer for {what}: rank(C E) = {rank_CE}, rank(E) = {rank_E}, they must be equal: an unknown "
            "input moves no output at once. Measure what it moves"
        )
    H = E @ np.linalg.pinv(SC @ E, rcond=_SMALL)
    found = Decoupled(
        A=A - solved @ C, B_y=solved, B_u=B - solved @ D, E=E, S=S, SC=SC, SD=S @ D, H=H
    )  # fmt: skip
    unseen = _unseen(found.T @ found.A, SC)
    if unseen is not None:
        raise DesignError(
            f"no unknown-input observer for {what}: the pair (A - H C A, C) is not detectable, nothing sees its eigenvalue "
            f"{unseen:.4g}, an invariant zero of (A, E, C) in the right half plane"
        )
    return found


def _rank(M: Floats) -> int:
    return int(np.linalg.matrix_rank(M, tol=_SMALL * max(1.0, float(np.linalg.norm(M, 2))))) if M.size else 0


def _unseen(A: Floats, C: Floats) -> complex | None:
    """An eigenvalue of A in the closed right half plane that C does not see; None if there is none."""
    for value in np.linalg.eigvals(A):
        if value.real >= -_SMALL:
            test = np.vstack([A - value * np.eye(len(A)), C])
            values = np.linalg.svd(test, compute_uv=False)
            if values[-1] < _SMALL * max(1.0, values[0]):
                return complex(value)
    return None
