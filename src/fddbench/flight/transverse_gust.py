"""A gust across the flight path and its gradient along it, Dryden's v_g with r_g or w_g with q_g, discretised exactly.

With ``s`` in units of tau = L / V, unit white noise w, and kappa = tau / T_b with T_b the lag that smooths the gradient:

    x1' = -x1 + w,   x2' = x1 - x2,   gust = sigma v,   v = sqrt3 x1 + (1 - sqrt3) x2,
    z' = kappa (v - z),   gradient along the path = sigma (v - z) / (V T_b)

which are ``sigma sqrt(tau) (1 + sqrt3 tau s) / (1 + tau s)^2`` and ``(s / V) / (1 + T_b s)`` of it. The gradient has no noise
of its own: it is that of the very gust that is flown through.

Reference: MIL-F-8785C (1980), sections 3.7.1.2 and 3.7.5.
"""

from typing import Any

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record

__all__ = ["TransverseConstants", "TransverseGust", "TransverseState"]

_ROOT3 = float(np.sqrt(3.0))
_SECOND = 1.0 - _ROOT3
_P11, _P21, _P22 = 0.5, 0.25, 0.25


@record
class Lower:
    """Lower triangle L of a covariance ``L L'`` [-]."""

    l11: Row
    l21: Row
    l22: Row
    l31: Row
    l32: Row
    l33: Row

    def times(self, n: Rows) -> tuple[Row, Row, Row]:
        """Three numbers of that covariance from three normals."""
        return (
            self.l11 * n[0],
            self.l21 * n[0] + self.l22 * n[1],
            self.l31 * n[0] + self.l32 * n[1] + self.l33 * n[2],
        )


@record
class TransverseState:
    """The two states of the gust and the smoothed gust [-]."""

    first: Row
    second: Row
    smooth: Row


@record
class TransverseConstants:
    """Transition and noise of a sample [-], intensity [m/s], gradient of a unit of v - z [rad/s], the state before sample 0."""

    decay_ratio: Row
    coupling_ratio: Row
    smooth_first: Row
    smooth_second: Row
    smooth_decay: Row
    noise: Lower
    sigma_m_s: Row
    gradient_rad_s: Row
    start: TransverseState


_LOWER = Lower(l11=ROW, l21=ROW, l22=ROW, l31=ROW, l32=ROW, l33=ROW)
_STATE = TransverseState(first=ROW, second=ROW, smooth=ROW)


class TransverseGust:
    """Gust [m/s] and its gradient along the path [rad/s]; three normals a sample, three before the first."""

    states = Layout(_STATE)
    constants = Layout(
        TransverseConstants(
            decay_ratio=ROW, coupling_ratio=ROW, smooth_first=ROW, smooth_second=ROW, smooth_decay=ROW, noise=_LOWER,
            sigma_m_s=ROW, gradient_rad_s=ROW, start=_STATE,
        )
    )  # fmt: skip

    def prepare(
        self, normals: Rows, *, sigma_m_s: Row, tau_s: Row, lag_s: Row, v_tas_m_s: Row, sample_s: float
    ) -> TransverseConstants:
        """Constants of flights; the start is stationary.

        The noise of a sample is ``P - F P F'`` with the stationary covariance P and the transition F, so P stays at every step.

        Parameters
        ----------
        normals : (3, n_cases) rows
            Before the first sample.
        sigma_m_s, tau_s, lag_s, v_tas_m_s : (n_cases,) rows
            Intensity, tau = L / V, T_b and V; T_b must not be tau itself.
        """
        a, kappa = sample_s / tau_s, tau_s / lag_s
        e, b = exp(-a), exp(-kappa * a)
        # integrals of kappa exp(-kappa (a - s)) times exp(-s) and s exp(-s) from 0 to a
        g0 = kappa * (e - b) / (kappa - 1.0)
        g1 = (kappa * a * e - g0) / (kappa - 1.0)
        F = (e, a * e, _ROOT3 * g0 + _SECOND * g1, _SECOND * g0, b)
        P = _stationary(kappa)
        begun = _cholesky(P).times(normals)
        return TransverseConstants(
            decay_ratio=e, coupling_ratio=F[1], smooth_first=F[2], smooth_second=F[3], smooth_decay=b,
            noise=_cholesky(_gathered(P, F)), sigma_m_s=sigma_m_s, gradient_rad_s=sigma_m_s / (v_tas_m_s * lag_s),
            start=TransverseState(first=begun[0], second=begun[1], smooth=begun[2]),
        )  # fmt: skip

    def start(self, c: TransverseConstants) -> TransverseState:
        """Stationary."""
        return c.start

    def step(self, x: TransverseState, c: TransverseConstants, n: Rows) -> tuple[TransverseState, tuple[Row, Row]]:
        """State at the next sample; gust [m/s] and its gradient along the path [rad/s] at this one."""
        first, second, smooth = c.noise.times(n)
        after = TransverseState(
            first=c.decay_ratio * x.first + first,
            second=c.coupling_ratio * x.first + c.decay_ratio * x.second + second,
            smooth=c.smooth_first * x.first + c.smooth_second * x.second + c.smooth_decay * x.smooth + smooth,
        )
        v = _ROOT3 * x.first + _SECOND * x.second
        return after, (c.sigma_m_s * v, c.gradient_rad_s * (v - x.smooth))


def _stationary(kappa: Row) -> tuple[Any, ...]:
    """Stationary covariance of (x1, x2, z) [-]: P11, P21, P22, P31, P32, P33."""
    p31 = kappa / (1.0 + kappa) * ((1.0 + _ROOT3) / 4.0)
    p32 = (p31 + 0.25 * kappa) / (1.0 + kappa)
    return _P11, _P21, _P22, p31, p32, _ROOT3 * p31 + _SECOND * p32


def _gathered(P: tuple[Any, ...], F: tuple[Any, ...]) -> tuple[Any, ...]:
    """Covariance gathered over a sample, ``P - F P F'``."""
    p11, p21, p22, p31, p32, p33 = P
    e, f, g, h, b = F
    fp21, fp22 = f * p11 + e * p21, f * p21 + e * p22
    fp31, fp32, fp33 = g * p11 + h * p21 + b * p31, g * p21 + h * p22 + b * p32, g * p31 + h * p32 + b * p33
    return (
        p11 - e * e * p11,
        p21 - e * fp21,
        p22 - (f * fp21 + e * fp22),
        p31 - e * fp31,
        p32 - (f * fp31 + e * fp32),
        p33 - (g * fp31 + h * fp32 + b * fp33),
    )


def _cholesky(Q: tuple[Any, ...]) -> Lower:
    """Lower triangle of a covariance; what rounding made negative counts as zero."""
    q11, q21, q22, q31, q32, q33 = Q
    l11 = np.sqrt(q11)
    l21, l31 = q21 / l11, q31 / l11
    l22 = np.sqrt(np.maximum(q22 - l21 * l21, 0.0))
    l32 = np.where(l22 > 0.0, (q32 - l31 * l21) / np.where(l22 > 0.0, l22, 1.0), 0.0)
    return Lower(l11=l11, l21=l21, l22=l22, l31=l31, l32=l32, l33=np.sqrt(np.maximum(q33 - l31 * l31 - l32 * l32, 0.0)))
