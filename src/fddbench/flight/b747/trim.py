"""Steady straight flight by Newton's method, many flights at once: the same bits in any company.

The stabiliser is given (its published position, unless a flight states another) and stays there; angle of attack, elevator
and thrust are solved for, as the paper trims: "EPR and stabilizer deflection commands are held constant".
"""

from collections.abc import Callable

import numpy as np

from fddbench.blocks.layout import Row, Rows, record
from fddbench.blocks.solve import solve
from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import DATA, Aircraft
from fddbench.flight.b747.dynamics import derivative

__all__ = ["Condition", "Trim", "condition", "newton", "trim"]

_STEPS, _TOLERANCE = 12, 1e-9
# size of the unknowns (rad, deg, N) and of the accelerations (rad/s, rad/s^2, m/s^2) that make a step and an error of one
_UNIT = np.array([[0.01], [1.0], [1e4]])
_SIZE = np.array([[1e-2], [1e-2], [1.0]])


@record
class Condition:
    """Where to fly: geometric altitude [m], true airspeed [m/s], flight-path angle [rad], stabiliser [deg]."""

    altitude_m: Row
    v_tas_m_s: Row
    gamma_rad: Row
    stabiliser_deg: Row


@record
class Trim:
    """Steady flight: angle of attack [rad], elevator [deg], thrust per engine [N], and whether there is one (boolean)."""

    alpha_rad: Row
    elevator_deg: Row
    thrust_n: Row
    found: Row


def condition(
    altitude_m: Row, v_tas_m_s: Row, gamma_rad: Row = 0.0, stabiliser_deg: Row = DATA["stabiliser_deg"]
) -> Condition:
    """A condition from numbers or (n_cases,) rows: level flight with the published stabiliser where nothing else is said."""
    rows = np.broadcast_arrays(*np.atleast_1d(altitude_m, v_tas_m_s, gamma_rad, stabiliser_deg))
    altitude, v_tas, gamma, stabiliser = (np.asarray(row, dtype=float) for row in rows)
    return Condition(altitude_m=altitude, v_tas_m_s=v_tas, gamma_rad=gamma, stabiliser_deg=stabiliser)


def newton(accelerations: Callable[[Rows], Rows], n_cases: int) -> Trim:
    """Trim at which alphadot, qdot and Vdot, (3, n_cases), of (alpha [rad], elevator [deg], thrust [N]) vanish.

    Twelve steps with central differences, whatever the company; `found` says where what is left is below 1e-9 of 0.01 rad/s,
    0.01 rad/s^2 and 1 m/s^2.
    """
    z = np.array([[0.03], [0.0], [4e4]]) * np.ones(n_cases)
    with np.errstate(all="ignore"):  # a condition that cannot be flown shows as one that is not found
        for _ in range(_STEPS):
            slopes = []
            for j in range(3):
                h = np.zeros((3, 1))
                h[j] = 1e-4 * _UNIT[j]
                slopes.append((accelerations(z + h) - accelerations(z - h)) / (2e-4 * _SIZE))
            z = z - _UNIT * solve(np.stack(slopes, axis=1), accelerations(z) / _SIZE)
        left = np.abs(accelerations(z) / _SIZE)
        found = (left[0] < _TOLERANCE) & (left[1] < _TOLERANCE) & (left[2] < _TOLERANCE)
    return Trim(alpha_rad=z[0], elevator_deg=z[1], thrust_n=z[2], found=found)


def trim(aircraft: Aircraft, at: Condition) -> Trim:
    """Trim of the nonlinear model in calm air, rows of (n_cases,).

    Examples
    --------
    >>> from fddbench.flight.b747.airframe import aircraft
    >>> found = trim(aircraft(), condition(9000.0, 241.0))
    >>> [round(float(row[0]), 2) for row in (found.alpha_rad, found.elevator_deg, found.thrust_n)]
    [0.02, 1.99, 39439.0]
    """
    around, still = air(at.altitude_m), np.zeros((3, len(at.altitude_m)))

    def accelerations(z: Rows) -> Rows:
        x = np.stack([z[0], np.zeros_like(z[0]), at.v_tas_m_s, z[0] + at.gamma_rad, at.altitude_m])
        return derivative(x, np.stack([z[1], at.stabiliser_deg, z[2]]), still, aircraft, around)[:3]

    return newton(accelerations, len(at.altitude_m))
