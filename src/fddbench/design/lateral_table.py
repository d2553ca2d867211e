"""Yaw and sideward acceleration of an aircraft as polynomials of its flight condition."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product as every
from typing import Any

import numpy as np
from scipy.stats import qmc

from fddbench.errors import DesignError
from fddbench.flight.atmosphere import FT_M, true_airspeed_m_s
from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.lateral_lpv import SCHEDULING, LateralLpv
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.body import body_of
from fddbench.flight.transport.linear import LATERAL, linearised
from fddbench.flight.transport.trim import trim
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["Fitted", "accelerations", "lpv_table", "transport_table"]

_CONTROLS = ("rudder", "aileron_1", "aileron_3", "spoiler")
_SIGNS = ((0, (1,)), (1, (1, -1)), (3, (1, -1)), (5, (1, -1) * 4))
"""First column and signs of rudder, ailerons 1 and 2, 3 and 4, and spoilers."""
_PRUNED = 0.01
"""Terms below this share of a row's size over the envelope are left out."""


@dataclass(frozen=True)
class Fitted:
    """A table as a design has it, and the largest error of each row over the envelope, as a share of its mean size [-]."""

    table: Mapping[str, Any]
    yaw_error: tuple[float, ...]
    side_error: tuple[float, ...]


def lpv_table(model: LateralLpv) -> Fitted:
    """Table of the published model: affine, so exact.

    Raises
    ------
    DesignError
        Surfaces of a pair that do not act against each other.
    """
    A, B = model.tables["A"][..., 0], model.tables["B"][..., 0]
    controls = np.stack([B[:, :, first] for first, _ in _SIGNS], axis=2)
    again = np.concatenate([controls[:, :, [j]] * np.array(signs) for j, (_, signs) in enumerate(_SIGNS)], axis=2)
    if not np.allclose(again[:, [1, 3]], B[:, [1, 3]], rtol=0.0, atol=1e-12):
        raise DesignError("recipe.aircraft: surfaces of a pair must act against each other, spoilers alike")
    n = len(SCHEDULING)
    yaw = np.concatenate([A[:, 3, 1:], DEG_PER_RAD * controls[:, 3]], axis=1)
    side = np.concatenate([A[:, 1], DEG_PER_RAD * controls[:, 1]], axis=1)
    table = {
        "centre": model.trim[:, 0].tolist(),
        "half_width": model.scale[:, 0].tolist(),
        "powers": np.vstack([np.zeros((1, n), int), np.eye(n, dtype=int)]).tolist(),
        "yaw": _digits(yaw.T),
        "side": _digits(side.T),
        "bank_cubic": 0.0,
    }
    return Fitted(table, (0.0,) * 7, (0.0,) * 8)


def accelerations(aircraft: Aircraft, condition: Floats) -> tuple[Floats, Floats]:
    """Rows of yaw, (7, n), and of side acceleration, (8, n), of an aircraft in level trim, in the units of a table.

    Parameters
    ----------
    condition : (4, n) array
        Mass [kg], centre of gravity [-], altitude [ft], calibrated airspeed [kt].
    """
    mass, x_cg, altitude, v_cas = condition
    body = body_of(aircraft, mass, x_cg)
    at = trim(aircraft, body, true_airspeed_m_s(v_cas, altitude), altitude * FT_M)
    A, B = linearised(aircraft, body, at).part(LATERAL, _CONTROLS)
    # surfaces in rad there and in degrees here, and so is what they move
    return np.concatenate([A[3, 1:], B[3]]), np.concatenate([A[1], B[1]])


def transport_table(
    aircraft: Aircraft, envelope: Mapping[str, tuple[float, float]], degree: int, points: int
) -> Fitted:
    """Polynomials of a total degree through an aircraft linearised at trims spread evenly over an envelope.

    Terms that hardly count are left out and the others fitted again.

    Parameters
    ----------
    envelope : mapping of str to (low, high)
        By the names of the scheduling parameters.
    points : int
        How many trims; those beyond buffet, thrust, V_MO or M_MO are left out.

    Raises
    ------
    DesignError
        Too few of them can be flown.
    """
    low, high = (np.array([envelope[name][j] for name in SCHEDULING]) for j in (0, 1))
    inside = qmc.Halton(4, scramble=False).random(points + 1)[1:]
    condition = (low + (high - low) * inside).T
    reasons = infeasible_reasons(condition[0], condition[2], condition[3], aircraft=aircraft)
    condition = condition[:, [not reason for reason in reasons]]
    powers = np.array([p for p in every(range(degree + 1), repeat=4) if sum(p) <= degree])
    powers = powers[np.argsort(powers.sum(axis=1), kind="stable")]
    if condition.shape[1] < 4 * len(powers):
        raise DesignError(
            f"recipe.envelope: only {condition.shape[1]} of {points} trims can be flown, a fit of degree {degree} needs "
            f"{4 * len(powers)}; make the envelope smaller or points larger"
        )
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    x = (condition - centre[:, np.newaxis]) / half[:, np.newaxis]
    monomials = np.prod(x[np.newaxis] ** powers[:, :, np.newaxis], axis=1)
    (yaw, yaw_error), (side, side_error) = (_fit(rows, monomials) for rows in accelerations(aircraft, condition))
    used = [j for j in range(len(powers)) if j == 0 or np.any(yaw[:, j]) or np.any(side[:, j])]
    table = {
        "centre": centre.tolist(), "half_width": half.tolist(), "powers": powers[used].tolist(),
        "yaw": _digits(yaw[:, used]), "side": _digits(side[:, used]), "bank_cubic": _digits(1.0 / 6.0),
    }  # fmt: skip
    return Fitted(table, yaw_error, side_error)


def _fit(rows: Floats, monomials: Floats) -> tuple[Floats, tuple[float, ...]]:
    """Coefficients of every row, (n_rows, n_monomials), and the largest error of each as a share of its mean size."""
    found = np.zeros((len(rows), len(monomials)))
    errors = []
    for i, row in enumerate(rows):
        size = float(np.abs(row).mean())
        whole = np.linalg.lstsq(monomials.T, row, rcond=None)[0]
        counts = np.abs(whole) * np.sqrt((monomials**2).mean(axis=1)) > _PRUNED * size
        counts[0] = True
        found[i, counts] = np.linalg.lstsq(monomials[counts].T, row, rcond=None)[0]
        errors.append(float(np.abs(found[i] @ monomials - row).max() / size))
    return found, tuple(errors)


def _digits(values: Any) -> Any:
    """Seven digits, far below what is known of an aircraft, the same on every machine."""
    if isinstance(values, np.ndarray):
        return [_digits(value) for value in values]
    return float(f"{float(values):.7g}")
