"""Residuals of a plant without uncertainty: a bank of unknown-input observers, and the reference that it makes.

Residual i comes from an observer to which the other faults are unknown inputs; what freedom is left, its gain, makes the
disturbances small in the mean square. The response of this bank to faults is the reference of the two-step method: first a
residual generator for the plant as if it were known, then a robust filter that follows it.

References
----------
Frisk, Nielsen (2006), Robust residual generation for diagnosis including a reference model for residual behavior, Automatica
42(3), 437-445.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, solve_continuous_are

from fddbench.design.gramians import balancing
from fddbench.design.norms import hminus_index
from fddbench.design.problem import Filter
from fddbench.design.unknown_input import Decoupled, decoupled
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant, series

__all__ = ["nominal_reference", "observer_bank"]


@dataclass(frozen=True, kw_only=True)
class _Observer:
    """One observer from (y, u) to its residual."""

    A: Floats
    B_y: Floats
    B_u: Floats
    C: Floats
    D_y: Floats
    D_u: Floats


def observer_bank(plant: UncertainPlant) -> Filter:
    """Nominal filter whose residual i no other fault moves, and which is fault i in steady state.

    Raises
    ------
    DesignError
        The other faults cannot be decoupled for one of the residuals, with the condition that fails; or the fault itself
        does not move its residual.
    """
    parts = [_observer(plant, i) for i in range(plant.Bf.shape[1])]
    return Filter(
        Ak=block_diag(*(p.A for p in parts)), Bky=np.vstack([p.B_y for p in parts]), Bku=np.vstack([p.B_u for p in parts]),
        Ck=block_diag(*(p.C for p in parts)), Dky=np.vstack([p.D_y for p in parts]), Dku=np.vstack([p.D_u for p in parts]),
    )  # fmt: skip


def nominal_reference(plant: UncertainPlant) -> StateSpace:
    """Diagonal reference of first order in each channel: what the faults make of `observer_bank`, scaled to ‖T_ref‖₋ = 1."""
    faults = _from_faults(plant, observer_bank(plant))
    n = plant.Bf.shape[1]
    channels = [
        _first_order(StateSpace(faults.A, faults.B[:, [i]], faults.C[[i]], faults.D[[i]][:, [i]])) for i in range(n)
    ]
    a, c, d = np.array(channels).T
    least = hminus_index(StateSpace.diagonal(a, np.ones(n), c, d)).value
    return StateSpace.diagonal(a, np.ones(n), c / least, d / least)


def _observer(plant: UncertainPlant, i: int) -> _Observer:
    """Observer of residual i, its gain the Kalman filter's for the disturbances as white noise."""
    others = [j for j in range(plant.Bf.shape[1]) if j != i]
    free = decoupled(
        plant.A, plant.B, plant.C, plant.D, E_x=plant.Bf[:, others], E_y=plant.Df[:, others],
        what=f"the faults beside fault {i + 1}",
    )  # fmt: skip
    F0, L = free.T @ free.A, _gain(plant, free)
    F, HS, HSD = F0 - L @ free.SC, free.H @ free.S, free.H @ free.SD
    C, D_y, D_u = -free.SC, free.S - free.SC @ HS, -free.SD + free.SC @ HSD
    B_y, B_u = F @ HS + free.T @ free.B_y + L @ free.S, -F @ HSD + free.T @ free.B_u - L @ free.SD
    seen = _from_faults(plant, Filter(Ak=F, Bky=B_y, Bku=B_u, Ck=C, Dky=D_y, Dku=D_u)).at(0.0).real[:, i]
    size = float(seen @ seen)
    if size < 1e-18:
        raise DesignError(f"fault {i + 1} does not move its own residual in steady state: decouple less")
    g = (seen / size)[np.newaxis]  # of several outputs that are left: the combination that sees the fault, as 1
    return _Observer(A=F, B_y=B_y, B_u=B_u, C=g @ C, D_y=g @ D_y, D_u=g @ D_u)


def _gain(plant: UncertainPlant, free: Decoupled) -> Floats:
    """Gain of the steady Kalman filter of what is left, with correlated noise of state and output."""
    G = free.T @ (plant.Bd - free.B_y @ plant.Dd)
    N = free.S @ plant.Dd
    R, cross = N @ N.T, G @ N.T
    # what the projection T leaves out has no rate of its own: noise there makes the filter forget it
    Q = G @ G.T + free.E @ free.E.T
    try:
        P = solve_continuous_are((free.T @ free.A).T, free.SC.T, Q, R, s=cross)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise DesignError(
            "no steady Kalman filter: each output that is left needs a disturbance of its own (R = S Dd Dd' S' regular)"
        ) from error
    found: Floats = (P @ free.SC.T + cross) @ np.linalg.inv(R)
    return found


def _from_faults(plant: UncertainPlant, filter_: Filter) -> StateSpace:
    """From the faults to the residuals on the nominal plant, inputs at rest."""
    n_u, n_f = plant.B.shape[1], plant.Bf.shape[1]
    seen = StateSpace(
        plant.A, plant.Bf, np.vstack([plant.C, np.zeros((n_u, plant.n_x))]), np.vstack([plant.Df, np.zeros((n_u, n_f))])
    )
    return series(seen, filter_.as_system())


def _first_order(system: StateSpace) -> tuple[float, float, float]:
    """a, c, d of ``c / (s - a) + d``: of the balanced states of one channel the one that matters most."""
    change = balancing(system.A, system.B, system.C)
    A, B, C = np.linalg.solve(change, system.A @ change), np.linalg.solve(change, system.B), system.C @ change
    first = int(np.argmax(np.abs(B[:, 0] * C[0] / np.diag(A))))
    return float(A[first, first]), float(B[first, 0] * C[0, first]), float(system.D[0, 0])
