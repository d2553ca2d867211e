"""Linear-quadratic tracking with integral action, and the feedforward that makes responses those of the models.

States of the law are the response models, speed by a complementary filter (airspeed below its corner, acceleration above, so
that engines do not chase gusts) and the integrals of model minus response; the engines' thrust is not fed back.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_are

from fddbench.design.tracking.aircraft import ACTUATORS, LinearAircraft
from fddbench.design.tracking.interconnection import CONTROLS
from fddbench.design.tracking.reference import models
from fddbench.design.tracking.wiring import wire
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["Tolerances", "lqi_law", "regulator"]

_TRACKED = np.array([[-1.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0]])
"""Flight path and speed of alpha, q, V, theta and thrust."""


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Bryson's rule: a deviation of this size costs one.

    Attributes
    ----------
    settling_s : (2,)
        Of the responses to follow: flight path, speed [s].
    error, integral : (2,)
        Deviations from the models [deg, m/s] and their integrals [deg s, m].
    pitch_rate_deg_s : float
        Pitch rate [deg/s].
    order : (2,)
        Elevator [deg] and thrust [kN].
    speed_filter_s : float
        Time constant of the complementary filter of speed [s].
    """

    settling_s: tuple[float, float]
    error: tuple[float, float]
    integral: tuple[float, float]
    pitch_rate_deg_s: float
    order: tuple[float, float]
    speed_filter_s: float


def lqi_law(flying: LinearAircraft, tolerances: Tolerances) -> StateSpace:
    """The law for a trim, in deg and kN: ``u = Γ m + Γc c - K (x - Π m - Πc c) - K_i ∫(m - y)``, thrust left out of x.

    Inputs are errors and measured signals, `fddbench.benchmarks.b747_longitudinal.laws.law_file.INPUTS`; the integrals are the
    last two states.
    """
    A, B = _with_engines(flying)
    K, K_i = _gains(A, B, tolerances)
    model = models(*tolerances.settling_s).system
    # the models with constant commands as states: (m, c)
    S = np.zeros((6, 6))
    S[:4, :4], S[:4, 4:] = model.A, model.B
    C_m = np.zeros((2, 6))
    C_m[0, 0] = C_m[1, 2] = 1.0
    steady_x, steady_u = regulator(A, B, _TRACKED, S, C_m)
    forward = steady_u + K @ steady_x
    # inputs of the law: errors, then flight path, acceleration, pitch, pitch rate, speed; command = error + measured
    commands = np.zeros((2, 7))
    commands[0, [0, 2]] = commands[1, [1, 6]] = 1.0
    state = np.zeros((4, 7))  # alpha = pitch - flight path, q, pitch; speed comes from its filter
    state[0, [2, 4]] = -1.0, 1.0
    state[1, 5] = state[3, 4] = 1.0
    A_law, B_law = np.zeros((7, 7)), np.zeros((7, 7))
    A_law[:4, :4], B_law[:4] = model.A, model.B @ commands
    A_law[4, 4], B_law[4, [3, 6]] = -1.0 / tolerances.speed_filter_s, (GRAVITY_M_S2, 1.0 / tolerances.speed_filter_s)
    A_law[5, 0] = A_law[6, 2] = 1.0
    B_law[5, 2] = B_law[6, 6] = -1.0
    C_law = np.hstack([forward[:, :4], -K[:, [2]], -K_i])
    return StateSpace(A_law, B_law, C_law, forward[:, 4:] @ commands - K[:, :4] @ state)


def _with_engines(flying: LinearAircraft) -> tuple[Floats, Floats]:
    """A and B of alpha, q, V, theta and thrust; the elevator is so fast that its order is its position."""
    system = wire(
        [flying.block(altitude=False), ACTUATORS[1]],
        {"elevator": {"elevator_order": 1.0}, "stabiliser": {}, "gust": {}},
        inputs=CONTROLS,
        outputs={},
    )
    return system.A, system.B


def _gains(A: Floats, B: Floats, t: Tolerances) -> tuple[Floats, Floats]:
    """Gains on the state without thrust (its column is zero), (2, 5), and on the integrals, (2, 2)."""
    A_i, B_i = np.zeros((7, 7)), np.vstack([B, np.zeros((2, 2))])
    A_i[:5, :5], A_i[5:, :5] = A, -_TRACKED
    Q = np.diag([0.0, t.pitch_rate_deg_s**-2, 0.0, 0.0, 0.0, *np.power(t.integral, -2.0)])
    Q[:5, :5] += _TRACKED.T @ np.diag(np.power(t.error, -2.0)) @ _TRACKED
    R = np.diag(np.power(t.order, -2.0))
    K = np.linalg.solve(R, B_i.T @ solve_continuous_are(A_i, B_i, Q, R))
    feedback = K[:, :5].copy()
    feedback[:, 4] = 0.0
    return feedback, K[:, 5:]


def regulator(A: Floats, B: Floats, C: Floats, S: Floats, C_m: Floats) -> tuple[Floats, Floats]:
    """State and input that make ``C x`` follow ``C_m w`` of ``w' = S w``: ``x = Π w, u = Γ w``.

    They solve ``Π S = A Π + B Γ, C Π = C_m``.

    References
    ----------
    Francis (1977), The linear multivariable regulator problem, SIAM J. Control and Optimization 15(3), 486-505.
    """
    n, m, p = len(A), B.shape[1], len(S)
    one = np.eye(p)
    motion = [np.kron(S.T, np.eye(n)) - np.kron(one, A), -np.kron(one, B)]
    output = [np.kron(one, C), np.zeros((len(C) * p, m * p))]
    right = np.concatenate([np.zeros(n * p), C_m.T.ravel()])
    found = np.linalg.solve(np.block([motion, output]), right)
    return found[: n * p].reshape(p, n).T, found[n * p :].reshape(p, m).T
