"""The filtering problem behind (12): plant, weights and reference as one system that the filter watches."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant, append, lower_lft, series

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
    n_f, _, n_u = plant.inputs
    if reference.D.shape != (n_f, n_f):
        raise DesignError(
            f"the reference has D of shape {reference.D.shape} but the plant has {n_f} faults (Bf {plant.Bf.shape}, "
            f"Df {plant.Df.shape}); T_ref must map {n_f} faults to {n_f} residuals."
        )
    n_z, n_w = plant.H.shape
    shaped = append(*(weights or Weights()).systems(plant.inputs))
    n_m, n_v = plant.n_y + n_u, shaped.n_inputs
    n_ref = reference.order
    room = StateSpace(*(np.zeros(shape) for shape in ((n_ref, n_ref), (n_ref, 0), (0, n_ref), (0, 0))))
    delta = StateSpace.gain(np.eye(n_w))
    whole = append(room, series(append(delta, shaped), _watched(plant)))
    w, v = slice(0, n_w), slice(n_w, n_w + n_v)
    z, m, f = slice(0, n_z), slice(n_z, n_z + n_m), slice(n_z + n_m, None)
    return Augmented(
        A=whole.A, B=whole.B[:, v], F=whole.B[:, w],
        Cm=whole.C[m], Dm=whole.D[m, v], Fm=whole.D[m, w],
        E=whole.C[z], Ev=whole.D[z, v], H=whole.D[z, w],
        Wc=whole.C[f], Wd=whole.D[f, v],
        n_ref=n_ref, n_y=plant.n_y,
    )  # fmt: skip


def _watched(plant: UncertainPlant) -> StateSpace:
    """The plant from (w, f, d, u) to (z, y, u, f): what Δ sees, what the filter sees, what it should say."""
    whole, (n_f, _, n_u) = plant.system(), plant.inputs
    passed = np.eye(whole.n_inputs)
    n_w = plant.H.shape[1]
    u, f = passed[len(passed) - n_u :], passed[n_w : n_w + n_f]
    rows = [whole.D, u, f]
    return StateSpace(whole.A, whole.B, np.vstack([whole.C, np.zeros((n_u + n_f, whole.order))]), np.vstack(rows))


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
        return lower_lft(self.system(), StateSpace.gain(delta))

    def system(self) -> StateSpace:
        """Return it as one system from (v, w) to (r - r_ref, z)."""
        direct = np.block([[self.D, self.Fr2], [self.Er2, self.H]])
        return StateSpace(self.A, np.hstack([self.B, self.Fr1]), np.vstack([self.C, self.Er1]), direct)


def close(augmented: Augmented, reference: StateSpace, filter_: Filter) -> ClosedLoop:
    """Return the closed loop of the augmented plant with a filter: from (v, w) to (r - r_ref, z)."""
    plant = augmented
    A, B, Cr, Dr = plant.with_reference(reference.A, reference.B, reference.C, reference.D)
    n_f, n_v, n_w, n_z = len(plant.Wc), plant.B.shape[1], plant.F.shape[1], len(plant.H)
    nothing = np.zeros((n_f, n_w))
    open_loop = StateSpace(
        A,
        np.hstack([B, plant.F, np.zeros((len(A), n_f))]),
        np.vstack([-Cr, plant.E, plant.Cm]),
        np.block(
            [
                [-Dr, nothing, np.eye(n_f)],
                [plant.Ev, plant.H, np.zeros((n_z, n_f))],
                [plant.Dm, plant.Fm, np.zeros((len(plant.Cm), n_f))],
            ]
        ),
    )
    whole = lower_lft(open_loop, filter_.as_system())
    v, w, r, z = slice(0, n_v), slice(n_v, None), slice(0, n_f), slice(n_f, None)
    return ClosedLoop(
        A=whole.A, B=whole.B[:, v], C=whole.C[r], D=whole.D[r, v], H=whole.D[z, w],
        Fr1=whole.B[:, w], Fr2=whole.D[r, w], Er1=whole.C[z], Er2=whole.D[z, v],
    )  # fmt: skip
