"""A Kalman filter of the lateral motion that knows gusts: what one reading of the yaw rate would have to mean."""

from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import sin
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, product, total
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.interfaces import Bus
from fddbench.units import RAD_PER_DEG

__all__ = ["LATERAL_SIGNALS", "GustFilter", "GustFilterGains", "GustFilterState", "Lateral", "lateral"]

LATERAL_SIGNALS = (
    "phi_deg", "beta_deg", "p_deg_s", "r_deg_s", "r_voted_deg_s", "surface_deg", "v_tas_m_s",
    "mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt",
)  # fmt: skip
"""What the lateral model needs of a bus."""

N = 6
Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Row3 = Annotated[tuple[Number, ...], Field(min_length=3, max_length=3)]
Row4 = Annotated[tuple[Number, ...], Field(min_length=4, max_length=4)]


class GustFilterGains(BaseModel):
    """Filter of the states phi [rad], V_y [m/s] against the air, p, r [rad/s], gust [m/s], yaw acceleration off the model.

    Attributes
    ----------
    sample_s : float
        Clock of the gains [s].
    gust_time_s : float
        Time constant of the gust [s].
    K : 6 x 3 matrix
        Correction by the innovations of phi, V_y and p.
    k_r : 6 numbers
        Correction by what is then left of the innovation of r.
    W : 4 x 4 matrix
        Whitens the innovations of phi, V_y, p, r: ``W E[e e'] W' = I``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    sample_s: Positive
    gust_time_s: Positive
    K: Annotated[tuple[Row3, ...], Field(min_length=N, max_length=N)]
    k_r: Annotated[tuple[Number, ...], Field(min_length=N, max_length=N)]
    W: Annotated[tuple[Row4, ...], Field(min_length=4, max_length=4)]


@record
class GustFilterState:
    """Predicted state of one filter."""

    x: Rows


@record
class Lateral:
    """Measured phi [rad], V_y [m/s], p [rad/s]; A and the rates that the surfaces make, of the measured condition."""

    y: Rows
    A: Rows
    rates: Rows


def lateral(measured: SimpleNamespace) -> Lateral:
    """What the bus says of the lateral motion at this sample; the model of the measured condition."""
    model, m = lateral_lpv(), measured
    A, B = model.matrices(model.rho(m.mass_kg, m.x_cg_ratio, m.altitude_ft, m.v_cas_kt))
    v_y_m_s = m.v_tas_m_s * sin(m.beta_deg * RAD_PER_DEG)
    y = np.stack([m.phi_deg * RAD_PER_DEG, v_y_m_s, m.p_deg_s * RAD_PER_DEG])
    return Lateral(y=y, A=A, rates=product(B, m.surface_deg))


class GustFilter:
    """Steady gains about a scheduled model: ``x' = A(rho) x + B(rho) u``, V_y' also by the change of a Gauss-Markov gust."""

    states = Layout(GustFilterState(x=N))
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: GustFilterGains, bus: Bus) -> None:
        if abs(gains.sample_s - bus.sample_s) > 1e-9:
            raise DesignError(
                f"filter.sample_s: these gains are for {gains.sample_s} s, this campaign has {bus.sample_s}; design it anew"
            )
        self.sample_s, self.gust_time_s = gains.sample_s, gains.gust_time_s
        self.K, self.k_r, self.W = column(gains.K), column(gains.k_r), column(gains.W)

    def start(self, c: Nothing) -> GustFilterState:
        """In trim, calm."""
        del c
        return GustFilterState(x=0.0)

    def innovation(self, s: GustFilterState, now: Lateral, r_rad_s: Row) -> Rows:
        """What phi, V_y, p and r bring that was not predicted, (4, n_cases)."""
        return np.stack([*(now.y - s.x[:3]), r_rad_s - s.x[3]])

    def squared(self, e: Rows) -> Row:
        """Normalised square of an innovation, four in the mean if the model is right."""
        white = product(self.W, e)
        return total(white * white)

    def step(
        self, s: GustFilterState, c: Nothing, n: Nothing, now: Lateral, e: Rows, trust: Row
    ) -> tuple[GustFilterState, Row]:
        """Predicted state of the next sample, and the estimated yaw rate of this one [rad/s].

        Parameters
        ----------
        e : (4, n_cases) rows
            Innovation.
        trust : (n_cases,) row
            1 where the yaw rate may correct, 0 where the filter coasts on.
        """
        del c, n
        moved = s.x + product(self.K, e[:3])
        left = (e[3] - (moved[3] - s.x[3])) * trust
        x = moved + self.k_r * left
        body = product(now.A, x[:4]) + now.rates
        back = x[4] / self.gust_time_s
        rate = np.stack([body[0], body[1] + back, body[2], body[3] + x[5], -back, np.zeros_like(back)])
        return GustFilterState(x=x + self.sample_s * rate), x[3]
