"""The nonlinear aircraft, which the paper takes as the true system."""

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
from fddbench.flight.b747.aerodynamics import air as air_at
from fddbench.flight.b747.airframe import Aircraft
from fddbench.flight.b747.dynamics import derivative
from fddbench.flight.b747.trim import Condition, Trim, trim
from fddbench.flight.wind import AirMotion

__all__ = ["Nonlinear"]


class Nonlinear(Longitudinal):
    """Five states with the compact aerodynamic model; the air's density is that of the altitude at the sample."""

    about = "nonlinear longitudinal model"

    def found(self, aircraft: Aircraft, at: Condition) -> Trim:
        """Trim of this model in calm air."""
        return trim(aircraft, at)

    def step(
        self, x: LongitudinalState, c: LongitudinalConstants, n: Nothing, inputs: Rows, air: AirMotion
    ) -> tuple[LongitudinalState, Row]:
        """State at the next sample, and the acceleration along the path at this one [m/s^2]."""
        del n
        around, begun, wind = air_at(x.altitude_m), rows_of(x), wind_of(air)

        def rate(x: Rows, inputs: Rows, wind: Rows) -> Rows:
            return derivative(x, inputs, wind, c.aircraft, around)

        flown = rk4(rate, begun, inputs, wind, step_s=self.sample_s, substeps=self.substeps)
        return after(flown), rate(begun, inputs, wind)[2]
