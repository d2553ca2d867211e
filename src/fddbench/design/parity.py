"""Parity vectors: relations among samples of a window that hold whatever the state was, and those that show faults best.

``y[k-s..k] = O x[k-s] + H_u u + H_d d + H_f f + noise``; a parity vector v has ``v O = 0`` and, where that is possible,
``v H_d = 0``; of all these the best has the largest ``v F v' / v N v'`` with covariances F of what faults add to the window
and N of noise.

References
----------
Chow, Willsky (1984), Analytical redundancy and the design of robust failure detection systems, IEEE Transactions on Automatic
Control 29(7), 603-614; Ding (2013), Model-based fault diagnosis techniques, chapter 7.
"""

import numpy as np
from scipy.linalg import eigh, null_space

from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["best_parity_vector", "extended", "parity_vectors"]


def extended(A: Floats, B: Floats, C: Floats, D: Floats, s: int) -> tuple[Floats, Floats]:
    """O and H of a window of s + 1 samples in discrete time, oldest first: ((s+1) n_y, n_x) and ((s+1) n_y, (s+1) n_u)."""
    n_y, n_u = D.shape
    powers = [np.eye(len(A))]
    for _ in range(s):
        powers.append(A @ powers[-1])
    H = np.zeros(((s + 1) * n_y, (s + 1) * n_u))
    for i in range(s + 1):
        for j in range(i + 1):
            block = D if i == j else C @ powers[i - j - 1] @ B
            H[i * n_y : (i + 1) * n_y, j * n_u : (j + 1) * n_u] = block
    return np.vstack([C @ M for M in powers]), H


def parity_vectors(observed: Floats, H_d: Floats, what: str) -> Floats:
    """All parity vectors as rows, orthonormal, blind to the state and to d.

    Parameters
    ----------
    observed : (m, n_x) array
        O.
    H_d : (m, n) array
        What they add to the window; no columns for none.
    what : str
        The disturbances in words, for the message.

    Raises
    ------
    DesignError
        There is none: ``rank [O H_d]`` is the number of rows.
    """
    whole = np.hstack([observed, H_d])
    found: Floats = null_space(whole.T, rcond=1e-10).T
    if not len(found):
        raise DesignError(
            f"no parity relation is blind to {what}: rank [O H_d] = {len(whole)}, the whole window. Needs more outputs than "
            "disturbances; a longer window does not help where each sample of them moves every output. Take them for noise"
        )
    return found


def best_parity_vector(vectors: Floats, fault: Floats, noise: Floats) -> tuple[Floats, float]:
    """The combination of parity vectors with the largest ratio of fault to noise, of unit noise, and that ratio.

    Parameters
    ----------
    vectors : (n, m) array
        As `parity_vectors` gives them.
    fault, noise : (m, m) arrays
        Covariances of what faults and noise add to the window.
    """
    values, combined = eigh(vectors @ fault @ vectors.T, vectors @ noise @ vectors.T)
    v = combined[:, -1] @ vectors
    return v * np.sign(v[np.argmax(np.abs(v))]), float(values[-1])
