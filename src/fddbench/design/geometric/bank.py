"""A bank of residual generators: one per fault that sees it and is blind to the others, whatever rho does."""

import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fddbench.design.geometric.affine import Box, family, numbers
from fddbench.design.geometric.generator import ResidualGenerator, identity_error
from fddbench.design.geometric.invariance import unobservability_subspace
from fddbench.design.geometric.one_state import one_state_row
from fddbench.design.geometric.solvability import require_solvable, solvability, span
from fddbench.design.geometric.stabilise import stabilise
from fddbench.design.geometric.subspaces import TOLERANCE, Matrix, complement, kernel, subspace_sum
from fddbench.design.solver import require_known
from fddbench.errors import DesignError

__all__ = ["residual_generator"]

_IDENTITY = 1e-8
"""Largest misfit of the identity, relative to the size of its terms, of a filter that is handed out [-]."""


def residual_generator(
    A: ArrayLike,
    B: ArrayLike,
    C: ArrayLike,
    faults: Mapping[str, ArrayLike],
    *,
    box: Sequence[Sequence[float]] | None = None,
    decay: float = 1.0,
    watch: Sequence[str] | None = None,
    one_state: bool = False,
    solver: str = "CLARABEL",
) -> dict[str, ResidualGenerator]:
    """A bank: for every watched fault a residual generator that is blind to all others.

    Parameters
    ----------
    A, B : (n_parameters + 1, n, n), (n_parameters + 1, n, n_u) arrays
        ``x' = A(rho) x + B(rho) u + sum_i L_i(rho) v_i``, constant part first; (n, n) and (n, n_u) without parameters.
    C : (n_y, n) matrix
        ``y = C x``, of full row rank.
    faults : mapping of str to (n_parameters + 1, n, m) array, (n, m) matrix or (n,) vector
        Directions L_i(rho) by name: actuators, or disturbances that the filters shall not see.
    box : (n_parameters, 2) array, optional
        ``[low, high]`` of each parameter; needed where there are any.
    decay : float
        Least decay rate of the errors [1/s]: faster finds sooner and hears more noise.
    watch : sequence of str, optional
        Faults that get a filter; all when left out.
    one_state : bool
        Whether to make filters of one state, ``w' = -decay w ...``, where a row of the outputs allows it; then N is constant.
        The row is the one that shows the fault best at its worst point of the box.
    solver : {"CLARABEL", "SCS", "MOSEK"}

    Raises
    ------
    DesignError
        Shapes do not fit, a fault cannot be isolated (it and the others are named), or no gain is stable enough.

    References
    ----------
    The LPV detection filter paper, Propositions 3 and 4, Appendix A; its printed (A18) is not the filter of its own gains.

    Examples
    --------
    >>> A = np.array([[-1.0, 1.0], [0.0, -2.0]])
    >>> bank = residual_generator(A, np.eye(2), np.eye(2), {"a": [1.0, 0.0], "b": [0.0, 1.0]}, decay=3.0)
    >>> bank["a"].N.ravel(), bank["a"].G.ravel()
    (array([-3.]), array([-2., -1.]))
    """
    A_ = family("A", A, (None, None))
    n, n_p = A_.shape[1], len(A_) - 1
    A_, B_ = family("A", A_, (n, n)), family("B", B, (n, None), n_p)
    C_ = _outputs(C, n)
    _refuse_options(faults, watch, decay, solver)
    L = {name: _direction(name, M, n, n_p) for name, M in faults.items()}
    limits = Box.of(box, n_p)
    plant = _Plant(A_, B_, C_, L, limits)
    return {name: _generator(plant, name, decay, one_state, solver) for name in (watch or L)}


@dataclass(frozen=True, eq=False)
class _Plant:
    """What a bank is made for."""

    A: Matrix
    B: Matrix
    C: Matrix
    L: Mapping[str, Matrix]
    box: Box


def _generator(plant: _Plant, name: str, decay: float, one_state: bool, solver: str) -> ResidualGenerator:
    """Filter of one fault."""
    A, B, C, box, L = plant.A, plant.B, plant.C, plant.box, plant.L[name]
    others = [span(M) for other, M in plant.L.items() if other != name]
    hidden = subspace_sum(np.zeros((A.shape[1], 0)), *others)
    S = unobservability_subspace(list(A), C, hidden)
    found = solvability(S, L, box)
    require_solvable(name, found, A, C, plant.L, box)
    row = one_state_row(A, C, hidden, L, box) if one_state else None
    if row is not None:
        P, H = row @ C, row
    else:
        P = complement(S).T
        H = complement(subspace_sum(kernel(C), S)).T @ np.linalg.pinv(C)
    back, PD0 = np.linalg.pinv(P), _kept_inside(P, A, C)
    M, A0 = H @ C @ back, (P @ A + PD0 @ C) @ back
    stable = stabilise(A0, M, box, decay=decay, solver=solver)
    N, G = A0 + stable.D1 @ M, PD0 + stable.D1 @ H
    error = identity_error(N, G, P, A, C)
    if error > _IDENTITY:
        raise DesignError(
            f"the filter of fault {name!r} misses N P = P A + G C by {error:.2g} of its terms, so it would not decouple: the "
            "numbers of A, C and the directions are too badly scaled. Choose units in which they are about one"
        )
    return ResidualGenerator(
        fault=name, N=N, G=G, F=P @ B, M=M, H=H, P=P, PL=P @ L, X=stable.X, decay=decay, active=stable.active,
        solvability=found, identity_error=error,
    )  # fmt: skip


def _kept_inside(P: Matrix, A: Matrix, C: Matrix) -> Matrix:
    """``P D0_j``, ``P (A_j + D0_j C) S = 0`` for the kernel S of P, (n_parameters + 1, k, n_y), the smallest such numbers."""
    S = kernel(P)
    return -(P @ A @ S) @ np.linalg.pinv(C @ S, rcond=TOLERANCE) if S.shape[1] else np.zeros((len(A), len(P), len(C)))


def _outputs(C: ArrayLike, n: int) -> Matrix:
    """C as a matrix of full row rank."""
    matrix = np.atleast_2d(numbers("C", C))
    if matrix.ndim != 2 or matrix.shape[1] != n:
        raise DesignError(f"C has shape {np.shape(C)}, needs (any, {n}): it does not depend on the parameters")
    if not np.all(np.isfinite(matrix)):
        raise DesignError("C has numbers that are not finite")
    if np.linalg.matrix_rank(matrix) < len(matrix):
        raise DesignError("outputs say the same: C has not full row rank; leave out rows, or average them")
    return matrix


def _direction(name: str, M: ArrayLike, n: int, n_parameters: int) -> Matrix:
    """Direction of a fault, whose columns are that many inputs."""
    L = family(f"the direction of fault {name!r}", M, (n, None), n_parameters)
    if not np.any(L):
        raise DesignError(f"fault {name!r} has no direction: all its numbers are zero")
    lengths = np.linalg.norm(L, axis=(0, 1))
    rank = int(np.linalg.matrix_rank(np.vstack(list(L / np.where(lengths > 0.0, lengths, 1.0))), tol=TOLERANCE))
    if rank < L.shape[2]:
        raise DesignError(
            f"the direction of fault {name!r} has {L.shape[2]} columns that say only {rank}: one is zero or "
            "the sum of others. Leave it out"
        )
    return L


def _refuse_options(faults: object, watch: Sequence[str] | None, decay: object, solver: str) -> None:
    """Options that mean nothing, whatever the matrices."""
    if not isinstance(faults, Mapping) or not faults:
        raise DesignError(
            f"faults are directions by name, one or more: {{'elevator': L, ...}}; got {reprlib.repr(faults)}"
        )
    if watch is not None and (isinstance(watch, str) or not isinstance(watch, Sequence) or not watch):
        known = ", ".join(map(str, faults))
        raise DesignError(f"watch is a list of faults out of {known}, or left out for all; got {reprlib.repr(watch)}")
    unknown = [name for name in watch or () if name not in faults]
    if unknown:
        raise DesignError(f"no fault is called {', '.join(map(repr, unknown))}; known: {', '.join(map(str, faults))}")
    if not isinstance(decay, int | float | np.number) or not 0.0 < decay < np.inf:
        raise DesignError(f"decay is a rate in 1/s above 0, got {decay!r}")
    require_known(solver)
