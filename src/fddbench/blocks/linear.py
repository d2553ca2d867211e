"""Products and sums in a fixed order: the bits must not depend on how many cases fly together.

BLAS and NumPy's own reductions choose their order of summation by the shape of the whole array, so a flight alone and
the same flight in a chunk of 256 would differ in the last bit. Everything here is summed left to right.
"""

from functools import reduce
from operator import add

import numpy as np

from fddbench.blocks.layout import Rows

__all__ = ["affine", "column", "largest", "product", "total"]


def column(values: object) -> np.ndarray:
    """Constants as an (n, 1) column (or (n, m, 1)), so that they meet (n, n_cases) arrays row by row."""
    return np.asarray(values, dtype=float)[..., np.newaxis]


def total(rows: Rows) -> Rows:
    """Sum of the rows, (n_cases,), left to right."""
    return reduce(add, list(rows))


def largest(rows: Rows) -> Rows:
    """Largest of the rows, (n_cases,)."""
    return reduce(np.maximum, list(rows))


def product(matrix: Rows, vector: Rows) -> Rows:
    """Matrix times vector for every case, (n, n_cases), summed left to right over the columns.

    Parameters
    ----------
    matrix : (n, m, n_cases) or (n, m, 1) array
        One matrix per case, or one for all (`column`).
    vector : (m, n_cases) array
        One vector per case.
    """
    return reduce(add, [matrix[:, j] * vector[j] for j in range(matrix.shape[1])])


def affine(tables: np.ndarray, rho: Rows) -> Rows:
    """Matrix ``T0 + T1 rho_1 + ... + Tn rho_n`` for every case, (rows, columns, n_cases).

    Parameters
    ----------
    tables : (n + 1, rows, columns, 1) array
        Constant part first.
    rho : (n, n_cases) array
        Scheduling parameters [-].
    """
    return reduce(add, [tables[j + 1] * rho[j] for j in range(len(tables) - 1)], tables[0])
