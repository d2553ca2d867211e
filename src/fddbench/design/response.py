"""What a filter sees and what it should say at one frequency, and how much of that no filter can know there."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.design.problem import Augmented
from fddbench.design.search import Fraction
from fddbench.systems import StateSpace

__all__ = ["Matrix", "Response", "Spot", "at", "complex_form", "real_form", "unseen", "worst_frequency"]

Matrix = npt.NDArray[np.complex128] | npt.NDArray[np.float64]

BLIND = 1e-10
"""Relative size of a singular value of the measured signals below which it is rounding."""


def at(system: StateSpace, frequency: float) -> Matrix:
    """Response of a system, real where it is, at 0 and ∞ [rad/s]."""
    response = system.at(frequency)
    return response.real if frequency in (0.0, np.inf) else response


@dataclass(frozen=True)
class Response:
    """What the filter sees and what it should say at a frequency; real where the response is.

    Attributes
    ----------
    measured : Fraction
        From v to (y, u), as a function of Δ.
    faults : (n_f, n_v) array
        From v to the weighted faults.
    """

    measured: Fraction
    faults: Matrix

    @classmethod
    def of(cls, plant: Augmented, frequency: float) -> "Response":
        """Response of the plant with its weights at a frequency [rad/s]."""
        n_m, n_f, n_v, own = len(plant.Cm), len(plant.Wc), plant.B.shape[1], slice(plant.n_ref, None)
        inputs, outputs = np.hstack([plant.B, plant.F]), np.vstack([plant.Cm, plant.Wc, plant.E])
        direct = np.block([[plant.Dm, plant.Fm], [plant.Wd, np.zeros((n_f, plant.F.shape[1]))], [plant.Ev, plant.H]])
        whole = at(StateSpace(plant.A[own, own], inputs[own], outputs[:, own], direct), frequency)
        m, f, z = whole[:n_m], whole[n_m : n_m + n_f], whole[n_m + n_f :]
        return cls(Fraction(m[:, :n_v], m[:, n_v:], z[:, :n_v], z[:, n_v:]), f[:, :n_v])

    def error(self, gain: Matrix, reference: Matrix) -> Fraction:
        """``K M(Δ) - T_ref W`` for a filter with the response K at this frequency."""
        M = self.measured
        return Fraction(gain @ M.rv - reference @ self.faults, gain @ M.rw, M.zv, M.zw)


def real_form(M: Matrix) -> npt.NDArray[np.float64]:
    """Real matrix with the gains of M: a real M itself, else ``[[Re, -Im], [Im, Re]]``."""
    if not np.iscomplexobj(M):
        return np.asarray(M, dtype=float)
    return np.asarray(np.block([[M.real, -M.imag], [M.imag, M.real]]), dtype=float)


def complex_form(M: npt.NDArray[np.float64], rows: int) -> Matrix:
    """Matrix of a real form with this number of rows; the nearest, which as a gain is no worse, both halves being alike."""
    if len(M) == rows:
        return M
    n, m = rows, M.shape[1] // 2
    return np.asarray(0.5 * (M[:n, :m] + M[n:, m:]) + 0.5j * (M[n:, :m] - M[:n, m:]))


@dataclass(frozen=True)
class Spot:
    """A frequency [rad/s] and the γ that no filter can beat there."""

    gamma: float
    frequency: float


def unseen(plant: Augmented, reference: StateSpace, frequency: float) -> float:
    """``min_K ‖K M - R W‖`` for the plant at Δ = 0: what R asks of directions that M does not show; exact.

    K can follow R on all that M shows and nothing else, so the minimum is ``‖R W (I - M⁺M)‖``.
    """
    response = Response.of(plant, frequency)
    M = response.measured.rv
    sizes = np.linalg.norm(M, axis=1)
    M = M[sizes > 0.0] / sizes[sizes > 0.0, None]
    _, values, right = np.linalg.svd(M)
    blind = right[int(np.sum(values > BLIND * values.max(initial=0.0))) :].conj().T
    return float(np.linalg.norm(reference.at(frequency) @ response.faults @ blind, 2)) if blind.shape[1] else 0.0


def worst_frequency(plant: Augmented, reference: StateSpace) -> Spot:
    """Frequency at which the plant at Δ = 0 shows least of what is wanted: a grid about its poles, then ever finer."""
    own = slice(plant.n_ref, None)
    poles = np.abs(np.concatenate([np.linalg.eigvals(plant.A[own, own]), reference.poles()]))
    poles = poles[poles > 0.0] if np.any(poles > 0.0) else np.ones(1)
    grid = np.concatenate([[0.0], np.geomspace(1e-2 * poles.min(), 1e2 * poles.max(), 60), poles, [np.inf]])
    best = max((Spot(unseen(plant, reference, float(w)), float(w)) for w in np.sort(grid)), key=lambda spot: spot.gamma)
    step = 1.3
    while 0.0 < best.frequency < np.inf and step > 1.0 + 1e-4:
        near = best.frequency * np.geomspace(1.0 / step, step, 7)
        best = max(
            [best, *(Spot(unseen(plant, reference, float(w)), float(w)) for w in near)], key=lambda spot: spot.gamma
        )
        step **= 0.4
    return best
