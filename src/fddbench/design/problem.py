"""The filtering problem behind (12): plant, weights and reference as one system that the filter watches."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.systems import StateSpace, UncertainPlant, Weights
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["Augmented", "ClosedLoop", "Filter", "augment", "close"]


@dataclass(frozen=True, kw_only=True)
class Filter:
    """Detection filter (8): ``x' = Ak x + Bku u + Bky y``, ``r = Ck x + Dku u + Dky y``.

    Attributes
    ----------
    Ak, Bky, Bku, Ck, Dky, Dku : arrays
        (n_k, n_k), (n_k, n_y), (n_k, n_u), (n_f, n_k), (n_f, n_y), (n_f, n_u).
    """

    Ak: Floats
    Bky: Floats
    Bku: Floats
    Ck: Floats
    Dky: Floats
    Dku: Floats

    def as_system(self) -> StateSpace:
        """Return the filter from (y, u) to r."""
        return StateSpace(self.Ak, np.hstack([self.Bky, self.Bku]), self.Ck, np.hstack([self.Dky, self.Dku]))


@dataclass(frozen=True, kw_only=True)
class Augmented:
    """States ξ = (x_ref, x_wf, x_wd, x_wu, x) driven by unit signals v = (f, d, u), equations (34)-(35) with weights.

    ``ξ' = (A + E1 A_ref E1ᵀ + E1 B_ref Wc) ξ + (B + E1 B_ref Wd) v + F w``, measured ``(y, u) = Cm ξ + Dm v + Fm w``,
    ``z = E ξ + Ev v + H w``, weighted faults ``Wc ξ + Wd v``; E1 selects the first `n_ref` states.

    Attributes
    ----------
    A, B, F : (n_k, n_k), (n_k, n_v), (n_k, n_w) arrays
    Cm, Dm, Fm : (n_y + n_u, n_k), (n_y + n_u, n_v), (n_y + n_u, n_w) arrays
    E, Ev, H : (n_z, n_k), (n_z, n_v), (n_z, n_w) arrays
    Wc, Wd : (n_f, n_k), (n_f, n_v) arrays
    n_ref, n_y : int
        Order of the reference, number of outputs of the plant.
    """

    A: Floats
    B: Floats
    F: Floats
    Cm: Floats
    Dm: Floats
    Fm: Floats
    E: Floats
    Ev: Floats
    H: Floats
    Wc: Floats
    Wd: Floats
    n_ref: int
    n_y: int

    @property
    def E1(self) -> Floats:
        """Where the reference's states are, (n_k, n_ref)."""
        return np.eye(len(self.A))[:, : self.n_ref]

    def with_reference(self, A: Any, B: Any, C: Any, D: Any) -> tuple[Any, Any, Any, Any]:
        """Return A, B of ξ and Cr, Dr of the wanted residual ``Cr ξ + Dr v``; arrays or cvxpy expressions."""
        if not self.n_ref:
            return self.A, self.B, D @ self.Wc, D @ self.Wd
        E1 = self.E1
        state = self.A + E1 @ (A @ E1.T + B @ self.Wc)
        return state, self.B + E1 @ (B @ self.Wd), C @ E1.T + D @ self.Wc, D @ self.Wd


def augment(plant: UncertainPlant, reference: StateSpace, weights: Weights | None = None) -> Augmented:
    """Absorb the weights of (13) in the data of `plant` and make room for the states of `reference`."""
    n_f, n_d, n_u = plant.inputs
    if reference.D.shape != (n_f, n_f):
        raise DesignError(
            f"the reference has D of shape {reference.D.shape} but the plant has {n_f} faults (Bf {plant.Bf.shape}, "
            f"Df {plant.Df.shape}); T_ref must map {n_f} faults to {n_f} residuals."
        )
    shaped = (weights or Weights()).systems(plant.inputs)
    n_ref, orders = reference.order, [w.order for w in shaped]
    Wa, Wb, Wc, Wd = (block_diag(*(getattr(w, name) for w in shaped)) for name in "ABCD")
    left = np.zeros((n_ref, n_ref))
    n_w, n_v = plant.FA.shape[1], Wd.shape[1]
    inputs, outputs, seen = (np.hstack(row) for row in _rows(plant))
    signals = np.hstack([np.zeros((len(Wc), n_ref)), Wc, np.zeros((len(Wc), plant.n_x))])
    padded = [np.hstack([np.zeros((len(M), n_ref + sum(orders))), M]) for M in (plant.A, plant.C, plant.EA)]
    u = np.eye(n_f + n_d + n_u)[n_f + n_d :]
    A = block_diag(left, Wa, plant.A)
    A[n_ref + sum(orders) :] += inputs @ signals
    return Augmented(
        A=A,
        B=np.vstack([np.zeros((n_ref, n_v)), Wb, inputs @ Wd]),
        F=np.vstack([np.zeros((n_ref + sum(orders), n_w)), plant.FA]),
        Cm=np.vstack([padded[1] + outputs @ signals, u @ signals]),
        Dm=np.vstack([outputs, u]) @ Wd,
        Fm=np.vstack([plant.FC, np.zeros((n_u, n_w))]),
        E=padded[2] + seen @ signals,
        Ev=seen @ Wd,
        H=plant.H,
        Wc=signals[:n_f],
        Wd=Wd[:n_f],
        n_ref=n_ref,
        n_y=plant.n_y,
    )


def _rows(plant: UncertainPlant) -> tuple[tuple[Floats, ...], ...]:
    """Input matrices of state, output and Δ for (f, d, u)."""
    return (plant.Bf, plant.Bd, plant.B), (plant.Df, plant.Dd, plant.D), (plant.Ef, plant.Ed, plant.EB)


@dataclass(frozen=True, kw_only=True)
class ClosedLoop:
    """Filter, plant and reference together, equations (17)-(18), in the coordinates of the filter that flies.

    ``ζ' = A ζ + B v + Fr1 w``, ``r - r_ref = C ζ + D v + Fr2 w``, ``z = Er1 ζ + Er2 v + H w``.
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    Fr1: Floats
    Fr2: Floats
    Er1: Floats
    Er2: Floats
    H: Floats

    def at(self, delta: Floats) -> StateSpace:
        """Return the closed loop (14) at one Δ, (n_w, n_z)."""
        delta_h = np.linalg.solve(np.eye(len(delta)) - delta @ self.H, delta)
        x, r = self.Fr1 @ delta_h, self.Fr2 @ delta_h
        return StateSpace(self.A + x @ self.Er1, self.B + x @ self.Er2, self.C + r @ self.Er1, self.D + r @ self.Er2)


def close(augmented: Augmented, reference: StateSpace, filter_: Filter) -> ClosedLoop:
    """Return the closed loop of the augmented plant with a filter."""
    K = filter_.as_system()
    A, B, Cr, Dr = augmented.with_reference(reference.A, reference.B, reference.C, reference.D)
    n_k, n_z = len(K.A), len(augmented.H)
    return ClosedLoop(
        A=np.block([[A, np.zeros((len(A), n_k))], [K.B @ augmented.Cm, K.A]]),
        B=np.vstack([B, K.B @ augmented.Dm]),
        C=np.hstack([K.D @ augmented.Cm - Cr, K.C]),
        D=K.D @ augmented.Dm - Dr,
        Fr1=np.vstack([augmented.F, K.B @ augmented.Fm]),
        Fr2=K.D @ augmented.Fm,
        Er1=np.hstack([augmented.E, np.zeros((n_z, n_k))]),
        Er2=augmented.Ev,
        H=augmented.H,
    )
