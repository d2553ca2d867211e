"""The multipliers S, G of Lemma 2 that remove Δ from an inequality."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fddbench.design.solver import modelling
from fddbench.design.uncertainty import Block, FullBlock
from fddbench.interfaces import Floats

__all__ = ["Multiplier", "MultiplierVariables"]


@dataclass(frozen=True, kw_only=True)
class Multiplier:
    """S and G of (21)-(22) as numbers; for an unstructured Δ, S = λI and G = 0.

    Attributes
    ----------
    S_w, S_z : (n_w, n_w), (n_z, n_z) arrays
        S on the output and on the input side of Δ; equal for square blocks.
    G : (n_z, n_w) array
        Skew on repeated real blocks, zero elsewhere.
    """

    S_w: Floats
    S_z: Floats
    G: Floats

    @property
    def scalars(self) -> Floats:
        """Diagonal of S, (n_w,): λ, once per channel."""
        return np.diag(self.S_w)


class MultiplierVariables:
    """S and G of (21) as cvxpy expressions."""

    def __init__(self, blocks: tuple[Block, ...]) -> None:
        cp = modelling()
        n_w, n_z = (sum(block.shape[axis] for block in blocks) for axis in (0, 1))
        self.S_w: Any = np.zeros((n_w, n_w))
        self.S_z: Any = np.zeros((n_z, n_z))
        self.G: Any = np.zeros((n_z, n_w))
        row = column = 0
        for block in blocks:
            W = np.eye(n_w)[:, row : row + block.shape[0]]
            Z = np.eye(n_z)[:, column : column + block.shape[1]]
            row, column = row + block.shape[0], column + block.shape[1]
            if isinstance(block, FullBlock):
                scale = cp.Variable(nonneg=True)
                self.S_w, self.S_z = self.S_w + scale * (W @ W.T), self.S_z + scale * (Z @ Z.T)
                continue
            size = block.shape[0]
            S, K = cp.Variable((size, size), symmetric=True), cp.Variable((size, size))
            self.S_w, self.S_z = self.S_w + W @ S @ W.T, self.S_z + Z @ S @ Z.T
            if size > 1:
                self.G = self.G + Z @ (K - K.T) @ W.T

    def value(self) -> Multiplier:
        """Return the solution as numbers."""
        S_w, S_z, G = (np.asarray(getattr(M, "value", M), dtype=float) for M in (self.S_w, self.S_z, self.G))
        return Multiplier(S_w=S_w, S_z=S_z, G=G)
