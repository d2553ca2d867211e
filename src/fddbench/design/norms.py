"""Largest and smallest gain of a system over all frequencies, by level sets of a Hamiltonian matrix."""

from dataclasses import dataclass

import numpy as np

from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Gain", "hinf_norm", "hminus_index", "level_frequencies"]


@dataclass(frozen=True)
class Gain:
    """A gain and where it is reached.

    Attributes
    ----------
    value : float
        Singular value [-].
    frequency : float
        Frequency [rad/s]; infinite when only the feedthrough reaches it.
    """

    value: float
    frequency: float


def level_frequencies(system: StateSpace, level: float) -> Floats:
    """Frequencies ≥ 0 [rad/s] at which some singular value of the response may equal `level`, sorted.

    They are the eigenvalues on the imaginary axis of the Hamiltonian matrix with ``R = level² I - DᵀD``; the band about
    the axis is generous, so the set may hold more frequencies than there are but misses none.

    References
    ----------
    Boyd, Balakrishnan, Kabamba (1989), A bisection method for computing the H∞ norm of a transfer matrix and related
    problems, Mathematics of Control, Signals and Systems 2, 207-219.
    """
    A, B, C, D = system.A, system.B, system.C, system.D
    R = level**2 * np.eye(D.shape[1]) - D.T @ D
    gain = np.linalg.solve(R, np.hstack([D.T @ C, B.T]))
    left, right = gain[:, : len(A)], gain[:, len(A) :]
    state = A + B @ left
    hamiltonian = np.block([[state, B @ right], [-C.T @ (C + D @ left), -state.T]])
    poles = np.linalg.eigvals(hamiltonian)
    band = 1e-7 * max(1.0, float(np.linalg.norm(hamiltonian, 2)))
    near = np.abs(poles.real) < np.maximum(band, 1e-5 * np.abs(poles.imag))
    return np.unique(np.abs(poles[near].imag))


def hinf_norm(system: StateSpace, *, tolerance: float = 1e-8) -> Gain:
    """‖T‖∞, the largest singular value over all frequencies, equation (2).

    Starts from the gains at 0, ∞ and the poles' frequencies and climbs from one level set of the Hamiltonian to the
    next until the level ``(1 + tolerance) value`` is crossed nowhere; that last test is the proof.

    Parameters
    ----------
    system : StateSpace
        Must be stable.
    tolerance : float
        Relative width of the last step [-].

    References
    ----------
    Bruinsma, Steinbuch (1990), A fast algorithm to compute the H∞-norm of a transfer function matrix, Systems &
    Control Letters 14(4), 287-293.
    """
    if not system.stable():
        raise DesignError(f"the H∞ norm of an unstable system is infinite; poles {np.round(system.poles(), 6)}.")
    return _climb(system, tolerance, largest=True)


def hminus_index(system: StateSpace, *, tolerance: float = 1e-8) -> Gain:
    """‖T‖₋, the smallest singular value over all frequencies, equation (2); 0 for more inputs than outputs."""
    if system.D.shape[0] < system.D.shape[1]:
        return Gain(0.0, 0.0)
    return _climb(system, tolerance, largest=False)


def _climb(system: StateSpace, tolerance: float, *, largest: bool) -> Gain:
    """Extreme gain by climbing (or descending) level sets."""
    poles = system.poles()
    start = np.concatenate([[0.0, np.inf], np.abs(poles), np.abs(poles.imag)])
    best = _extreme(system, start, largest)
    if not system.order:
        return best
    scale = float(np.abs(system.D).max(initial=0.0) + np.abs(best.value))
    for _ in range(100):
        if best.value <= 1e-14 * scale:
            return best
        level = best.value * (1.0 + tolerance if largest else 1.0 - tolerance)
        crossings = level_frequencies(system, level)
        between = np.sqrt(crossings[1:] * crossings[:-1])
        middle = 0.5 * (crossings[1:] + crossings[:-1])
        found = _extreme(system, np.concatenate([crossings, between, middle]), largest)
        if (found.value <= level) if largest else (found.value >= level):
            return best
        best = found
    return best


def _extreme(system: StateSpace, frequencies: Floats, largest: bool) -> Gain:
    """Largest or smallest singular value over the frequencies given; ± infinity for none."""
    best = Gain(-np.inf if largest else np.inf, 0.0)
    for frequency in frequencies:
        values = np.linalg.svd(system.at(float(frequency)), compute_uv=False)
        value = float(values[0] if largest else values[-1]) if values.size else 0.0
        if (value > best.value) if largest else (value < best.value):
            best = Gain(value, float(frequency))
    return best
