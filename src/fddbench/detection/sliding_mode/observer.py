"""The core observer, eqs (11)-(12), and the fault reconstruction, eq (21).

States x = [phi, V_y, p, r, z_f] in rad, m/s, rad/s; outputs y_m = [phi, V_y, p, z_f], where z_f is the voted yaw rate
through the filter ``z_f' = -A_f z_f + A_f r``. The scheme is explicit but for the injection: the error after it is solved for,

    e = e* + T nu(e),        e* = C x* - y_m predicted,

so that the DC gain of the reconstruction is the same at every sample time.
"""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import affine, column, product, total
from fddbench.detection.sliding_mode.gains import SlidingModeGains
from fddbench.detection.sliding_mode.injection import injection
from fddbench.flight.lateral_lpv import lateral_lpv

__all__ = ["Inside", "Observer", "ObserverState"]


@record
class ObserverState:
    """State of the observer, its rate, the filtered yaw rate, and what the injection keeps."""

    x: Rows
    rate: Rows
    z_f: Row
    injection: Any


@record
class Inside:
    """Injection nu and output error e_y after it, in the order [phi, V_y, p, z_f] of the outputs."""

    nu: Rows
    e_y: Rows


class Observer:
    """Sliding-mode observer of the voted yaw rate.

    Parameters
    ----------
    gains : SlidingModeGains
        Linear gain G_l(rho), L and its sign convention, A22s, W, A_f, and the numbers of the injection.
    sample_s : float
        T [s].
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: SlidingModeGains, sample_s: float) -> None:
        self.gains, self.sample_s = gains, sample_s
        self.model = lateral_lpv()
        self.linear_gain = column(gains.linear_gain)
        factor = 2.0 if gains.gn_convention == "published" else 1.0
        self.gn_r = [-factor * value for value in gains.l_row]
        # eq (14) for a diagonal A22s: 2 a P = -1
        self.p_o = column([-0.5 / pole for pole in gains.error_pole_1_s])
        self.k = column(gains.k)
        self.injection: Any = injection(gains, k=self.k, p_o=self.p_o, sample_s=sample_s)
        self.states = Layout(ObserverState(x=5, rate=5, z_f=ROW, injection=self.injection.states.shape))

    def start(self, c: Nothing) -> ObserverState:
        """At rest."""
        del c
        return ObserverState(x=0.0, rate=0.0, z_f=0.0, injection=self.injection.start())

    def step(
        self, s: ObserverState, c: Nothing, n: Nothing, y: Rows, r_rad_s: Row, surface_deg: Rows, rho: Rows
    ) -> tuple[ObserverState, Row, Inside]:
        """State, reconstruction of the fault on the voted yaw rate [rad/s], (n_cases,), and the inside at this sample.

        Parameters
        ----------
        y : (3, n_cases) rows
            phi [rad], V_y [m/s], p [rad/s].
        r_rad_s : (n_cases,) row
            Voted yaw rate [rad/s].
        surface_deg : (13, n_cases) rows
            Surface positions [deg].
        rho : (4, n_cases) rows
            Scheduling parameters from measured values [-].
        """
        del c, n
        g, T = self.gains, self.sample_s
        y_m = np.concatenate([y, s.z_f[np.newaxis]])
        predicted = s.x + T * s.rate
        kept, nu = self.injection.step(s.injection, _outputs(predicted) - y_m)
        gn_nu = np.stack([nu[0], nu[1], nu[2], total([self.gn_r[j] * nu[j] for j in range(4)]), nu[3]])
        x = predicted + T * gn_nu
        A, B = self.model.matrices(rho)
        filtered = (g.filter_pole_1_s * (x[3] - x[4]))[np.newaxis]
        linear = np.concatenate([product(A, x[:4]) + product(B, surface_deg), filtered])
        rate = linear - product(affine(self.linear_gain, rho), _outputs(x) - y_m)
        z_f = s.z_f + T * g.filter_pole_1_s * (r_rad_s - s.z_f)
        reconstruction = total([g.w[j] * nu[j] for j in range(4)])
        after = ObserverState(x=x, rate=rate, z_f=z_f, injection=kept)
        return after, reconstruction, Inside(nu=nu, e_y=_outputs(x) - y_m)


def _outputs(x: Rows) -> Rows:
    """[phi, V_y, p, z_f] of the state, (4, n_cases)."""
    return np.concatenate([x[:3], x[4:]])
