"""The Boeing 747 about a steady level flight, as the laws are designed for it.

Angles in deg, speeds in m/s, thrust per engine in kN: what flies is of size one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.design.tracking.wiring import Block
from fddbench.errors import DesignError
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.b747.aerodynamics import air, coefficients
from fddbench.flight.b747.airframe import DATA, Aircraft, aircraft
from fddbench.flight.b747.dynamics import derivative
from fddbench.flight.b747.trim import condition, trim
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace
from fddbench.units import DEG_PER_RAD

__all__ = [
    "ACTUATORS",
    "ELEVATOR_RAD_S",
    "ENGINE_RAD_S",
    "MEASURED",
    "FlightPoint",
    "LinearAircraft",
    "linear_aircraft",
    "linear_aircrafts",
]

MEASURED = ("flight_path_deg", "acceleration_g", "pitch_deg", "pitch_rate_deg_s", "speed_m_s")
"""What laws measure, as deviations from trim."""
ELEVATOR_RAD_S, ENGINE_RAD_S = 27.0, 0.5
"""Corners of the actuators: elevator 27/(s + 27); engines and stabiliser 1/(2 s + 1) [rad/s]."""
ACTUATORS = (
    Block(StateSpace.diagonal([-ELEVATOR_RAD_S], [ELEVATOR_RAD_S], [1.0], [0.0]), ["elevator_order"], ["elevator"]),
    Block(StateSpace.diagonal([-ENGINE_RAD_S], [ENGINE_RAD_S], [1.0], [0.0]), ["thrust_order"], ["thrust"]),
)
"""Elevator [deg] and thrust [kN] from their orders."""
# rad, rad/s, m/s, rad, m in the units of the design
_UNITS = np.array([DEG_PER_RAD, DEG_PER_RAD, 1.0, DEG_PER_RAD, 1.0])
_STEPS = (1e-5, 1e-5, 1e-2, 1e-5, 1.0)
# elevator, stabiliser, thrust and downward gust: argument of the derivative, its entry, step, unit of the design
_INPUTS = ((1, 0, 1e-3, 1.0), (1, 1, 1e-3, 1.0), (1, 2, 10.0, 1e3), (2, 1, 1e-2, 1.0))


@dataclass(frozen=True, kw_only=True)
class FlightPoint:
    """A steady level flight: geometric altitude [m] and true airspeed [m/s]."""

    altitude_m: float
    v_tas_m_s: float

    @property
    def dynamic_pressure_pa(self) -> float:
        """Dynamic pressure in the standard atmosphere [Pa]."""
        return float(0.5 * air(np.array([self.altitude_m])).density_kg_m3[0] * self.v_tas_m_s**2)


@dataclass(frozen=True, kw_only=True)
class LinearAircraft:
    """An aircraft about a trim.

    Attributes
    ----------
    A : (5, 5) array
        States are angle of attack and pitch rate [deg, deg/s], airspeed [m/s], pitch angle [deg], altitude [m].
    B : (5, 4) array
        Of elevator and stabiliser [deg], thrust per engine [kN] and a gust down [m/s].
    alpha_deg, elevator_deg, thrust_kn : float
        Trim.
    stabiliser_ratio : float
        Elevator in degrees of the stabiliser: ratio of their pitching moments [-].
    """

    A: Floats
    B: Floats
    alpha_deg: float
    elevator_deg: float
    thrust_kn: float
    stabiliser_ratio: float

    def block(self, *, altitude: bool = True) -> Block:
        """From elevator, stabiliser, thrust and gust to `MEASURED`; without altitude, the air stays that of the trim."""
        C, D = np.zeros((5, 5)), np.zeros((5, self.B.shape[1]))
        C[0, [0, 3]] = -1.0, 1.0
        C[1], D[1] = self.A[2] / GRAVITY_M_S2, self.B[2] / GRAVITY_M_S2
        C[2, 3] = C[3, 1] = C[4, 2] = 1.0
        n = 5 if altitude else 4
        system = StateSpace(self.A[:n, :n], self.B[:n], C[:, :n], D)
        return Block(system, ["elevator", "stabiliser", "thrust", "gust"], MEASURED)


def linear_aircraft(at: FlightPoint, flying: Aircraft | None = None) -> LinearAircraft:
    """The nonlinear model about its trim; the nominal aircraft unless another is given.

    Raises
    ------
    DesignError
        There is no trim at this point.
    """
    (found,) = linear_aircrafts([at], flying)
    if found is None:
        raise DesignError(f"no trim at {at.altitude_m:g} m, {at.v_tas_m_s:g} m/s; choose a point of the envelope")
    return found


def linear_aircrafts(points: Sequence[FlightPoint], flying: Aircraft | None = None) -> list[LinearAircraft | None]:
    """The nonlinear model about the trim of each point, by central differences; None where there is none.

    Parameters
    ----------
    points : sequence of FlightPoint
    flying : Aircraft
        Rows of one aircraft a point; the nominal one everywhere unless given.
    """
    if not points:
        return []
    altitude, speed = (
        np.array([getattr(p, name) for p in points], dtype=float) for name in ("altitude_m", "v_tas_m_s")
    )
    one = aircraft(np.full(len(points), DATA["inertia"]["mass_kg"])) if flying is None else flying
    found = trim(one, condition(altitude, speed))
    zero = np.zeros_like(altitude)
    x0 = np.stack([found.alpha_rad, zero, speed, found.alpha_rad, altitude])
    u0 = np.stack([found.elevator_deg, zero + DATA["stabiliser_deg"], found.thrust_n])

    def rate(x: Floats, u: Floats, wind: Floats) -> Floats:
        rates: Floats = derivative(x, u, wind, one, air(x[4])) * _UNITS[:, None]
        return rates

    at = (x0, u0, np.zeros((3, len(points))))
    with np.errstate(all="ignore"):  # points without a trim
        A = np.stack([_slope(rate, at, 0, j, step) for j, step in enumerate(_STEPS)], axis=1) / _UNITS[:, None]
        B = np.stack([_slope(rate, at, which, j, step) * unit for which, j, step, unit in _INPUTS], axis=1)
        c = coefficients(x0[0], speed, air(altitude))
    ratio = c.elevator_moment / DATA["moment"]["stabiliser_per_deg"]
    return [
        LinearAircraft(
            A=A[..., i],
            B=B[..., i],
            alpha_deg=DEG_PER_RAD * float(found.alpha_rad[i]),
            elevator_deg=float(found.elevator_deg[i]),
            thrust_kn=float(found.thrust_n[i]) / 1e3,
            stabiliser_ratio=float(ratio[i]),
        )
        if bool(found.found[i])
        else None
        for i in range(len(points))
    ]


def _slope(rate: Callable[..., Floats], at: tuple[Floats, ...], which: int, j: int, step: float) -> Floats:
    """Derivative by entry j of one argument, (5, n_cases), by a central difference."""
    h = np.zeros((len(at[which]), 1))
    h[j] = step
    above, below = ([*at[:which], at[which] + sign * h, *at[which + 1 :]] for sign in (1.0, -1.0))
    slope: Floats = (rate(*above) - rate(*below)) / (2.0 * step)
    return slope
