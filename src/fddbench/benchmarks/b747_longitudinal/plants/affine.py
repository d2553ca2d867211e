"""The affine LPV model flown as an aircraft, in both of its variants."""

from typing import ClassVar

import numpy as np

from fddbench.benchmarks.b747_longitudinal.plants.longitudinal import (
    Longitudinal,
    LongitudinalConstants,
    LongitudinalState,
    after,
    rows_of,
    wind_of,
)
from fddbench.blocks.integrate import rk4
from fddbench.blocks.layout import Nothing, Row, Rows
from fddbench.flight.b747.affine_model import Variant, evaluated, frozen, per_alphadot, slope, terms
from fddbench.flight.b747.airframe import Aircraft
from fddbench.flight.b747.dynamics import airflow
from fddbench.flight.b747.scheduling import parameters
from fddbench.flight.b747.trim import Condition, Trim, newton
from fddbench.flight.wind import AirMotion

__all__ = ["LpvApprox", "LpvFold"]


class Affine(Longitudinal):
    """``xdot = A(rho) x + B(rho) u`` with rho held over a sample: a linear system from sample to sample.

    What the model freezes is frozen at the design point on every flight, so its trim is its own elsewhere. In wind, rho comes
    from the motion through the air, and the gust's rotation acts like a pitch rate the other way round.
    """

    variant: ClassVar[Variant]

    def found(self, aircraft: Aircraft, at: Condition) -> Trim:
        """Trim of this model in calm air."""
        A, B = terms(aircraft, frozen(), self.variant)

        def accelerations(z: Rows) -> Rows:
            zero = np.zeros_like(z[0])
            x = np.stack([z[0], zero, zero + at.v_tas_m_s, z[0] + at.gamma_rad, zero + at.altitude_m])
            rho = parameters(x[0], x[2], x[4], zero + at.gamma_rad)
            u = np.stack([z[1], zero + at.stabiliser_deg, z[2], zero + 1.0])
            return slope(evaluated(A, rho), evaluated(B, rho), x, u)[:3]

        return newton(accelerations, len(at.altitude_m))

    def step(
        self, x: LongitudinalState, c: LongitudinalConstants, n: Nothing, inputs: Rows, air: AirMotion
    ) -> tuple[LongitudinalState, Row]:
        """State at the next sample, and the acceleration along the path at this one [m/s^2]."""
        del n
        begun, wind = rows_of(x), wind_of(air)
        flow = airflow(begun, wind)
        rho = parameters(flow.alpha_rad, flow.v_tas_m_s, x.altitude_m, x.theta_rad - x.alpha_rad)
        A, B = (evaluated(entries, rho) for entries in terms(c.aircraft, frozen(), self.variant))
        u = np.stack([*inputs, np.ones_like(inputs[0])])
        none = np.zeros_like(air.q_rad_s)
        # alphadot is that over ground, so the gust's rotation has no part in its moment
        q_by_v = rho[1] if self.variant == "fold" else frozen().q_by_v_pa_s_m
        damping = A[1, 1] - per_alphadot(c.aircraft) * q_by_v
        gust = np.stack([(1.0 - A[0, 1]) * air.q_rad_s, -damping * air.q_rad_s, none, none, none])

        def rate(x: Rows) -> Rows:
            return slope(A, B, x, u) + gust

        flown = rk4(rate, begun, step_s=self.sample_s, substeps=self.substeps)
        return after(flown), rate(begun)[2]


class LpvFold(Affine):
    """Affine LPV model that takes alphadot as q in its moment: with it the paper's filters show transients in a climb."""

    about = "affine LPV model with nine parameters, alphadot taken as q"
    variant: ClassVar[Variant] = "fold"


class LpvApprox(Affine):
    """Affine LPV model that keeps alphadot in its moment and freezes the parameter before it."""

    about = "affine LPV model with nine parameters, moment of alphadot at a fixed Q/V"
    variant: ClassVar[Variant] = "approx"
