"""Output canonical form, ``C̃ = [0 I]``, ``F̃ = [0; F2]``, step 4 of section 4.1; and what must hold for an observer."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from fddbench.design.geometric.affine import at
from fddbench.design.sliding_mode.plant import FaultyPlant
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Canonical", "canonical"]

_SMALL = 1e-9
"""Share of the largest singular value below which one is zero [-]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Canonical:
    """A plant in the coordinates ``x̃ = T x = [x1; y]`` of eq (10).

    Attributes
    ----------
    A : (n_rho + 1, n, n) array
        Ã.
    M : (n, n_xi) array
        M̃.
    F2 : (p, q) array
        How faults enter the outputs' rates; full column rank.
    T : (n, n) array
        The transformation.
    F2_left : (q, p) array
        Inverse of F2 from the left: W = F2_left + W1 blind.
    blind : (p - q, p) array
        Rows that see no fault, ``blind F2 = 0``: L = L1 blind.
    """

    A: Floats
    M: Floats
    F2: Floats
    T: Floats
    F2_left: Floats
    blind: Floats

    @property
    def n_1(self) -> int:
        """States that no output shows."""
        return int(self.A.shape[1]) - len(self.F2)

    def split(self, rho: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Ã11, Ã12, Ã21, Ã22 at a point of the box."""
        return self.parts(at(self.A, rho))

    def parts(self, A: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """The four parts of a matrix, or of a family of them."""
        k = self.n_1
        return A[..., :k, :k], A[..., :k, k:], A[..., k:, :k], A[..., k:, k:]


def canonical(plant: FaultyPlant) -> Canonical:
    """Canonical form of a plant.

    Raises
    ------
    DesignError
        ``rank C F`` is less than the number of faults, or at a vertex an unstable zero of (A, F, C) is left, which no
        observer moves: of sensor faults, an unstable mode that the trusted outputs do not see.

    References
    ----------
    Edwards, Spurgeon (1998), Sliding Mode Control: Theory and Applications, Taylor & Francis, section 6.3.
    """
    C, F, q = plant.C, plant.F, plant.F.shape[1]
    F2 = C @ F
    values = np.linalg.svd(F2, compute_uv=False)
    if len(values) < q or values[-1] <= _SMALL * values[0]:
        raise DesignError(
            f"C F has rank {int(np.sum(values > _SMALL * values[0]))} for {q} faults: a first-order sliding mode tells faults "
            "apart only where each changes the rate of a measured output in a direction of its own. Measure another output, "
            "or look for fewer faults"
        )
    hidden = _hidden(C)
    F2_left = np.asarray(np.linalg.pinv(F2), dtype=float)
    T = np.vstack([hidden - hidden @ F @ F2_left @ C, C])
    back = np.linalg.inv(T)
    found = Canonical(A=T @ plant.A @ back, M=T @ plant.M, F2=F2, T=T, F2_left=F2_left, blind=_rows(null_space(F2.T).T))
    for rho in plant.vertices:
        _require_minimum_phase(found, rho)
    return found


def _hidden(C: Floats) -> Floats:
    """Rows that complete C: the states that no output shows, where outputs are states; else their orthogonal complement."""
    lone = (np.count_nonzero(C, axis=1) == 1).all()
    if lone:
        unseen: Floats = np.eye(C.shape[1])[~np.any(C != 0.0, axis=0)]
        return unseen
    return np.asarray(null_space(C).T, dtype=float)


def _rows(M: Floats) -> Floats:
    """The same row space by unit vectors, where it has such a basis: L then has the structure [L1 0] of eq (20)."""
    chosen = np.eye(M.shape[1])[np.isclose(np.linalg.norm(M, axis=0), 1.0)]
    return chosen if len(chosen) == len(M) else M


def _require_minimum_phase(form: Canonical, rho: Floats) -> None:
    """(Ã11, blind Ã21) must be detectable, Popov, Belevitch and Hautus' test."""
    A11, _, A21, _ = form.split(rho)
    seen = form.blind @ A21
    for pole in np.linalg.eigvals(A11):
        if pole.real < 0.0:
            continue
        pencil = np.vstack([pole * np.eye(len(A11)) - A11, seen])
        values = np.linalg.svd(pencil, compute_uv=False)
        if values[-1] <= _SMALL * max(values[0], 1e-300):
            raise DesignError(
                f"not minimum phase at rho = {np.round(rho, 4).tolist()}: the faults have an unstable zero at {pole:.4g} 1/s, "
                "a mode that outputs without a fault do not see, so that a fault can hide behind it and no gain moves it. "
                "Trust an output that sees this mode"
            )
