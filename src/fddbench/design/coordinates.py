"""Coordinates in which the inequalities are solved: time, states, signals and references of about size one.

A γ is the same in all of them (times the unit of the reference), the solver's arithmetic is not: margins, tolerances and
pivots mean something only where everything is of about the same size.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

from fddbench.design.gramians import balancing, coarse, gramian
from fddbench.design.multipliers import Multiplier
from fddbench.design.problem import Augmented, Filter
from fddbench.design.uncertainty import Block
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Coordinates", "channel_units"]

FAINT = 1e-6
"""Share of a signal above which its direct part is its unit: what is measured at once, noise and faults, decides how well
states are known, however large they are."""


@dataclass(frozen=True, kw_only=True)
class Coordinates:
    """``ξ = T η, t = τ / rate, r = unit ρ, (y, u) = m / measured, w = ω / channel_w, z = ζ / channel_z``.

    Attributes
    ----------
    T : (n_k, n_k) array
        States of reference, weights and plant; block diagonal, the reference's states first.
    rate : float
        Unit of frequencies [rad/s].
    unit : float
        Unit of residuals and γ.
    measured : (n_y + n_u,) array
        What measured signals are multiplied with.
    channel_w, channel_z : (n_w,), (n_z,) arrays
        What outputs and inputs of Δ are multiplied with, the same number within a block: Δ stays what it is.
    """

    T: Floats
    rate: float
    unit: float
    measured: Floats
    channel_w: Floats
    channel_z: Floats

    @classmethod
    def of(cls, plant: Augmented, reference: StateSpace, blocks: tuple[Block, ...], unit: float) -> "Coordinates":
        """Coordinates for one plant; those of a reference that is free to move keep their states, so pass order 0."""
        n_ref, own = plant.n_ref, slice(plant.n_ref, None)
        rate = _rate(plant.A[own, own])
        raw = cls(
            T=np.eye(len(plant.A)), rate=rate, unit=unit, measured=np.ones(len(plant.Cm)),
            channel_w=np.ones(plant.F.shape[1]), channel_z=np.ones(len(plant.H)),
        )  # fmt: skip
        slow = raw.plant(plant)
        reach = gramian(slow.A[own, own], slow.B[own])
        w, z = channel_units(slow.A[own, own], slow.B[own], slow.E[:, own], slow.Ev, blocks)
        scaled = replace(raw, channel_w=w, channel_z=z) if blocks else raw
        whole, direct = _sizes(slow.Cm[:, own], slow.Dm, reach), np.sqrt(np.sum(slow.Dm**2, axis=1))
        measured = 1.0 / coarse(np.where(direct > FAINT * whole, direct, whole))
        scaled = replace(scaled, measured=measured)
        even = scaled.plant(plant)
        T = balancing(
            even.A[own, own],
            np.hstack([even.B, even.F])[own],
            np.vstack([even.Cm, even.Wc, even.E])[:, own],
        )
        R = balancing(reference.A / rate, reference.B / rate, reference.C / unit) if reference.order else np.eye(n_ref)
        return replace(scaled, T=np.asarray(block_diag(R, T), dtype=float))

    def plant(self, plant: Augmented) -> Augmented:
        """The plant in these coordinates."""
        inverse, T = np.linalg.inv(self.T), self.T
        m, w, z = self.measured[:, None], self.channel_w, self.channel_z[:, None]
        return replace(
            plant,
            A=inverse @ plant.A @ T / self.rate,
            B=inverse @ plant.B / self.rate,
            F=inverse @ plant.F / w / self.rate,
            Cm=m * plant.Cm @ T,
            Dm=m * plant.Dm,
            Fm=m * plant.Fm / w,
            E=z * plant.E @ T,
            Ev=z * plant.Ev,
            H=z * plant.H / w,
            Wc=plant.Wc @ T,
        )

    def reference(self, reference: StateSpace) -> StateSpace:
        """T_ref in these coordinates."""
        R = self.T[: reference.order, : reference.order]
        inverse = np.linalg.inv(R)
        A, B = inverse @ reference.A @ R / self.rate, inverse @ reference.B / self.rate
        return StateSpace(A, B, reference.C @ R / self.unit, reference.D / self.unit)

    def reference_back(self, reference: StateSpace) -> StateSpace:
        """T_ref in its own coordinates."""
        R = self.T[: reference.order, : reference.order]
        inverse = np.linalg.inv(R)
        A, B = R @ reference.A @ inverse * self.rate, R @ reference.B * self.rate
        return StateSpace(A, B, reference.C @ inverse * self.unit, reference.D * self.unit)

    def filter_back(self, filter_: Filter) -> Filter:
        """The filter that flies: signals and time of the plant, states as they are."""
        n_y = filter_.Bky.shape[1]
        y, u = self.measured[:n_y], self.measured[n_y:]
        return Filter(
            Ak=self.rate * filter_.Ak,
            Bky=self.rate * filter_.Bky * y,
            Bku=self.rate * filter_.Bku * u,
            Ck=self.unit * filter_.Ck,
            Dky=self.unit * filter_.Dky * y,
            Dku=self.unit * filter_.Dku * u,
        )

    def lyapunov_back(self, P: Floats) -> Floats:
        """Lyapunov matrix for the states of plant and filter, (n_k + n, n_k + n), of one in these coordinates."""
        back = block_diag(np.linalg.inv(self.T), np.eye(len(P) - len(self.T)))
        return np.asarray(back.T @ P @ back * (self.unit / self.rate), dtype=float)

    def multiplier_back(self, multiplier: Multiplier) -> Multiplier:
        """S and G for the Δ channel of the plant."""
        w, z, unit = self.channel_w, self.channel_z, self.unit
        return Multiplier(
            S_w=unit * w[:, None] * multiplier.S_w * w,
            S_z=unit * z[:, None] * multiplier.S_z * z,
            G=unit * z[:, None] * multiplier.G * w,
        )


def channel_units(A: Floats, B: Floats, E: Floats, Ev: Floats, blocks: tuple[Block, ...]) -> tuple[Floats, Floats]:
    """Factors for outputs and inputs of Δ, (n_w,) and (n_z,), with which every block sees signals of about one."""
    w, z = (np.ones(sum(block.shape[axis] for block in blocks)) for axis in (0, 1))
    seen = _sizes(E, Ev, gramian(A, B))
    for rows, columns in _places(blocks):
        w[rows] = z[columns] = 1.0 / coarse(np.sqrt(np.mean(seen[columns] ** 2)))
    return w, z


def _rate(A: Floats) -> float:
    """About the geometric mean of the absolute poles, 1 without any [rad/s]."""
    poles = np.abs(np.linalg.eigvals(A))
    return float(coarse(np.exp(np.mean(np.log(poles))))) if len(A) and np.all(poles > 0.0) else 1.0


def _places(blocks: tuple[Block, ...]) -> list[tuple[slice, slice]]:
    """Rows and columns of every block of Δ."""
    ends = [np.cumsum([block.shape[axis] for block in blocks]) for axis in (0, 1)]
    return [
        tuple(slice(end[i] - block.shape[axis], end[i]) for axis, end in enumerate(ends))  # type: ignore[misc]
        for i, block in enumerate(blocks)
    ]


def _sizes(C: Floats, D: Floats, reach: Floats) -> Floats:
    """Size of every output for white unit inputs, its feedthrough included."""
    return np.asarray(np.sqrt(np.maximum(np.sum((C @ reach) * C, axis=1), 0.0) + np.sum(D * D, axis=1)))
