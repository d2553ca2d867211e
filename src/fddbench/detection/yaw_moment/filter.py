"""Kalman filter on the yaw-moment equation alone, which coasts when it is told not to trust the sensors."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, record
from fddbench.blocks.linear import total
from fddbench.detection.yaw_moment.equation import YawAcceleration
from fddbench.detection.yaw_moment.gains import YawMomentGains

__all__ = ["YawMomentFilter", "YawMomentState"]

_N = 5
_PLACES = tuple((i, j) for i in range(_N) for j in range(i, _N))
"""Upper triangle of P, row after row."""
_AT = {place: k for k, place in enumerate(_PLACES)} | {(j, i): k for k, (i, j) in enumerate(_PLACES)}
_FIRST_RATE_DEG_S = 10.0
"""Standard deviation of r before the first sample [deg/s]: that sample sets it."""


@record
class YawMomentState:
    """Prediction for this sample: x = [r deg/s, b deg/s^2, three shares], and the upper triangle of its covariance P."""

    x: tuple[Row, ...]
    P: tuple[Row, ...]

    @property
    def r_deg_s(self) -> Row:
        """Predicted yaw rate [deg/s], (n_cases,)."""
        return self.x[0]

    @property
    def variance(self) -> Row:
        """Of the predicted yaw rate [(deg/s)^2], (n_cases,)."""
        return self.P[0]


class YawMomentFilter:
    """``r' = (1 + s_1) N_v V_a + (1 + s_2) N_p p + (1 + s_3) N_u u + N_r r + b`` with b and the shares s walking slowly.

    The filter is extended by what its parameters do not know, so a turn or a gust teaches it the share by which a moment is
    wrong before a fault makes it coast. Only the first row of the transition matrix is not that of the identity, which makes
    the propagation of P 30 products and its correction 15.

    Parameters
    ----------
    gains : YawMomentGains
        What it believes.
    sample_s : float
        Sample time [s].
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS
    states = Layout(YawMomentState(x=(0,) * _N, P=(0,) * len(_PLACES)))

    def __init__(self, gains: YawMomentGains, sample_s: float) -> None:
        g, self.sample_s = gains, sample_s
        walks = (g.rate_walk_deg_s_sqrt_s, g.acceleration_walk_deg_s2_sqrt_s, *g.share_walk_ratio_sqrt_s)
        self.Q = [walk * walk * sample_s for walk in walks]
        self.prior = [s * s for s in (_FIRST_RATE_DEG_S, g.acceleration_prior_deg_s2, *g.share_prior_ratio)]
        self.noise = g.sensor_noise_deg_s * g.sensor_noise_deg_s
        self.bias = g.sensor_bias_deg_s * g.sensor_bias_deg_s

    def start(self, c: Nothing) -> YawMomentState:
        """At rest, knowing nothing of r."""
        del c
        P = tuple(self.prior[i] if i == j else 0.0 for i, j in _PLACES)
        return YawMomentState(x=(0.0,) * _N, P=P)

    def innovation_variance(self, x: YawMomentState) -> Row:
        """Variance of one sensor less its prediction [(deg/s)^2], (n_cases,)."""
        return x.variance + (self.noise + self.bias)

    def step(
        self, x: YawMomentState, c: Nothing, n: Nothing, r_deg_s: Row, n_live: Row, trusted: Row, parts: YawAcceleration
    ) -> tuple[YawMomentState, Row]:
        """Prediction for the next sample, and the estimate of the yaw rate at this one [deg/s], (n_cases,).

        Parameters
        ----------
        r_deg_s, n_live : (n_cases,) rows
            Mean of the sensors that are not declared [deg/s], and how many they are.
        trusted : (n_cases,) row of bool
            Whether to correct the prediction with it; else the filter coasts.
        parts : YawAcceleration
            Of this sample.
        """
        del c, n
        P = x.P
        S = P[0] + (self.noise / np.maximum(n_live, 1.0) + self.bias)
        gain = np.where(trusted & (n_live > 0.5), 1.0 / S, 0.0)
        K = [P[j] * gain for j in range(_N)]
        e = r_deg_s - x.x[0]
        now = [x.x[j] + K[j] * e for j in range(_N)]
        corrected = [P[k] - K[i] * P[j] for k, (i, j) in enumerate(_PLACES)]
        return YawMomentState(x=self._moved(now, parts), P=self._spread(corrected, parts)), now[0]

    def _moved(self, x: list[Row], a: YawAcceleration) -> tuple[Row, ...]:
        """State a sample later."""
        known = a.sideslip_deg_s2 + a.roll_deg_s2 + a.surfaces_deg_s2 + a.damping_1_s * x[0]
        unknown = x[1] + x[2] * a.sideslip_deg_s2 + x[3] * a.roll_deg_s2 + x[4] * a.surfaces_deg_s2
        return (x[0] + self.sample_s * (known + unknown), *x[1:])

    def _spread(self, P: list[Row], a: YawAcceleration) -> tuple[Row, ...]:
        """Covariance a sample later: ``F P F' + Q`` with F the identity but for its first row."""
        T = self.sample_s
        parts = (a.sideslip_deg_s2, a.roll_deg_s2, a.surfaces_deg_s2)
        first = [1.0 + T * a.damping_1_s, T, *(T * part for part in parts)]
        rows = [total([P[_AT[i, j]] * first[i] for i in range(_N)]) for j in range(_N)]
        top = [total([first[j] * rows[j] for j in range(_N)]) + self.Q[0], *rows[1:]]
        rest = [P[k] + self.Q[i] if i == j else P[k] for k, (i, j) in enumerate(_PLACES) if i > 0]
        return (*top, *rest)
