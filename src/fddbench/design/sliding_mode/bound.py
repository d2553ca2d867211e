"""A γ that nobody beats: any linear filter of all measurements, even one that knows rho, at one frequency."""

import numpy as np

from fddbench.design.sliding_mode.error_system import ErrorSystem
from fddbench.design.sliding_mode.plant import FaultyPlant
from fddbench.interfaces import Floats

__all__ = ["lower_bound"]

_FREQUENCIES = np.logspace(-3.0, 4.0, 281)
_WORST_CONDITION = 1e12
"""Of X with unit diagonal; beyond it counts as singular."""


def lower_bound(system: ErrorSystem, plant: FaultyPlant) -> float:
    """Largest ``min_K ‖K N‖`` with ``K G = I`` over vertices and frequencies, for a rho that stands still [-].

    y = G f + N w with w = (xi, phi). A filter K that follows every fault, as the observer does, has ``K G = I``; then
    ``K N`` is smallest for ``K = (G* X^-1 G)^-1 G* X^-1``, ``X = N N*``, and its norm squared the largest eigenvalue of
    ``(G* X^-1 G)^-1``. It bounds an L2 gain from below because one frequency does. Where X is singular, some combination of
    outputs is free of noise and the bound is 0.
    """
    return max(_at(system, rho) for rho in plant.vertices)


def _at(system: ErrorSystem, rho: Floats) -> float:
    """Bound at one vertex, over all frequencies."""
    form, weights, n_1 = system.form, system.weights, system.form.n_1
    A11, A12, A21, A22 = form.split(rho)
    A, s = np.block([[A11, A12], [A21, A22]]), 1j * _FREQUENCIES[:, np.newaxis, np.newaxis]
    resolvent = np.linalg.inv(s * np.eye(len(A)) - A)[:, n_1:]
    G = resolvent[:, :, n_1:] @ form.F2 * weights.fault
    corrupted = weights.corruption_pole_1_s / (s + weights.corruption_pole_1_s) * system.shown
    N = np.concatenate([resolvent @ (form.M * weights.uncertainty), corrupted], axis=2)
    size = np.linalg.norm(N, axis=2, keepdims=True)
    if np.any(size == 0.0):
        return 0.0
    N, G = N / size, G / size
    X = N @ N.conj().swapaxes(1, 2)
    sure = np.linalg.cond(X) < _WORST_CONDITION
    if not np.any(sure):
        return 0.0
    seen = G[sure].conj().swapaxes(1, 2) @ np.linalg.solve(X[sure], G[sure])
    return float(1.0 / np.sqrt(np.linalg.eigvalsh(seen)[:, 0].min()))
