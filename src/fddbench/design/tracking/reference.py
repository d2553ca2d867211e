"""The responses to commands that a law is designed to follow."""

import numpy as np
from scipy.optimize import brentq

from fddbench.design.tracking.wiring import Block
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["BAND", "corner_rad_s", "models", "settling_s"]

BAND = 0.05
"""A response has settled when it stays within this share of its step."""
_SETTLED = float(brentq(lambda x: (1.0 + x) * np.exp(-x) - BAND, 1.0, 20.0))


def corner_rad_s(settling_s: float) -> float:
    """Corner ω of the critically damped ``ω² / (s + ω)²`` that settles in this time [rad/s].

    >>> round(corner_rad_s(15.0), 4)
    0.3163
    """
    return _SETTLED / settling_s


def models(flight_path_settling_s: float, speed_settling_s: float) -> Block:
    """Responses to flight-path and speed command, four states: each with its derivative, both also outputs."""
    A, B = np.zeros((4, 4)), np.zeros((4, 2))
    for j, settling in enumerate((flight_path_settling_s, speed_settling_s)):
        w = corner_rad_s(settling)
        A[2 * j : 2 * j + 2, 2 * j : 2 * j + 2] = [[0.0, 1.0], [-w * w, -2.0 * w]]
        B[2 * j + 1, j] = w * w
    names = ["flight_path_model", "flight_path_model_rate", "speed_model", "speed_model_rate"]
    return Block(StateSpace(A, B, np.eye(4), np.zeros((4, 2))), ["flight_path_command", "speed_command"], names)


def settling_s(time_s: Floats, response: Floats, step: float, *, from_s: float) -> float:
    """Time after which a response stays within `BAND` of its step [s]; infinite if it has not.

    >>> t = np.linspace(0.0, 60.0, 6001)
    >>> w = corner_rad_s(15.0)
    >>> round(settling_s(t, 2.0 - 2.0 * (1.0 + w * t) * np.exp(-w * t), 2.0, from_s=0.0), 1)
    15.0
    """
    outside = np.flatnonzero((time_s >= from_s) & (np.abs(response - step) > BAND * abs(step)))
    if not len(outside):
        return 0.0
    return float(time_s[outside[-1] + 1] - from_s) if outside[-1] + 1 < len(time_s) else float("inf")
