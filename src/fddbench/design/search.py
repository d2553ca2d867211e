"""Climbing towards the worst Δ at one frequency: the gain of a linear fractional map over a structured ball."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.design.uncertainty import Block, block_diagonal
from fddbench.interfaces import Floats

__all__ = ["Fraction", "climb"]

Matrix = npt.NDArray[Any]


@dataclass(frozen=True)
class Fraction:
    """``T(Δ) = rv + rw Δ (I - zw Δ)⁻¹ zv`` at one frequency; complex, or real where the response is."""

    rv: Matrix
    rw: Matrix
    zv: Matrix
    zw: Matrix

    def at(self, delta: Floats) -> Matrix:
        """T at one Δ, (n_w, n_z)."""
        inner: Matrix = np.linalg.solve(np.eye(len(delta)) - delta @ self.zw, delta @ self.zv)
        return np.asarray(self.rv + self.rw @ inner)

    def gradient(self, delta: Floats) -> Floats:
        """Return the derivative of the largest singular value of T with respect to Δ, (n_w, n_z)."""
        left, _, right = np.linalg.svd(self.at(delta), full_matrices=False)
        seen = np.linalg.solve(np.eye(len(self.zw)) - self.zw @ delta, self.zv @ right[0].conj())
        acting = np.linalg.solve((np.eye(len(delta)) - delta @ self.zw).conj().T, self.rw.conj().T @ left[:, 0])
        return np.asarray(np.outer(acting.conj(), seen).real)

    def gain(self, delta: Floats) -> float:
        """Largest singular value of T at one Δ."""
        return float(np.linalg.norm(self.at(delta), 2))


def climb(fraction: Fraction, blocks: tuple[Block, ...], start: Floats, *, steps: int = 30) -> tuple[Floats, float]:
    """Climb from `start` by full steps to the extreme point that the gradient prefers, halved when they fail.

    Returns
    -------
    (n_w, n_z) array, float
        Δ in the ball and its gain.
    """
    delta, gain = start, fraction.gain(start)
    for _ in range(steps):
        target, fit = _steepest(blocks, fraction.gradient(delta)), 1.0
        while fit > 1e-3:
            trial = delta + fit * (target - delta)
            value = fraction.gain(trial)
            if value > gain * (1.0 + 1e-10):
                break
            fit *= 0.5
        else:
            return delta, gain
        delta, gain = trial, value
    return delta, gain


def _steepest(blocks: tuple[Block, ...], gradient: Floats) -> Floats:
    """Extreme Δ along the gradient, block by block."""
    chosen, row, column = [], 0, 0
    for block in blocks:
        rows, columns = block.shape
        chosen.append(block.steepest(gradient[row : row + rows, column : column + columns]))
        row, column = row + rows, column + columns
    return block_diagonal(chosen)
