"""Small motions around a trim: matrices by central differences of the equations, in Euler angles."""

from typing import NamedTuple

import numpy as np

from fddbench.blocks.functions import cos, sin
from fddbench.blocks.layout import Rows
from fddbench.flight.transport.aerodynamics import Controls
from fddbench.flight.transport.air import air_around
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import Body, attitude, derivative
from fddbench.flight.transport.trim import Trim
from fddbench.flight.wind import still

__all__ = ["INPUTS", "LATERAL", "LONGITUDINAL", "STATES", "Linear", "linearised"]

STATES = ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", "north", "east", "altitude")
"""m/s, rad/s, rad, m."""
INPUTS = (
    *("rudder", "aileron_1", "aileron_3", "spoiler", "elevator", "elevator_difference", "stabiliser"),
    "thrust_ratio",
)
"""rad, as `Controls` has them; share of the thrust."""
LATERAL = ("phi", "v", "p", "r")
LONGITUDINAL = ("u", "w", "q", "theta")
_MOVE = 1e-4


class Linear(NamedTuple):
    """``xdot = A x + B u``, (12, 12, n_cases) and (12, 8, n_cases), in the order of `STATES` and `INPUTS`."""

    A: Rows
    B: Rows

    def part(self, states: tuple[str, ...], inputs: tuple[str, ...]) -> tuple[Rows, Rows]:
        """Rows and columns of some states and inputs."""
        rows, columns = [STATES.index(name) for name in states], [INPUTS.index(name) for name in inputs]
        return self.A[np.ix_(rows, rows)], self.B[np.ix_(rows, columns)]


def linearised(aircraft: Aircraft, body: Body, at: Trim) -> Linear:
    """Matrices of every case around its level trim."""
    zero = np.zeros_like(at.alpha_rad)
    base = at.rows()
    x = np.stack([*base[:6], zero, at.alpha_rad, zero, *base[10:]])
    u = np.stack([zero, zero, zero, zero, zero, zero, at.stabiliser_rad, at.thrust_ratio])

    def slope(rows: Rows, row: int, *, of_state: bool) -> Rows:
        up, down = (np.stack([r + (move if j == row else 0.0) for j, r in enumerate(rows)]) for move in (_MOVE, -_MOVE))
        pairs = ((up, u), (down, u)) if of_state else ((x, up), (x, down))
        above, below = (_derivative(aircraft, body, at, *pair) for pair in pairs)
        return (above - below) / (2.0 * _MOVE)

    A = np.stack([slope(x, row, of_state=True) for row in range(len(STATES))], axis=1)
    B = np.stack([slope(u, row, of_state=False) for row in range(len(INPUTS))], axis=1)
    return Linear(A, B)


def _derivative(aircraft: Aircraft, body: Body, at: Trim, x: Rows, u: Rows) -> Rows:
    """Derivative of the rows of `STATES`."""
    phi, theta, psi = x[6], x[7], x[8]
    found = derivative(
        aircraft, body, air_around(at.altitude_m), np.stack([*x[:6], *attitude(phi, theta, psi), *x[9:]]),
        Controls(**dict(zip(INPUTS[:-1], u, strict=False))), still(phi), u[7],
    )  # fmt: skip
    turn = x[4] * sin(phi) + x[5] * cos(phi)
    psi_dot = turn / cos(theta)
    euler = (x[3] + psi_dot * sin(theta), x[4] * cos(phi) - x[5] * sin(phi), psi_dot)
    return np.stack([*found[:6], *euler, *found[10:]])
