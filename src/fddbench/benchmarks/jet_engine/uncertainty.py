"""Which engine of the set a flight has: Δ from standard normal numbers, the same bits however many fly together."""

from collections.abc import Callable, Mapping

import numpy as np

from fddbench.benchmarks.jet_engine.plant import DELTA_79
from fddbench.blocks.linear import total
from fddbench.interfaces import Floats

__all__ = ["N_NORMALS", "SETS", "block_of_orthonormal", "diagonal"]

N_NORMALS = 24
"""Standard normal numbers that a set may take per flight."""


def block_of_orthonormal(normals: Floats, rows: int) -> Floats:
    """First three rows of three orthonormal columns of `rows` entries, (3, 3, n_cases), uniformly distributed.

    With three rows a random orthogonal matrix: every singular value is one. With seven rows a matrix distributed
    uniformly in the ball of spectral norm one: a corner of p x p of a random orthogonal matrix of size N has the density
    det(I - XᵀX)^((N - 2p - 1)/2), which is constant for N = 2p + 1.

    Parameters
    ----------
    normals : (3 rows, n_cases) array
        Independent standard normal numbers.

    References
    ----------
    Eaton (1989), Group invariance applications in statistics, chapter 7.
    """
    columns: list[Floats] = []
    for j in range(3):
        v = normals[j * rows : (j + 1) * rows]
        for _ in range(2):  # twice is enough for orthogonality to the last bit
            for q in columns:
                v = v - total(q * v) * q
        columns.append(v / np.sqrt(total(v * v)))
    return np.stack([q[:3] for q in columns], axis=1)


def diagonal(normals: Floats) -> Floats:
    """Diagonal matrix, (3, 3, n_cases), of three numbers uniform in (-1, 1).

    The share that two of four squared standard normal numbers have in their sum is uniform in (0, 1).
    """
    squares = normals[:12] * normals[:12]
    delta = np.zeros((3, 3, normals.shape[1]))
    for j in range(3):
        of_two = squares[4 * j] + squares[4 * j + 1]
        delta[j, j] = 2.0 * of_two / (of_two + (squares[4 * j + 2] + squares[4 * j + 3])) - 1.0
    return delta


def _printed(normals: Floats) -> Floats:
    return np.repeat(DELTA_79[:, :, np.newaxis], normals.shape[1], axis=2)


SETS: Mapping[str, Callable[[Floats], Floats]] = {
    "norm_bounded": lambda normals: block_of_orthonormal(normals[:21], 7),
    "boundary": lambda normals: block_of_orthonormal(normals[:9], 3),
    "structured": diagonal,
    "equation_79": _printed,
}
"""Plants by their names in campaigns: uniform in the ball of spectral norm one, random orthogonal (every singular value
one), diagonal and uniform, and the one Δ of the paper's figures."""
