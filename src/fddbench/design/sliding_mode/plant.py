"""What a sliding-mode observer is designed for: an LPV plant with faults that enter its states, steps 1 to 3 of section 4.1."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.design.geometric.affine import Box
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["FaultyPlant", "with_sensor_faults"]


@dataclass(frozen=True, kw_only=True, eq=False)
class FaultyPlant:
    """``x' = A(rho) x + F f + M xi, y_m = C x + d``, as eqs (8) and (9); known inputs cancel in the error and are left out.

    Attributes
    ----------
    A : (n_rho + 1, n, n) array
        Constant part first, then the factor of each parameter in its unit.
    C : (p, n) array
        Full row rank.
    F : (n, q) array
        How the faults enter; of sensors by the filters on their outputs.
    M : (n, n_xi) array
        How the uncertainty enters.
    corrupted : tuple of p bools
        Outputs that d falsifies; those that are filtered are not.
    box : Box
        Range of every parameter.
    """

    A: Floats
    C: Floats
    F: Floats
    M: Floats
    corrupted: tuple[bool, ...]
    box: Box

    @property
    def vertices(self) -> Floats:
        """Corners of the box in the parameters that move A, the others in the middle, (n_vertices, n_rho)."""
        return self.box.corners(self.box.active(self.A))


def with_sensor_faults(
    A: Floats, C: Floats, *, suspects: Sequence[int], filter_poles: Sequence[float], M: Floats, box: Box
) -> FaultyPlant:
    """Plant whose suspect outputs pass the filters ``z_f' = -A_f z_f + A_f y``, eqs (6) to (9).

    The state is [x, z_f] in the plant's own order; outputs are the trusted ones in their order, then z_f.

    Parameters
    ----------
    A : (n_rho + 1, n, n) array
    C : (p, n) array
    suspects : sequence of int
        Rows of C that may be faulty, q < p of them.
    filter_poles : q numbers
        Diagonal of A_f [1/s].
    M : (n, n_xi) array
        M_p of eq (1).
    box : Box

    Raises
    ------
    DesignError
        Every output is suspect, a row stands twice, or C has not full row rank.
    """
    (n_rho, n), p, q = (len(A) - 1, A.shape[1]), len(C), len(suspects)
    if not 0 < q < p or len(set(suspects)) < q:
        raise DesignError(
            f"{q} of {p} outputs are suspect: at least one must be, each once, and at least one must be trusted, because the "
            "fault is what the trusted outputs and the model contradict (n_q < n_p, section 4). Trust one more output"
        )
    if np.linalg.matrix_rank(C) < p:
        raise DesignError(
            f"C has rank {np.linalg.matrix_rank(C)}, needs {p}: leave out outputs that others already tell"
        )
    trusted = [row for row in range(p) if row not in suspects]
    A_f = np.diag(np.asarray(filter_poles, dtype=float))
    whole = np.zeros((n_rho + 1, n + q, n + q))
    whole[:, :n, :n] = A
    whole[0, n:, :n], whole[0, n:, n:] = A_f @ C[list(suspects)], -A_f
    outputs = np.block([[C[trusted], np.zeros((p - q, q))], [np.zeros((q, n)), np.eye(q)]])
    return FaultyPlant(
        A=whole,
        C=outputs,
        F=np.vstack([np.zeros((n, q)), A_f]),
        M=np.vstack([M, np.zeros((q, M.shape[1]))]),
        corrupted=(True,) * (p - q) + (False,) * q,
        box=box,
    )
