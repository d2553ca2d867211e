"""Dryden turbulence in all six components, discretised exactly: its variances do not depend on the sample time.

Velocities u_g, v_g, w_g and rotations p_g, q_g, r_g in body axes with the spectra of MIL-F-8785C; q_g and r_g are the
gradients of w_g and v_g along the path, smoothed by the span, p_g is a noise of its own. With L the scale length, b the span,
T = L / V:

    u_g  sigma sqrt(2 T) / (1 + T s)                          variance sigma^2
    p_g  first order with the lag 4 b / (pi V)                variance 0.1 pi^2 (pi L / 4 b)^(1/3) sigma^2 / (L b)
    q_g  -(s / V) / (1 + 4 b s / (pi V)) of w_g,  r_g  (s / V) / (1 + 3 b s / (pi V)) of v_g

L = 1750 ft and the intensities are those above 2000 ft. Below, the specification shortens the lengths and ties the intensities
to the wind at 20 ft; the values above are used there as they are. Signs of rotations: `AirMotion`; the specification leaves
them open. The field is frozen and crossed at the airspeed of the trim.

The half in the plane of symmetry (u, w, q) and the half out of it (v, p, r) are blocks that may fly alone with the same
numbers, and so the same bits, as in the whole.

Reference: MIL-F-8785C (1980), section 3.7; scale lengths and spectra as repeated in MIL-HDBK-1797 (1997), appendix A.
"""

from typing import Any

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp, pow_
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.transverse_gust import TransverseConstants, TransverseGust, TransverseState
from fddbench.flight.wind import AirMotion, CalmAir, Encounter, Wind, still

__all__ = [
    "INTENSITIES_M_S", "LONGITUDINAL_WINDS", "SCALE_LENGTH_M", "SIX_COMPONENT_WINDS", "Dryden", "Half", "HalfConstants",
    "HalfDraws", "HalfState", "LateralDryden", "LongitudinalDryden", "Whole", "roll_gust_per_m",
]  # fmt: skip

SCALE_LENGTH_M = 1750.0 * 0.3048
INTENSITIES_M_S = {"light": 1.5, "moderate": 3.0, "severe": 6.0}
"""One sigma of u_g, v_g, w_g above 2000 ft (5, 10, 20 ft/s, rounded)."""

_ACROSS = TransverseGust()


@record
class HalfState:
    """A first-order noise of unit variance (u_g or p_g) [-], and a gust with its gradient (w_g, q_g or v_g, r_g)."""

    single: Row
    across: TransverseState


@record
class HalfConstants:
    """Decay and noise of a sample [-], size of the first-order noise in its unit, its state before sample 0; the gust."""

    decay_ratio: Row
    noise_ratio: Row
    size: Row
    start: Row
    across: TransverseConstants


@record
class HalfDraws:
    """Normal numbers of the first-order noise and of the gust."""

    single: Row
    across: Rows


class Half:
    """What the two halves have in common.

    Parameters
    ----------
    sigma_m_s : float
        One sigma of the velocities [m/s].
    """

    states = Layout(HalfState(single=ROW, across=_ACROSS.states.shape))
    constants = Layout(
        HalfConstants(decay_ratio=ROW, noise_ratio=ROW, size=ROW, start=ROW, across=_ACROSS.constants.shape)
    )

    def __init__(self, sigma_m_s: float) -> None:
        self.sigma_m_s = sigma_m_s

    def _prepared(
        self, normals: HalfDraws, meets: Encounter, sample_s: float, *, size: Row, single_s: Row, spans: float
    ) -> HalfConstants:
        """Constants: size and lag of the first-order noise, and the lag of the gradient in spans over V."""
        decay = exp(-sample_s / single_s)
        noise = np.sqrt((1.0 - decay) * (1.0 + decay))
        v_tas_m_s = meets.v_tas_m_s
        across = _ACROSS.prepare(
            normals.across,
            sigma_m_s=self.sigma_m_s * meets.scale_ratio,
            tau_s=SCALE_LENGTH_M / v_tas_m_s,
            lag_s=spans * meets.span_m / v_tas_m_s,
            v_tas_m_s=v_tas_m_s,
            sample_s=sample_s,
        )
        return HalfConstants(decay_ratio=decay, noise_ratio=noise, size=size, start=normals.single, across=across)

    def start(self, c: HalfConstants) -> HalfState:
        """Stationary."""
        return HalfState(single=c.start, across=_ACROSS.start(c.across))

    def _stepped(self, x: HalfState, c: HalfConstants, n: HalfDraws) -> tuple[HalfState, tuple[Row, Row, Row]]:
        """State at the next sample; the first-order noise, the gust [m/s] and its gradient [rad/s] at this one."""
        across, (gust_m_s, gradient_rad_s) = _ACROSS.step(x.across, c.across, n.across)
        after = HalfState(single=c.decay_ratio * x.single + c.noise_ratio * n.single, across=across)
        return after, (c.size * x.single, gust_m_s, gradient_rad_s)


def _draws(consumer: int, *, single: int, across: int) -> Draws[Any]:
    """Numbers of a half: one of the first-order noise, three of the gust, from these places on."""
    return Draws(HalfDraws(single=Draw(consumer, single), across=Draw(consumer, across, rows=3)))


class LongitudinalDryden(Half):
    """u_g, w_g and q_g: all that an aircraft in its plane of symmetry feels."""

    draws = _draws(consumers.DRYDEN_LONGITUDINAL, single=0, across=1)
    before = _draws(consumers.DRYDEN_LONGITUDINAL_START, single=0, across=1)

    def prepare(self, normals: HalfDraws, meets: Encounter, sample_s: float) -> HalfConstants:
        """Constants of flights, see `fddbench.flight.wind.Wind`."""
        meets = meets.spread()
        size, single_s = self.sigma_m_s * meets.scale_ratio, SCALE_LENGTH_M / meets.v_tas_m_s
        return self._prepared(normals, meets, sample_s, size=size, single_s=single_s, spans=4.0 / np.pi)

    def step(self, x: HalfState, c: HalfConstants, n: HalfDraws, sample: Row, like: Row) -> tuple[HalfState, AirMotion]:
        """State at the next sample, and the motion of the air at this one."""
        del sample
        after, (u_m_s, w_m_s, gradient_rad_s) = self._stepped(x, c, n)
        return after, still(like, u_m_s=u_m_s, w_m_s=w_m_s, q_rad_s=-gradient_rad_s)


def roll_gust_per_m(span_m: Row) -> Row:
    """One sigma of p_g for a gust of 1 m/s [rad/s per m/s]."""
    share = pow_(0.25 * np.pi * SCALE_LENGTH_M / span_m, 1.0 / 3.0) / (SCALE_LENGTH_M * span_m)
    return np.sqrt(0.1 * np.pi * np.pi * share)


class LateralDryden(Half):
    """v_g, p_g and r_g."""

    draws = _draws(consumers.DRYDEN_LATERAL, single=3, across=0)
    before = _draws(consumers.DRYDEN_LATERAL_START, single=3, across=0)

    def prepare(self, normals: HalfDraws, meets: Encounter, sample_s: float) -> HalfConstants:
        """Constants of flights, see `fddbench.flight.wind.Wind`."""
        meets = meets.spread()
        span_m = meets.span_m
        size = self.sigma_m_s * meets.scale_ratio * roll_gust_per_m(span_m)
        return self._prepared(
            normals, meets, sample_s, size=size, single_s=4.0 / np.pi * span_m / meets.v_tas_m_s, spans=3.0 / np.pi
        )

    def step(self, x: HalfState, c: HalfConstants, n: HalfDraws, sample: Row, like: Row) -> tuple[HalfState, AirMotion]:
        """State at the next sample, and the motion of the air at this one."""
        del sample
        after, (p_rad_s, v_m_s, r_rad_s) = self._stepped(x, c, n)
        return after, still(like, v_m_s=v_m_s, p_rad_s=p_rad_s, r_rad_s=r_rad_s)


@record
class Whole:
    """States, constants or draws of both halves."""

    longitudinal: Any
    lateral: Any


class Dryden:
    """All six components.

    Parameters
    ----------
    sigma_m_s : float
        One sigma of the velocities [m/s].
    """

    states = Layout(Whole(longitudinal=Half.states.shape, lateral=Half.states.shape))
    constants = Layout(Whole(longitudinal=Half.constants.shape, lateral=Half.constants.shape))
    draws = Draws(Whole(longitudinal=LongitudinalDryden.draws.names, lateral=LateralDryden.draws.names))
    before = Draws(Whole(longitudinal=LongitudinalDryden.before.names, lateral=LateralDryden.before.names))

    def __init__(self, sigma_m_s: float) -> None:
        self.sigma_m_s = sigma_m_s
        self.longitudinal, self.lateral = LongitudinalDryden(sigma_m_s), LateralDryden(sigma_m_s)

    def prepare(self, normals: Whole, meets: Encounter, sample_s: float) -> Whole:
        """Constants of flights, see `fddbench.flight.wind.Wind`."""
        return Whole(
            longitudinal=self.longitudinal.prepare(normals.longitudinal, meets, sample_s),
            lateral=self.lateral.prepare(normals.lateral, meets, sample_s),
        )

    def start(self, c: Whole) -> Whole:
        """Stationary."""
        return Whole(longitudinal=self.longitudinal.start(c.longitudinal), lateral=self.lateral.start(c.lateral))

    def step(self, x: Whole, c: Whole, n: Whole, sample: Row, like: Row) -> tuple[Whole, AirMotion]:
        """State at the next sample, and the motion of the air at this one."""
        longitudinal, plane = self.longitudinal.step(x.longitudinal, c.longitudinal, n.longitudinal, sample, like)
        lateral, side = self.lateral.step(x.lateral, c.lateral, n.lateral, sample, like)
        moving = AirMotion(
            u_m_s=plane.u_m_s, v_m_s=side.v_m_s, w_m_s=plane.w_m_s,
            p_rad_s=side.p_rad_s, q_rad_s=plane.q_rad_s, r_rad_s=side.r_rad_s,
        )  # fmt: skip
        return Whole(longitudinal=longitudinal, lateral=lateral), moving


SIX_COMPONENT_WINDS: dict[str, Wind] = {
    "none": CalmAir(),
    **{name: Dryden(sigma_m_s) for name, sigma_m_s in INTENSITIES_M_S.items()},
}
"""Calm air and turbulence for an aircraft that flies in all axes, by their names in campaigns, the default first."""
LONGITUDINAL_WINDS: dict[str, Wind] = {
    "none": CalmAir(),
    **{name: LongitudinalDryden(sigma_m_s) for name, sigma_m_s in INTENSITIES_M_S.items()},
}
"""The same for one in its plane of symmetry."""
